"""Meshes of other libraries handed in as they are, and everything that can be wrong with them."""

import contextlib
from itertools import product
from types import SimpleNamespace

import matplotlib.tri
import meshio
import naive
import numpy as np
import pytest
import skfem
import trimesh
from scipy.spatial import ConvexHull, Delaunay
from shipped_meshes import MESHES

import lepp
from lepp import Triangulation

SQUARE = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
HALVES = np.array([[0, 1, 2], [0, 2, 3]])
POINTS = np.random.default_rng(8).random((300, 2))


@pytest.mark.parametrize("name", MESHES)
def test_sizes_on_shipped_meshes_are_the_twins(name):
    points, triangles = MESHES[name]
    mesh = Triangulation.from_arrays(points, triangles)
    twin = naive.Paths(mesh.points.tolist(), mesh.triangles.tolist())
    paths = [twin.path(t)[0] for t in range(len(mesh))]
    found = lepp.lepp_paths(mesh)
    assert found.sizes.tolist() == [len(path) for path in paths]
    for path in paths:
        assert found.successors[path[:-1]].tolist() == path[1:]


def test_objects_give_the_same_as_their_arrays():
    delaunay = Delaunay(POINTS)
    expected = lepp.lepp_sizes(Triangulation.from_arrays(POINTS, delaunay.simplices))
    lifted = np.column_stack((POINTS, np.full(len(POINTS), 7.0)))
    for mesh in (
        delaunay,
        matplotlib.tri.Triangulation(*POINTS.T, delaunay.simplices),
        meshio.Mesh(POINTS, [("triangle", delaunay.simplices)]),
        meshio.Mesh(lifted, {"triangle": delaunay.simplices}),
        meshio.Mesh(
            lifted,
            [
                ("line", [[0, 1]]),
                ("triangle", delaunay.simplices[:40]),
                ("vertex", [[3]]),
                ("triangle", delaunay.simplices[40:]),
            ],
        ),
    ):
        taken = Triangulation.from_object(mesh)
        assert taken.points.shape[1] == 2
        assert np.array_equal(lepp.lepp_sizes(taken), expected)


def test_masked_triangles_are_left_out():
    mesh = matplotlib.tri.Triangulation(*SQUARE.T, HALVES, mask=[True, False])
    taken = Triangulation.from_object(mesh)
    assert taken.triangles.tolist() == [[0, 2, 3]]


def test_surfaces_of_objects_stay_in_space():
    points = np.random.default_rng(2).normal(size=(60, 3))
    points /= np.linalg.norm(points, axis=1)[:, None]
    surface = Triangulation.from_object(ConvexHull(points))
    assert surface.points.shape == (60, 3)
    assert len(surface) == 2 * 60 - 4
    assert surface.n_hull == 0


def test_curved_triangles_are_taken_by_their_corners():
    midpoints = (SQUARE[[0, 1, 2]] + SQUARE[[1, 2, 0]]) / 2
    mesh = meshio.Mesh(np.vstack((SQUARE, midpoints)), [("triangle6", [[0, 1, 2, 4, 5, 6]])])
    assert Triangulation.from_object(mesh).triangles.tolist() == [[0, 1, 2]]


def _flat(triangles):
    return np.column_stack((np.full(len(triangles), 3), triangles)).ravel()


def grid(points, cells, types):
    """What a pyvista.UnstructuredGrid holds."""
    return SimpleNamespace(points=points, cells=np.array(cells), celltypes=np.array(types, "u1"))


def surface(points, faces, strips=()):
    """What a pyvista.PolyData holds."""
    return SimpleNamespace(points=points, faces=np.array(faces), strips=np.array(strips, int))


def test_further_libraries_give_the_same_as_their_arrays():
    triangles = Delaunay(POINTS).simplices
    expected = Triangulation.from_arrays(POINTS, triangles)
    lifted = np.column_stack((POINTS, np.zeros(len(POINTS))))
    for mesh in (
        expected,
        grid(lifted, _flat(triangles), [5] * len(triangles)),
        surface(lifted, _flat(triangles)),
        trimesh.Trimesh(lifted, triangles, process=False),
        skfem.MeshTri(POINTS.T, triangles.T),
        {"vertices": POINTS, "triangles": triangles, "vertex_markers": 0},
        (POINTS, triangles),
        [POINTS.tolist(), triangles.tolist()],
    ):
        taken = Triangulation.from_object(mesh)
        assert np.array_equal(taken.points, POINTS)
        assert np.array_equal(np.sort(taken.triangles), np.sort(expected.triangles))
        assert np.array_equal(lepp.lepp_sizes(taken), lepp.lepp_sizes(expected))


