"""The command ``lepp-study mesh``."""

import json
import subprocess
import sys
from pathlib import Path

import meshio
import numpy as np
import pytest
from click.testing import CliRunner
from shipped_meshes import MESHES

import lepp
from reports.cli.main import main
from reports.mesh_page.remedies import in_options
from study.meshes.read import ReadOptions

INPUTS = Path(__file__).parents[2] / "study" / "meshes" / "inputs"
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
        "file", "notes", "warnings", "mesh", "lepp", "ties", "worst", "neighbor_types", "theory",
        "regions", "random_delaunay",
    ]  # fmt: skip
    assert result.stderr == f"Page: {tmp_path / 'ring.html'}\n"


def test_all_outputs_and_always_the_same_bytes(source, tmp_path):
    contents = []
    for name in ("one", "two"):
        outputs = [tmp_path / f"{name}{end}" for end in (".html", ".json", ".vtk")]
        result = call(
            source, "--html", outputs[0], "--json-file", outputs[1], "--output", outputs[2]
        )
        assert result.exit_code == 0
        contents.append([path.read_bytes() for path in outputs])
    assert contents[0] == contents[1]
    assert json.loads(contents[0][1])["file"] == "ring.vtu"


def test_outputs_that_are_the_mesh(source, tmp_path):
    before = source.read_bytes()
    for option in ("--html", "--json-file", "--output"):
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
         "--ignore-volumes takes the", "--ignore-volumes"),
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
    assert result.stderr.startswith("Error: Triangles 1 have no area")
    assert "same point twice" not in result.stderr  # that was asked for, and done
    result = call(tmp_path / "mesh.vtu")
    assert "The mesh has 2 problems.\nTriangles 2 have the same point twice" in result.stderr
    assert "\nTriangles 1 have no area" in result.stderr


def test_json_does_not_take_the_file_for_its_value(source, tmp_path):
    first = call("--json", source)
    assert json.loads(first.stdout)["file"] == "ring.vtu"
    assert call(source, "--json").stdout == first.stdout
    out = tmp_path / "out.json"
    for options in (["--json-file", out], [f"--json={out}"], [f"--json-file={out}"]):
        result = call(*options, source)
        assert result.exit_code == 0
        assert result.stdout.startswith("The longest-edge path")
        assert out.read_text(encoding="utf-8") == first.stdout
        out.unlink()
    both = call(source, "--json", f"--json={out}")
    assert (both.stdout, both.stderr) == (first.stdout, f"JSON: {out}\n")


def test_a_file_whose_name_looks_like_an_option(source, monkeypatch):
    source.rename(source.parent / "--json=ring.vtu")
    monkeypatch.chdir(source.parent)
    assert json.loads(call("--json", "--", "--json=ring.vtu").stdout)["file"] == "--json=ring.vtu"


def test_remedies_that_were_given_are_not_offered_again():
    copies = INPUTS / "copies_given_flag.obj"
    assert "--drop-duplicates leaves them out" in call(copies).stderr
    given = call(copies, "--drop-duplicates")
    assert given.exit_code == 2
    assert "--drop-duplicates" not in given.stderr
    assert "Triangles 0, 1, 2 share an edge with two or more others" in given.stderr


def test_a_seam_that_collapses_has_a_remedy_that_works():
    seam = INPUTS / "collapsed_seam.obj"
    refused = call(seam).stderr
    assert "--merge-points joins the points, and --drop-duplicates then leaves them" in refused
    assert "move a vertex" not in refused
    assert "--merge-points joins the points" in call(seam, "--drop-duplicates").stderr
    half = call(seam, "--merge-points").stderr
    assert ("--drop-duplicates" in half, "--merge-points" in half) == (True, False)
    result = call(seam, "--merge-points", "--drop-duplicates")
    assert result.exit_code == 0
    assert "has 2.00 triangles on average" in result.stdout


@pytest.mark.parametrize("remedy", lepp.Remedy)
def test_no_remedy_of_the_command_is_an_argument_of_a_function(remedy):
    for options in (ReadOptions(), ReadOptions(drop_duplicates=True)):
        words = in_options(remedy, options)
        assert "=" not in words
        assert words[-1] != "."


def test_points_without_coordinates_that_no_triangle_uses_are_left_out():
    result = call(INPUTS / "nan_point.obj", "--json")
    told = json.loads(result.stdout)
    assert told["notes"] == ["Left out, being in no triangle: points 3."]
    assert told["mesh"]["n_points"] == 3


