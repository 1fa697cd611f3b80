"""Mesh files: read, surveyed, written back; and files that no reader expects."""

import hashlib
import signal
from contextlib import contextmanager
from itertools import pairwise
from pathlib import Path

import meshio
import numpy as np
import pytest
from shipped_meshes import MESHES

import lepp
from study.meshes import meshio_process
from study.meshes import meshio_reader as reader
from study.meshes import read as reading
from study.meshes.as_json import as_json
from study.meshes.read import ReadOptions, read_mesh
from study.meshes.survey import survey
from study.meshes.write import FORMATS, write_mesh

SURFACE = MESHES["torus"]
PLANE = MESHES["annulus"]

READ = {
    "vtk": "vtk",
    "vtu": "vtu",
    "gmsh": "msh",
    "obj": "obj",
    "ply": "ply",
    "stl": "stl",
    "off": "off",
    "medit": "mesh",
    "abaqus": "inp",
    "nastran": "bdf",  # meshio fails to write the torus in it, but not a plane mesh
    "tecplot": "dat",
}


def lifted(points):
    return np.column_stack((points, np.zeros(len(points)))) if points.shape[1] == 2 else points


def store(path, mesh, **options):
    points, triangles = mesh
    contents = meshio.Mesh(lifted(points), [("triangle", triangles)])
    meshio.write(path, contents, **options)
    return path


def sizes_of(mesh):
    points, triangles = mesh
    return lepp.lepp_sizes(lepp.Triangulation.from_arrays(points, triangles))


@pytest.mark.parametrize("kind", [*sorted(READ.keys() - {"nastran"}), "xdmf"])
def test_formats(tmp_path, kind):
    options = {"data_format": "XML"} if kind == "xdmf" else {}
    path = store(tmp_path / f"mesh.{READ.get(kind, kind)}", SURFACE, file_format=kind, **options)
    mesh = read_mesh(path)
    assert len(mesh.triangulation) == len(SURFACE[1])
    if kind == "stl":  # single precision: other lengths, the same triangles
        assert mesh.triangulation.n_hull == 0
        assert "points that are equal are joined" in mesh.notes[0]
    elif kind not in ("abaqus", "tecplot"):  # these keep fewer digits
        assert np.array_equal(lepp.lepp_sizes(mesh.triangulation), sizes_of(SURFACE))


def test_a_constant_height_is_a_plane(tmp_path):
    path = store(tmp_path / "mesh.vtu", PLANE)
    mesh = read_mesh(path)
    assert mesh.triangulation.points.shape[1] == 2
    assert np.array_equal(lepp.lepp_sizes(mesh.triangulation), sizes_of(PLANE))
    found = as_json(survey(mesh))["mesh"]
    assert found["n_boundary_loops"] == 2
    assert (found["n_pieces"], found["n_holes"], found["euler_number"]) == (1, 1, 0)
    assert any("in no triangle" in note for note in mesh.notes)


def test_shapes_in_space(tmp_path):
    shapes = {}
    for name in ("torus", "icosphere", "two pieces"):
        found = as_json(survey(read_mesh(store(tmp_path / "mesh.ply", MESHES[name]))))["mesh"]
        assert found["n_holes"] is None
        shapes[name] = (found["n_pieces"], found["euler_number"], found["n_boundary_edges"])
    assert shapes == {"torus": (1, 0, 0), "icosphere": (1, 2, 0), "two pieces": (2, 4, 0)}


def test_pieces_that_touch_in_a_point_are_no_hole_and_two_pieces(tmp_path):
    points = np.array([[0, 0], [1, 0], [0, 1], [-1, 0], [0, -1.0]])
    path = store(tmp_path / "mesh.vtu", (points, np.array([[0, 1, 2], [0, 3, 4]])))
    found = as_json(survey(read_mesh(path)))["mesh"]
    assert (found["n_pieces"], found["n_holes"], found["n_boundary_loops"]) == (2, 0, 1)


