"""Meshes of other libraries handed in as they are, and everything that can be wrong with them."""

import matplotlib.tri
import meshio
import naive
import numpy as np
import pytest
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


@pytest.mark.parametrize("mesh", [object(), None, SQUARE, "mesh.vtu"])
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