def test_grids_of_cells_of_several_types():
    points = np.array([[0, 0], [2, 0], [2, 1], [0, 1], [3, 0], [3, 3], [4, 0.0]])
    points = np.column_stack((points, np.zeros(7)))
    cells = [2, 0, 1, 3, 0, 1, 2, 4, 1, 4, 2, 5, 3, 4, 6, 5, 1, 3]
    mixed = grid(points, cells, [3, 5, 8, 7, 1])  # a pixel goes 0, 1, 3, 2 round
    with pytest.raises(lepp.MeshError, match=r"1 cell of type quad \(numbers 2\)"):
        Triangulation.from_object(mixed)
    taken = Triangulation.from_object(mixed, split_quads=True)
    assert {frozenset(t) for t in taken.triangles.tolist()} == {
        frozenset(t) for t in ((0, 1, 2), (1, 4, 2), (4, 5, 2), (4, 6, 5))
    }
    volume = grid(points, [4, 0, 1, 2, 5, 3, 0, 1, 2], [10, 5])
    with pytest.raises(lepp.MeshError, match="1 cell of type tetra"):
        Triangulation.from_object(volume)
    assert len(Triangulation.from_object(volume, ignore_volumes=True)) == 1


def test_quads_of_surfaces_and_strips():
    quads = surface(SQUARE, [4, 0, 1, 2, 3])
    with pytest.raises(lepp.MeshError, match="split_quads=True"):
        Triangulation.from_object(quads)
    assert len(Triangulation.from_object(quads, split_quads=True)) == 2
    with pytest.raises(lepp.MeshError, match="triangle_strip"):
        Triangulation.from_object(surface(SQUARE, [3, 0, 1, 2], [4, 0, 1, 2, 3]))
    with pytest.raises(lepp.MeshError, match="type polygon"):
        Triangulation.from_object(surface(POINTS, [5, 0, 1, 2, 3, 4, 3, 5, 6, 7]))


@pytest.mark.parametrize(
    ("mesh", "n"),
    [(skfem.MeshTri2(), 2), (skfem.MeshQuad(), 2), (skfem.MeshTri.init_circle(2), 64)],
)
def test_meshes_of_scikit_fem(mesh, n):
    assert len(Triangulation.from_object(mesh, split_quads=True)) == n


@pytest.mark.parametrize("mesh", [skfem.MeshTet(), skfem.MeshHex()])
def test_volumes_of_scikit_fem_are_refused(mesh):
    with pytest.raises(lepp.MeshError, match="extract the surface"):
        Triangulation.from_object(mesh)


def test_masks_are_honoured_or_refused():
    points = np.ma.masked_array(SQUARE, np.zeros((4, 2), bool))
    triangles = np.ma.masked_array(HALVES, np.zeros((2, 3), bool))
    assert len(Triangulation.from_arrays(points, triangles)) == 2  # nothing is masked
    hidden = triangles.copy()
    hidden[1, 2] = np.ma.masked
    gone = points.copy()
    gone[3, 0] = np.ma.masked
    for make in (
        Triangulation.from_arrays,
        lambda *arrays: Triangulation.from_object(arrays),
        lambda p, t: Triangulation.from_object(SimpleNamespace(vertices=p, faces=t)),
    ):
        with pytest.raises(lepp.InputError, match=r"(Triangles|Faces) 1 are masked: leave them"):
            make(points, hidden)
        with pytest.raises(lepp.InputError, match="Points 3 are masked"):
            make(gone, triangles)
    with pytest.raises(lepp.InputError, match="Points 3 are masked"):
        lepp.triangulate(gone)
    mesh = matplotlib.tri.Triangulation(*SQUARE.T, HALVES, mask=[True, True])
    with pytest.raises(lepp.InputError, match="mask of the triangles leaves none"):
        Triangulation.from_object(mesh)