def test_survey_counts_what_a_loop_counts(tmp_path):
    found = survey(read_mesh(store(tmp_path / "mesh.vtu", MESHES["shaken circle"])))
    paths, m = found.paths, len(found.triangulation)
    told = as_json(found)
    assert told["lepp"]["mean"] == pytest.approx(sum(paths.sizes.tolist()) / m)
    assert told["lepp"]["histogram"] == [
        [size, paths.sizes.tolist().count(size)] for size in sorted(set(paths.sizes.tolist()))
    ]
    half = sorted(paths.sizes.tolist())[(m + 1) // 2 - 1]
    assert told["lepp"]["quantiles"]["0.5"] == half
    assert told["worst"]["size"] == max(paths.sizes) == len(told["worst"]["path"])
    worst = [step["triangle"] for step in told["worst"]["path"]]
    assert all(paths.successors[a] == b for a, b in pairwise(worst))
    pairs = sum(
        1
        for t in range(m)
        if paths.successors[t] >= 0 and paths.successors[paths.successors[t]] == t
    )
    assert told["regions"]["pair_share"] == pairs / m
    assert told["regions"]["n"] == len(set(paths.regions.tolist()))
    assert sum(size * number for size, number in told["regions"]["histogram"]) == m
    assert told["theory"]["p"] == pairs / (m - told["neighbor_types"]["none"])


def test_theory_says_nothing_where_no_path_ends_inside(tmp_path):
    strip = lepp.worst_case_strip(40)
    told = as_json(survey(read_mesh(store(tmp_path / "a.vtu", (strip.points, strip.triangles)))))
    assert told["theory"] == {"p": 0.0, "mean": None, "sd": None}
    assert told["worst"]["size"] == 40
    one = (np.array([[0, 0], [1, 0], [0, 1.0]]), np.array([[0, 1, 2]]))
    told = as_json(survey(read_mesh(store(tmp_path / "b.vtu", one))))
    assert told["theory"]["p"] is None
    assert told["lepp"]["skewness"] is None


@pytest.mark.parametrize("extension", FORMATS)
def test_output_keeps_the_data_and_adds_the_paths(tmp_path, extension):
    points, triangles = PLANE
    m = len(triangles)
    contents = meshio.Mesh(
        lifted(points),
        [("triangle", triangles[:50]), ("line", [[0, 1]]), ("triangle", triangles[50:])],
        point_data={"height": points[:, 0]},
        cell_data={"material": [np.arange(50.0), [-1.0], np.arange(50.0, m)]},
    )
    source = tmp_path / "mesh.vtu"
    contents.write(source)
    found = survey(read_mesh(source))
    assert found.mesh.blocks.tolist() == [0] * 50 + [2] * (m - 50)
    output = tmp_path / f"out{extension}"
    write_mesh(found, output)
    assert {path.name for path in tmp_path.iterdir()} == {source.name, output.name}
    back, reason = reader.read(str(output))
    assert reason == ""

    def column(name):
        return np.concatenate([np.asarray(block) for block in back.cell_data[name]])

    cells = np.concatenate([block.data for block in back.cells if block.type == "triangle"])
    assert np.array_equal(cells, triangles)
    place = np.flatnonzero(column("lepp_triangle") >= 0)
    assert column("lepp_triangle")[place].tolist() == list(range(m))
    assert column("lepp_size")[place].tolist() == found.paths.sizes.tolist()
    assert column("lepp_region")[place].tolist() == found.paths.regions.tolist()
    assert column("lepp_neighbor_type")[place].tolist() == found.paths.neighbor_types.tolist()
    following = column("lepp_successor")[place].astype(int)
    inner = following >= 0
    assert np.array_equal(column("lepp_triangle")[following[inner]], found.paths.successors[inner])
    on_worst = np.argsort(column("lepp_worst_path")[place], kind="stable")[-len(found.worst_path) :]
    assert on_worst.tolist() == found.worst_path.tolist()
    assert column("material")[place].tolist() == list(range(m))
    assert np.allclose(back.point_data["height"], points[:, 0])


def test_output_of_quads_has_their_triangles(tmp_path):
    points = np.array([[0, 0, 0], [1, 0, 0], [2, 0, 0], [0, 1, 0], [1, 1.5, 0], [2, 1, 0]])
    contents = meshio.Mesh(
        points,
        [("triangle", [[3, 4, 0]]), ("quad", [[0, 1, 4, 3], [1, 2, 5, 4]])],
        cell_data={"k": [[9], [1, 2]]},
    )
    del contents.cells[0]
    contents.cell_data["k"] = [np.array([1, 2])]
    source = tmp_path / "quads.vtu"
    contents.write(source)
    found = survey(read_mesh(source, ReadOptions(split_quads=True)))
    assert "Split into two triangles each: 2 cells of type quad." in found.mesh.notes
    write_mesh(found, tmp_path / "out.vtu")
    back = meshio.read(tmp_path / "out.vtu")
    assert [(block.type, len(block.data)) for block in back.cells] == [("triangle", 4)]
    assert back.cell_data["k"][0].tolist() == [1, 1, 2, 2]
    assert back.cell_data["lepp_size"][0].tolist() == found.paths.sizes.tolist()
    assert found.mesh.cells.tolist() == [0, 0, 1, 1]


def test_outputs_that_are_refused(tmp_path):
    source = store(tmp_path / "mesh.vtu", PLANE)
    before = hashlib.sha256(source.read_bytes()).hexdigest()
    found = survey(read_mesh(source))
    (tmp_path / "link.vtu").symlink_to(source)
    for output, sentence in (
        (source, "is the mesh itself"),
        (tmp_path / "link.vtu", "is the mesh itself"),
        (tmp_path / "out.stl", "cannot keep data of cells"),
        (tmp_path / "out", "cannot keep data of cells"),
        (tmp_path / "nowhere" / "out.vtu", "There is no directory"),
    ):
        with pytest.raises(lepp.InputError, match=sentence):
            write_mesh(found, output)
    assert hashlib.sha256(source.read_bytes()).hexdigest() == before


def test_stl_files_are_joined_and_cleaned(tmp_path):
    corners = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0.5], [0, 1, 0.0]])
    facets = [[0, 1, 2], [0, 2, 3], [1, 1, 2]]
    lines = ["solid mesh"]
    for facet in facets:
        lines += ["facet normal 0 0 1", "outer loop"]
        lines += ["vertex " + " ".join(map(str, corners[k])) for k in facet]
        lines += ["endloop", "endfacet"]
    path = tmp_path / "mesh.stl"
    path.write_text("\n".join([*lines, "endsolid mesh", ""]))
    mesh = read_mesh(path)
    assert len(mesh.triangulation) == 2
    assert mesh.triangulation.n_hull == 4
    assert mesh.cells.tolist() == [0, 1]
    assert any("Triangles 2 have the same point twice" in note for note in mesh.notes)