def test_warnings_come_before_the_numbers(tmp_path):
    page, out = tmp_path / "a.html", tmp_path / "a.json"
    result = call(INPUTS / "stl_nearly_equal.stl", "--html", page, "--json-file", out)
    lines = result.stdout.splitlines()
    assert lines[0].startswith("Warning: 320 of the 320 triangles have no neighbour at all")
    assert lines[1].startswith("Warning: 960 points on the boundary nearly agree")
    assert "--merge-within 1e-06 joins such points." in lines[1]
    assert lines[2].startswith("The longest-edge path")
    texts = [entry["text"] for entry in json.loads(out.read_text(encoding="utf-8"))["warnings"]]
    assert [f"Warning: {text}" for text in texts] == lines[:2]
    html = page.read_text(encoding="utf-8")
    assert html.index("have no neighbour at all") < html.index('<p class="lede">')
    joined = call(INPUTS / "stl_nearly_equal.stl", "--merge-within", "1e-6", "--json")
    told = json.loads(joined.stdout)
    assert (told["lepp"]["mean"], told["lepp"]["max"], told["mesh"]["n_pieces"]) == (2.425, 6, 1)
    result = call(INPUTS / "hanging_node.off")
    assert result.stdout.startswith("Warning: 1 point (3) lies inside an edge of another triangle")


def test_what_nearly_equal_edges_do(tmp_path):
    page = tmp_path / "a.html"
    fan = INPUTS / "disk_fan_200.off"
    lines = call(fan, "--html", page).stdout.splitlines()
    assert lines[0] == (
        "Warning: The two longest edges of 200 triangles agree to 1e-06 of their length. If such "
        "edges are meant to be equal, the mean is 2.00 (--equal-within 1e-06)."
    )
    assert "has 2.45 triangles on average, itself included, and 5 triangles at most" in lines[1]
    counted = "No triangle has two equal longest edges; the two longest edges of 200 triangles"
    assert any(line.startswith(counted) for line in lines)
    assert counted in page.read_text(encoding="utf-8")
    lines = call(fan, "--equal-within", "1e-6").stdout.splitlines()
    assert "has 2.00 triangles on average, itself included, and 2 triangles at most" in lines[0]
    assert any(line.startswith("200 triangles have more than one longest edge") for line in lines)
    lattice = call(INPUTS / "equilateral_rowmajor.vtu").stdout
    assert not lattice.startswith("Warning")
    assert "1,682 triangles have more than one longest edge" in lattice
    refused = call(fan, "--equal-within", "2")
    assert (refused.exit_code, "equal_within" in refused.stderr) == (2, True)


def test_merging_and_keeping_exclude_each_other(source):
    result = call(source, "--merge-within", "1e-6", "--keep-points")
    assert (result.exit_code, "not both" in result.stderr) == (2, True)


def test_only_what_the_command_uses_is_imported(source, tmp_path):
    heavy = (
        "pandas", "pyarrow", "dask", "distributed", "statsmodels", "plotly", "scipy.stats",
        "study.analysis", "study.results.store",
    )  # fmt: skip
    code = f"""
import sys
from reports.cli.main import main
main(standalone_mode=False)
print(*(name for name in {heavy} if name in sys.modules))
"""
    arguments = ["--html", "a.html", "--json-file", "a.json", "--output", "a.vtu"]
    done = subprocess.run(
        [sys.executable, "-c", code, "mesh", source, *arguments],
        cwd=tmp_path, capture_output=True, text=True, check=True,
    )  # fmt: skip
    assert done.stdout.endswith("Page: a.html\n\n")
    assert done.stderr == ""


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs a device that is always full")
@pytest.mark.parametrize("options", [[], ["--json"]])
def test_a_full_standard_output_is_one_sentence(options, tmp_path):
    mesh = tmp_path / "mesh.off"
    mesh.write_text("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")
    code = "from reports.cli.main import main; main()"
    with open("/dev/full", "w") as full:
        done = subprocess.run(
            [sys.executable, "-c", code, "mesh", str(mesh), *options],
            stdout=full,
            stderr=subprocess.PIPE,
            text=True,
            check=False,
        )
    assert done.returncode == 2
    assert done.stderr == "Error: Cannot write the output: No space left on device.\n"