NONSENSE = [
    None, 3, "word", [], [[0, 1], [2]], object(), np.array(2), {}, [None], SQUARE, HALVES,
    np.array([3, 0, 1]), [("triangle", 5)], [("triangle", [[0, 1]])], {"triangle": None},
    [("triangle", [[0.5, 1, 2]])], np.array([["a"] * 3]), np.zeros((0, 3), int),
]  # fmt: skip


@pytest.mark.parametrize(
    "names",
    [
        ("points", "cells"), ("points", "cells", "celltypes"), ("points", "simplices"),
        ("points", "triangles"), ("points", "faces"), ("points", "faces", "strips"),
        ("x", "y", "triangles"), ("x", "y", "triangles", "mask"), ("vertices", "faces"), ("p", "t"),
    ],
)  # fmt: skip
def test_nonsense_ends_in_a_sentence(names):
    for values in product(NONSENSE, repeat=2):
        values = [*values, values[-1], values[0]]
        mesh = SimpleNamespace(**dict(zip(names, values, strict=False)))
        with contextlib.suppress(lepp.InputError):
            Triangulation.from_object(mesh, split_quads=True)


def test_pairs_and_dictionaries_of_nonsense_end_in_a_sentence():
    for one, other in product(NONSENSE, repeat=2):
        for mesh in ((one, other), [one, other], {"vertices": one, "triangles": other}):
            with contextlib.suppress(lepp.InputError):
                Triangulation.from_object(mesh)
        with contextlib.suppress(lepp.InputError):
            Triangulation.from_arrays(one, other)


@pytest.mark.parametrize("function", [lepp.lepp_sizes, lepp.lepp_paths])
@pytest.mark.parametrize("mesh", [Delaunay(POINTS), (SQUARE, HALVES), None, "mesh.vtu"])
def test_paths_of_what_is_no_triangulation(function, mesh):
    with pytest.raises(lepp.InputError, match=r"no lepp\.Triangulation.*from_object"):
        function(mesh)


@pytest.mark.parametrize("mesh", [object(), None, SQUARE, "mesh.vtu", (1, 2, 3), {}])
def test_other_objects_are_refused(mesh):
    with pytest.raises(lepp.InputError, match=r"is no mesh that can be taken as it is"):
        Triangulation.from_object(mesh)


def test_simplices_in_space_are_refused():
    with pytest.raises(lepp.InputError, match="have 4 vertices: only triangles are taken"):
        Triangulation.from_object(Delaunay(np.random.default_rng(0).random((9, 3))))


def test_quads_are_split_only_if_asked_to():
    points = np.array([[0, 0], [2, 0], [2, 1], [0, 1], [3, 0], [3, 3.0]])
    mesh = meshio.Mesh(points, [("quad", [[0, 1, 2, 3], [1, 4, 5, 2]])])
    with pytest.raises(lepp.MeshError, match=r"2 cells of type quad \(numbers 0, 1\)") as e:
        Triangulation.from_object(mesh)
    assert e.value.problems[0].kind == "quads"
    split = Triangulation.from_object(mesh, split_quads=True)
    halves = {frozenset(triangle) for triangle in split.triangles.tolist()}
    # Equal diagonals: that from the smallest vertex. Else the shorter: 2 to 4.
    assert halves == {frozenset(t) for t in ((0, 1, 2), (0, 2, 3), (1, 4, 2), (4, 5, 2))}


@pytest.mark.parametrize("lift", [False, True])
def test_quads_that_are_not_convex_are_split_inside(lift):
    # An arrow head: the diagonal 1 to 3 is shorter, but outside.
    points = np.array([[0, 0], [1, -0.5], [0.5, 0], [1, 0.5]])
    if lift:
        points = np.column_stack((points, points[:, 0]))
    mesh = meshio.Mesh(points, [("quad", [[1, 2, 3, 0]])])
    split = Triangulation.from_object(mesh, split_quads=True)
    assert {frozenset(t) for t in split.triangles.tolist()} == {
        frozenset((0, 1, 2)),
        frozenset((0, 2, 3)),
    }