def test_duplicates_are_dropped_only_if_asked_to(tmp_path):
    points, triangles = PLANE
    doubled = np.vstack((triangles[:7], triangles[3:5], triangles[7:]))
    path = store(tmp_path / "mesh.vtu", (points, doubled))
    with pytest.raises(lepp.MeshError, match="Triangles 7, 8 have the same three vertices"):
        read_mesh(path)
    mesh = read_mesh(path, ReadOptions(drop_duplicates=True))
    assert np.array_equal(lepp.lepp_sizes(mesh.triangulation), sizes_of(PLANE))
    assert mesh.cells[6:8].tolist() == [6, 9]


def test_mixed_orders_are_told(tmp_path):
    points, triangles = PLANE
    mixed = lepp.Triangulation.from_arrays(points, triangles).triangles.copy()
    mixed[[4, 9]] = mixed[[4, 9]][:, [0, 2, 1]]
    mesh = read_mesh(store(tmp_path / "mesh.vtu", (points, mixed)))
    assert any(note.startswith("Triangles 4, 9 list their points") for note in mesh.notes)


@pytest.mark.parametrize(
    ("name", "content", "sentence"),
    [
        ("none.vtu", None, "There is no file"),
        ("empty.vtk", b"", "is empty"),
        ("mesh.docx", b"x", "the extensions known are .*vtu"),
        ("mesh", b"x", "the extensions known are"),
        ("a.vtu", b"<VTKFile", "could not be read as a .vtu file"),
        ("a.vtk", b"# vtk DataFile Version 3.0\nx\nASCII\nDATASET POLYDATA\n", "POLYDATA"),
        ("a.msh", b"$MeshFormat\n9.9 0 8\n$EndMeshFormat\n", "could not be read as a .msh"),
        ("a.off", b"OFF\n3 1 0\n0 0 0\n", "could not be read as a .off"),
        ("a.stl", b"solid\n", "could not be read|no triangles"),
        ("a.ply", b"ply\nformat ascii 7.0\nelement vertex 3\n", "could not be read"),
        ("a.obj", b"v 0 0 0\n", "no triangles"),
    ],
)
def test_files_that_cannot_be_used(tmp_path, name, content, sentence):
    path = tmp_path / name
    if content is not None:
        path.write_bytes(content)
    with pytest.raises(lepp.InputError, match=sentence) as raised:
        read_mesh(path)
    assert "Traceback" not in str(raised.value)
    assert len(str(raised.value)) < 600


