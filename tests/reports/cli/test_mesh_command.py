"""The command ``lepp-study mesh``."""

import json

import meshio
import numpy as np
import pytest
from click.testing import CliRunner
from shipped_meshes import MESHES

import lepp
from reports.cli.main import main

POINTS, TRIANGLES = MESHES["annulus"]
SIZES = lepp.lepp_sizes(lepp.Triangulation.from_arrays(POINTS, TRIANGLES))


@pytest.fixture
def source(tmp_path):
    points = np.column_stack((POINTS, np.full(len(POINTS), 2.0)))
    path = tmp_path / "ring.vtu"
    meshio.write(path, meshio.Mesh(points, [("triangle", TRIANGLES)]))
    return path


def call(*arguments):
    result = CliRunner().invoke(main, ["mesh", *map(str, arguments)])
    assert result.exception is None or isinstance(result.exception, SystemExit)
    return result


def test_text(source):
    result = call(source)
    assert result.exit_code == 0
    lines = result.stdout.splitlines()
    assert lines[0].startswith("The longest-edge path of a triangle of ring.vtu has ")
    assert f"{SIZES.mean():.2f} triangles on average" in lines[0]
    assert f"and {SIZES.max()} triangles at most." in lines[0]
    assert "in the plane" in result.stdout
    assert "Holes: 1." in result.stdout
    numbers = [line.split()[:2] for line in lines if line.rstrip().endswith("%")]
    assert numbers == [
        [str(size), str(number)] for size, number in enumerate(np.bincount(SIZES)) if number
    ]
    assert "\x1b" not in result.stdout
    assert "\u00a0" not in result.stdout


def test_json_alone_on_the_standard_output(source, tmp_path):
    result = call(source, "--json", "--html", tmp_path / "ring.html")
    told = json.loads(result.stdout)
    assert told["lepp"]["mean"] == SIZES.mean()
    assert list(told) == [
        "file", "notes", "mesh", "lepp", "worst", "neighbor_types", "theory", "regions",
        "random_delaunay",
    ]  # fmt: skip
    assert result.stderr == f"Page: {tmp_path / 'ring.html'}\n"


def test_all_outputs_and_always_the_same_bytes(source, tmp_path):
    contents = []
    for name in ("one", "two"):
        outputs = [tmp_path / f"{name}{end}" for end in (".html", ".json", ".vtk")]
        result = call(source, "--html", outputs[0], "--json", outputs[1], "--output", outputs[2])
        assert result.exit_code == 0
        contents.append([path.read_bytes() for path in outputs])
    assert contents[0] == contents[1]
    assert json.loads(contents[0][1])["file"] == "ring.vtu"


def test_outputs_that_are_the_mesh(source, tmp_path):
    before = source.read_bytes()
    for option in ("--html", "--json", "--output"):
        result = call(source, option, source)
        assert result.exit_code == 2
        assert "is the mesh itself" in result.stderr
    result = call(source, "--html", tmp_path / "a.vtu", "--output", tmp_path / "a.vtu")
    assert (result.exit_code, "same name" in result.stderr) == (2, True)
    assert source.read_bytes() == before


@pytest.mark.parametrize(
    ("cells", "points", "sentence", "option"),
    [
        ([("quad", [[0, 1, 2, 3]])], [[0, 0, 0], [1, 0, 0], [1, 1, 1], [0, 1, 0]],
         "--split-quads splits each", "--split-quads"),
        ([("triangle", [[0, 1, 2], [3, 4, 5]])],
         [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 0, 0], [1, 1, 1], [0, 1, 0]],
         "--merge-points joins them, --keep-points leaves", "--merge-points"),
        ([("triangle", [[0, 1, 2], [3, 4, 5]])],
         [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 0, 0], [1, 1, 1], [0, 1, 0]],
         "--merge-points joins them, --keep-points leaves", "--keep-points"),
        ([("triangle", [[0, 1, 2], [2, 1, 0]])], [[0, 0, 0], [1, 0, 0], [0, 1, 0]],
         "--drop-duplicates leaves them out", "--drop-duplicates"),
        ([("tetra", [[0, 1, 2, 3]]), ("triangle", [[0, 1, 2]])],
         [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]],
         "--ignore-volumes takes the triangles", "--ignore-volumes"),
    ],
)  # fmt: skip
def test_the_option_that_a_sentence_names_helps(tmp_path, cells, points, sentence, option):
    path = tmp_path / "mesh.vtu"
    meshio.write(path, meshio.Mesh(np.array(points, float), cells))
    refused = call(path)
    assert refused.exit_code == 2
    assert sentence in refused.stderr
    assert refused.stdout == ""
    assert call(path, option).exit_code == 0


def test_every_problem_has_its_line(tmp_path):
    points = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [2, 0, 0]], float)
    mesh = meshio.Mesh(points, [("triangle", [[0, 1, 2], [0, 1, 3], [1, 1, 2]])])
    mesh.write(tmp_path / "mesh.vtu")
    result = call(tmp_path / "mesh.vtu", "--drop-duplicates")
    assert result.exit_code == 2
    assert "The mesh has 2 problems.\nTriangles 2 have the same point twice" in result.stderr
    assert "\nTriangles 1 have no area" in result.stderr