def test_twisted_quads_are_refused():
    mesh = meshio.Mesh(SQUARE, [("quad", [[0, 1, 2, 3], [0, 2, 1, 3]])])
    with pytest.raises(lepp.MeshError, match="Quads 1 of block 0 have no diagonal inside"):
        Triangulation.from_object(mesh, split_quads=True)


def test_volumes_are_refused_or_ignored():
    points = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1.0]])
    tetra = ("tetra", [[0, 1, 2, 3]])
    with pytest.raises(lepp.MeshError, match=r"1 cell of type tetra.*extract the surface"):
        Triangulation.from_object(meshio.Mesh(points, [tetra]))
    with pytest.raises(lepp.InputError, match=r"no triangles \(but 1 tetra\)"):
        Triangulation.from_object(meshio.Mesh(points, [tetra]), ignore_volumes=True)
    both = meshio.Mesh(points, [tetra, ("triangle", [[0, 1, 3]])])
    with pytest.raises(lepp.MeshError, match="ignore_volumes=True"):
        Triangulation.from_object(both)
    assert len(Triangulation.from_object(both, ignore_volumes=True)) == 1


def test_polygons_are_refused_beyond_four_corners():
    points = np.array([[0, 0], [2, 0], [3, 1], [1, 3], [-1, 1.0]])
    mesh = meshio.Mesh(points, [("polygon", [[0, 1, 2, 3, 4]])])
    with pytest.raises(lepp.MeshError, match=r"1 cell of type polygon.*triangulate them"):
        Triangulation.from_object(mesh)
    assert len(Triangulation.from_object(meshio.Mesh(points, [("polygon", [[0, 1, 2]])]))) == 1


def kinds(points, triangles, **options):
    with pytest.raises(lepp.MeshError) as raised:
        Triangulation.from_arrays(points, triangles, **options)
    return {problem.kind: problem.ids.tolist() for problem in raised.value.problems}


def test_repeated_points_are_refused_merged_or_kept():
    points = np.vstack((SQUARE, SQUARE[[0, 2]], [[-0.0, 0.0]], [[9.0, 9.0]] * 2))
    triangles = [[0, 1, 2], [4, 5, 3]]
    assert kinds(points, triangles) == {"repeated points": [4, 5]}
    merged = Triangulation.from_arrays(points, triangles, repeated_points="merge")
    assert merged.repeated.tolist() == [[4, 0], [5, 2]]
    assert merged.triangles.tolist() == [[0, 1, 2], [0, 2, 3]]
    assert merged.neighbors[0].tolist() == [-1, 1, -1]
    kept = Triangulation.from_arrays(points, triangles, repeated_points="keep")
    assert (kept.neighbors == -1).all()
    assert len(kept.repeated) == 0
    with pytest.raises(lepp.InputError, match="use one of 'refuse', 'merge', 'keep'"):
        Triangulation.from_arrays(points, triangles, repeated_points="join")


def test_triangles_on_a_seam_are_told_from_flat_ones():
    points = np.vstack((SQUARE, SQUARE[:1]))
    triangles = [[0, 1, 2], [4, 2, 3], [0, 1, 4]]
    assert kinds(points, triangles) == {"repeated points": [4], "seam triangles": [2]}
    assert kinds(points, triangles, repeated_points="keep") == {"seam triangles": [2]}
    assert kinds(points, triangles, repeated_points="merge") == {"collapsed triangles": [2]}
    assert kinds(points, [[0, 1, 2], [0, 1, 1]]) == {"collapsed triangles": [1]}


@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_only_points_in_use_must_be_finite(bad):
    points = np.vstack((SQUARE, [[bad, 0.0]]))
    mesh = Triangulation.from_arrays(points, HALVES)
    assert lepp.lepp_sizes(mesh).tolist() == [2, 2]
    assert lepp.lepp_sizes(mesh, equal_within=1e-6).tolist() == [2, 2]
    assert kinds(points, [*HALVES, [2, 4, 3]]) == {"infinite points": [4]}
    with pytest.raises(lepp.MeshError, match=r"Points 4 .* used by triangles 2: give them finite"):
        Triangulation.from_arrays(points, [*HALVES, [2, 4, 3]])