def test_directories_are_no_meshes(tmp_path):
    with pytest.raises(lepp.InputError, match="is not a file"):
        read_mesh(tmp_path)


@pytest.mark.parametrize(
    ("name", "content"),
    [("mesh.mdpa", "Begin Nodes\n"), ("mesh.ply", "ply\nformat ascii 1.0\nelement vertex 3\n")],
)
def test_a_reader_that_never_ends_is_stopped(tmp_path, monkeypatch, name, content):
    monkeypatch.setattr(meshio_process, "_SECONDS", 1.0)
    path = tmp_path / name
    path.write_text(content)  # meshio looks for the end of this part for ever
    with pytest.raises(lepp.InputError, match="not done after 1 s of processor time") as raised:
        read_mesh(path)
    assert "--read-limit SECONDS gives it longer" in str(raised.value)
    with pytest.raises(lepp.InputError, match="not done after 2 s of processor time"):
        read_mesh(path, ReadOptions(read_limit=2.0))


def test_a_file_name_does_not_shadow_a_module(tmp_path, monkeypatch):
    (tmp_path / "numpy.py").write_text("raise RuntimeError('not this one')")
    monkeypatch.chdir(tmp_path)
    assert len(read_mesh(store(Path("mesh.vtu"), PLANE)).triangulation) == len(PLANE[1])


class _Hang(BaseException):
    """Raised into a reader that does not end; not an exception that a reader would catch."""


@contextmanager
def limited(seconds):
    def stop(*_):
        raise _Hang

    before = signal.signal(signal.SIGALRM, stop)
    signal.setitimer(signal.ITIMER_REAL, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)


def _mutations(content, rng):
    """The content cut short, with bytes changed, with a piece left out, with a number changed."""
    n = len(content)
    yield content[: int(rng.integers(1, n))]
    changed = bytearray(content)
    for place in rng.integers(0, n, size=3):
        changed[place] = int(rng.integers(0, 256))
    yield bytes(changed)
    start = int(rng.integers(0, n))
    yield content[:start] + content[start + int(rng.integers(1, 40)) :]
    digits = [k for k, byte in enumerate(content) if 48 <= byte <= 57]
    if digits:
        changed = bytearray(content)
        changed[int(rng.choice(digits))] = 57
        yield bytes(changed)


@pytest.mark.parametrize("kind", READ)
@pytest.mark.filterwarnings("ignore")  # meshio's and NumPy's, about the damaged numbers
def test_damaged_files_end_in_a_mesh_or_in_a_sentence(tmp_path, monkeypatch, kind):
    extension = READ[kind]
    content = store(
        tmp_path / f"whole.{extension}", MESHES["L shape"], file_format=kind
    ).read_bytes()
    path = tmp_path / f"damaged.{extension}"
    # The readers run in this process, which is much faster; the alarm stands for the time limit.
    monkeypatch.setattr(reading, "read_file", lambda path, _: reader.read(str(path))[0])
    rng = np.random.default_rng(sum(kind.encode()))
    read = refused = stopped = 0
    for _ in range(5):
        for damaged in _mutations(content, rng):
            path.write_bytes(damaged)
            try:
                with limited(0.25):
                    contents = reading.read_file(path, None)
            except _Hang:
                stopped += 1
                continue
            if contents is None:
                refused += 1
                continue
            monkeypatch.setattr(reading, "read_file", lambda *_, mesh=contents: mesh)
            try:
                as_json(survey(read_mesh(path, ReadOptions(split_quads=True))))
                read += 1
            except lepp.InputError:
                refused += 1
            monkeypatch.setattr(reading, "read_file", lambda path, _: reader.read(str(path))[0])
    assert refused > 0
    assert read + refused + stopped >= 15
