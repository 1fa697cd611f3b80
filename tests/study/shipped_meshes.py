"""Meshes that other packages make: in the plane and in space, regular (full of ties) and not."""

import numpy as np
import skfem
import trimesh


def _skfem(mesh):
    return np.ascontiguousarray(mesh.p.T), np.ascontiguousarray(mesh.t.T)


def _trimesh(mesh):
    return np.array(mesh.vertices), np.array(mesh.faces)


def _shaken(mesh):
    """The inner points moved a little, so that edges differ and paths are longer."""
    points, triangles = _skfem(mesh)
    inner = np.setdiff1d(np.arange(len(points)), mesh.boundary_nodes())
    points[inner] += np.random.default_rng(5).normal(scale=0.01, size=(len(inner), 2))
    return points, triangles


def _annulus():
    points, triangles = _skfem(skfem.MeshTri.init_circle(3))
    far = np.hypot(*points[triangles].mean(axis=1).T) > 0.5
    return points, triangles[far]


def _two_boxes():
    one = trimesh.creation.box()
    two = trimesh.creation.icosphere(1).apply_translation([3, 0, 0])
    return _trimesh(trimesh.util.concatenate([one, two]))


MESHES = {
    "L shape": _skfem(skfem.MeshTri.init_lshaped().refined(2)),
    "symmetric square": _skfem(skfem.MeshTri.init_sqsymmetric().refined(2)),
    "circle": _skfem(skfem.MeshTri.init_circle(3)),
    "shaken circle": _shaken(skfem.MeshTri.init_circle(3)),
    "graded square": _skfem(
        skfem.MeshTri.init_tensor(np.linspace(0, 1, 12) ** 2, np.linspace(0, 1, 12) ** 3)
    ),
    "annulus": _annulus(),
    "icosphere": _trimesh(trimesh.creation.icosphere(2)),
    "torus": _trimesh(trimesh.creation.torus(2.0, 0.7, major_sections=20, minor_sections=12)),
    "capsule": _trimesh(trimesh.creation.capsule(height=2.0, radius=0.5, count=[12, 12])),
    "two pieces": _two_boxes(),
}