def test_zeros_of_both_signs_are_one_place():
    points = np.array([[0.0, 0.0], [1, 0], [0, 1], [-0.0, 0.0], [1, 1]])
    assert kinds(points, [[0, 1, 2], [3, 4, 2]]) == {"repeated points": [3]}


def test_all_problems_are_found_at_once():
    points = np.vstack((SQUARE, [[2, 0], [3, 0], [2, 1], [5, 5], [6, 5], [5, 6], [6, 5], [6, 6]]))
    triangles = [
        [0, 1, 2],
        [0, 2, 3],
        [1, 4, 5],
        [1, 4, 4],
        [0, 2, 1],
        [4, 6, 2],
        [7, 8, 9],
        [10, 11, 9],
    ]
    assert kinds(points, triangles) == {
        "repeated points": [10],
        "collapsed triangles": [3],
        "flat triangles": [2],
        "copies": [4],
    }
    with pytest.raises(lepp.MeshError) as raised:
        Triangulation.from_arrays(points, triangles)
    assert str(raised.value).startswith("The mesh has 4 problems.\n")
    assert len(str(raised.value).splitlines()) == 5


def test_edges_of_three_triangles():
    points = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [0, -1, 0]], float)
    fins = [[0, 1, 2], [1, 0, 3], [0, 1, 4]]
    assert kinds(points, fins) == {"non-manifold edges": [0, 1, 2]}
    # A copy makes edges of three triangles, too; without it they are edges of two.
    assert kinds(points, [*fins[:2], [2, 1, 0]]) == {"copies": [2]}


def test_a_vertex_pulled_over_its_neighbours_inverts_a_triangle():
    points, triangles = MESHES["circle"]
    triangles = Triangulation.from_arrays(points, triangles).triangles.copy()
    t = int(np.hypot(*points[triangles].mean(axis=1).T).argmin())
    a, b, c = triangles[t]
    moved = points.copy()
    middle = (points[b] + points[c]) / 2
    moved[a] = middle + 0.8 * (middle - points[a])
    assert kinds(moved, triangles) == {"inverted triangles": [t]}
    triangles[::5] = triangles[::5][:, [0, 2, 1]]
    folded = kinds(moved, triangles)["folded triangles"]  # which is wrong cannot be told any more
    assert t in folded
    assert len(folded) == 4


def test_a_folded_mesh():
    points = np.array([[0, 0], [1, 0], [0, 1], [0.2, 0.2]])
    assert kinds(points, [[0, 1, 2], [0, 1, 3]]) == {"folded triangles": [0, 1]}


def test_the_order_of_vertices_changes_no_path():
    for points, triangles in (MESHES["shaken circle"], MESHES["torus"]):
        expected = lepp.lepp_sizes(Triangulation.from_arrays(points, triangles))
        mixed = triangles.copy()
        mixed[::3] = mixed[::3][:, [0, 2, 1]]
        mesh = Triangulation.from_arrays(points, mixed)
        assert np.array_equal(lepp.lepp_sizes(mesh), expected)
        if points.shape[1] == 2:
            a, b, c = (mesh.points[mesh.triangles[:, k]] for k in range(3))
            u, v = b - a, c - a
            assert (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0] > 0).all()


def test_a_moebius_strip_is_all_right():
    angle = np.linspace(0, 2 * np.pi, 30, endpoint=False)
    middle = np.column_stack((3 * np.cos(angle), 3 * np.sin(angle), 0 * angle))
    across = np.column_stack(
        (np.cos(angle / 2) * np.cos(angle), np.cos(angle / 2) * np.sin(angle), np.sin(angle / 2))
    )
    points = np.vstack((middle + across, middle - across))
    k = np.arange(29)
    triangles = np.vstack(
        (
            np.column_stack((k, k + 1, k + 30)),
            np.column_stack((k + 1, k + 31, k + 30)),
            [[29, 30, 59], [30, 0, 59]],
        )
    )
    mesh = Triangulation.from_arrays(points, triangles)
    assert mesh.n_hull == 60
    sizes = naive.Paths(mesh.points.tolist(), mesh.triangles.tolist()).sizes()
    assert lepp.lepp_sizes(mesh).tolist() == sizes
