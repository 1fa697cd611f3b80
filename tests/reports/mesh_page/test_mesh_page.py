"""The page of one mesh: what it holds, and how it behaves in a real browser."""

import base64
import json
import re
import zlib
from collections.abc import Callable, Iterator
from pathlib import Path

import meshio
import numpy as np
import pytest
import skfem
import trimesh
from playwright.sync_api import Browser, Page

import lepp
from reports.mesh_page import findings
from reports.mesh_page import page as mesh_page
from reports.mesh_page.page import drawn_triangles, packed, render, size_classes
from study.meshes.read import ReadMesh
from study.meshes.survey import Survey, survey


def _survey(points: np.ndarray, triangles: np.ndarray, name: str) -> Survey:
    mesh = lepp.Triangulation.from_arrays(points, triangles)
    m = len(mesh)
    contents = meshio.Mesh(points, [("triangle", triangles)])
    return survey(ReadMesh(Path(name), contents, mesh, np.zeros(m, int), np.arange(m), ()))


@pytest.fixture(scope="module")
def plane() -> Survey:
    disk = skfem.MeshTri.init_circle(3)
    points = disk.p.T + np.random.default_rng(3).normal(scale=0.01, size=disk.p.T.shape)
    return _survey(points, disk.t.T, "a <b>&.vtu")


@pytest.fixture(scope="module")
def surface() -> Survey:
    torus = trimesh.creation.torus(2.0, 0.7, major_sections=24, minor_sections=12)
    return _survey(np.array(torus.vertices), np.array(torus.faces), "torus.ply")


@pytest.fixture(scope="module")
def lattice() -> Survey:
    """Equilateral triangles in space, where coordinates are exact: all edges are equal."""
    k = 6
    a, b = (grid.ravel() for grid in np.meshgrid(np.arange(k), np.arange(k), indexing="ij"))
    corner = a[(a < k - 1) & (b < k - 1)] * k + b[(a < k - 1) & (b < k - 1)]
    triangles = np.concatenate(
        (
            np.column_stack((corner, corner + k, corner + k + 1)),
            np.column_stack((corner, corner + k + 1, corner + 1)),
        )
    )
    # All edges are (1, -1, 0), (0, 1, -1), or their sum.
    points = np.column_stack((a, b - a, -b)).astype(float)
    return _survey(points, triangles, "lattice.ply")


@pytest.fixture(scope="module")
def fan() -> Survey:
    """Triangles about a point, three to a quarter: longest edges meet there, and some are equal."""
    rim = [(4, 0), (4, 3), (3, 4), (0, 4), (-3, 4), (-4, 3), (-4, 0), (-4, -3), (-3, -4), (0, -4)]
    points = np.array([(0, 0), *rim, (3, -4), (4, -3)], float)
    around = np.arange(1, len(points))
    triangles = np.column_stack((np.zeros_like(around), around, np.roll(around, -1)))
    return _survey(points, triangles, "fan.vtu")


@pytest.fixture(scope="module")
def kite() -> Survey:
    """The path of the second triangle ends in a pair, that of the first on the boundary."""
    points = np.array([(0, 0), (5, 0), (3, 4), (2, -1)], float)
    return _survey(points, np.array([(0, 1, 2), (1, 0, 3)]), "kite.vtu")


def unpacked(found: Survey, drawn: np.ndarray) -> list[np.ndarray]:
    about = mesh_page.drawing(found, drawn)
    content = zlib.decompress(base64.b64decode(packed(found, drawn)))
    m, n, d = about["triangles"], about["points"], about["dimensions"]
    lengths = np.cumsum([n * d, 3 * m, m, m])
    assert len(content) == 4 * (lengths[-1] + m) + m
    points, *rest = np.split(np.frombuffer(content[:-m], "<i4"), lengths)
    ends = np.frombuffer(content[-m:], np.uint8)
    return [points.view("<f4").reshape(n, d), rest[0].reshape(m, 3), *rest[1:], ends]


@pytest.mark.parametrize("name", ["plane", "surface", "lattice", "fan", "kite"])
def test_data_block_is_the_survey(name: str, request: pytest.FixtureRequest) -> None:
    found: Survey = request.getfixturevalue(name)
    drawn = drawn_triangles(found)
    points, triangles, successors, sizes, numbers, ends = unpacked(found, drawn)
    own = found.triangulation
    corners = own.points[own.triangles]
    scale = np.ptp(own.points, axis=0).max() / 2
    middle = (own.points.min(axis=0) + own.points.max(axis=0)) / 2
    assert np.allclose(points[triangles], (corners - middle) / scale, atol=1e-6)
    assert np.array_equal(sizes, found.paths.sizes)
    assert np.array_equal(numbers, np.arange(len(own)))
    assert np.array_equal(successors, found.paths.successors)
    types = found.paths.neighbor_types
    assert np.array_equal(ends == 0, (types == lepp.TYPE_A) | (types == lepp.TYPE_B))
    for t in np.flatnonzero(ends):
        in_pair, across = divmod(ends[t] - 1, 3)
        assert in_pair == (types[t] == lepp.TYPE_C)
        edge = np.delete(own.triangles[t], across)
        assert set(edge) == set(found.paths.terminal_edges[found.paths.regions[t]])


def test_of_a_large_mesh_the_surroundings_of_the_longest_path_are_drawn(plane: Survey) -> None:
    drawn = drawn_triangles(plane, 60)
    assert len(drawn) == 60
    assert np.isin(plane.worst_path, drawn).all()
    _, _, successors, sizes, numbers, ends = unpacked(plane, drawn)
    assert np.array_equal(sizes, plane.paths.sizes[drawn])
    assert np.array_equal(ends, unpacked(plane, drawn_triangles(plane))[5][drawn])
    assert mesh_page.drawing(plane, drawn)["total"] == len(plane.triangulation)
    for place, t in enumerate(drawn):
        following = plane.paths.successors[t]
        if following in drawn:
            assert numbers[successors[place]] == following
        else:
            assert successors[place] == -1


@pytest.mark.parametrize("name", ["plane", "lattice", "fan", "kite"])
def test_longest_path_is_told_with_the_edge_that_it_ends_at(
    name: str, request: pytest.FixtureRequest
) -> None:
    found: Survey = request.getfixturevalue(name)
    *_, before, last = found.worst_path
    shared = set(found.triangulation.triangles[before]) & set(found.triangulation.triangles[last])
    said = re.search(r"edge is (.*), from point ([\d,]+) to point ([\d,]+)", findings.worst(found))
    assert said
    ends = {int(point.replace(",", "")) for point in said.groups()[1:]}
    in_pair = found.paths.neighbor_types[before] == lepp.TYPE_C
    assert said[1] == ("between the last two" if in_pair else "on the boundary")
    assert (ends == shared) == in_pair


@pytest.mark.parametrize("largest", [1, 2, 5, 6, 16, 17, 40, 5000])
def test_every_size_has_one_shade(largest: int) -> None:
    classes = size_classes(largest)
    covered = [size for low, high in classes for size in range(low, high + 1)]
    assert covered == list(range(1, largest + 1))
    assert len(classes) <= 5


def test_page_is_whole_the_same_every_time_and_escaped(plane: Survey) -> None:
    text = render(plane)
    assert text == render(plane)
    assert "a &lt;b&gt;&amp;.vtu" in text
    assert "<b>" not in text
    assert not re.search(r"(src|href)=[\"']https?:", text)
    about = re.search(r'id="mesh-drawing">(.*?)</script>', text)
    assert about
    assert json.loads(about[1])["triangles"] == len(plane.triangulation)


@pytest.fixture
def open_mesh(browser: Browser, tmp_path: Path) -> Iterator[Callable[..., Page]]:
    contexts = []
    complaints: list[str] = []

    def open_page(found: Survey, address: str = "", **options: object) -> Page:
        path = tmp_path / "mesh.html"
        path.write_text(render(found), encoding="utf-8")
        options.setdefault("viewport", {"width": 1280, "height": 1000})
        context = browser.new_context(**options)  # type: ignore[arg-type]
        contexts.append(context)
        page = context.new_page()
        page.on("console", lambda m: complaints.append(f"{m.type}: {m.text}"))
        page.on("pageerror", lambda error: complaints.append(f"error: {error}"))
        page.on("request", lambda request: complaints.append(request.url))
        page.goto(path.as_uri() + address)
        page.wait_for_selector(".stage[data-drawn]")
        page.locator(".stage").scroll_into_view_if_needed()
        assert complaints.pop(0) == path.as_uri()
        return page

    yield open_page
    for context in contexts:
        context.close()
    assert complaints == []


def chosen(page: Page) -> int:
    return int(page.locator(".stage").get_attribute("data-chosen") or -1)


def on_screen(page: Page, points: np.ndarray) -> np.ndarray:
    """Where points of a plane mesh lie; the whole of it is shown from here on."""
    page.get_by_role("button", name="Whole mesh").click()
    page.locator(".stage").evaluate(
        "stage => stage.scrollIntoView({ block: 'center', behavior: 'instant' })"
    )
    box = page.locator(".stage").bounding_box()
    assert box
    low, high = points.min(axis=0), points.max(axis=0)
    scale = min((box["width"] - 32) / (high - low)[0], (box["height"] - 32) / (high - low)[1])
    x, y = (scale * (points - (low + high) / 2)).T
    return np.column_stack((box["x"] + box["width"] / 2 + x, box["y"] + box["height"] / 2 - y))


def picture(page: Page) -> str:
    page.wait_for_timeout(100)
    return page.locator("canvas").first.evaluate("canvas => canvas.toDataURL()")


@pytest.mark.browser
def test_pointing_at_a_triangle_names_its_path(open_mesh: Callable, plane: Survey) -> None:
    page = open_mesh(plane)
    own = plane.triangulation
    centers = on_screen(page, own.points)[own.triangles].mean(axis=1)
    for t in range(0, len(own), 17):
        page.mouse.move(*centers[t])
        assert chosen(page) == t
        said = page.locator(".sentence").inner_text()
        assert said.startswith(f"Triangle {t}: LEPP size {plane.paths.sizes[t]}.")
    path = page.locator("canvas").nth(1).evaluate("canvas => canvas.toDataURL()")
    page.mouse.move(*centers[plane.worst_path[0]])
    assert page.locator("canvas").nth(1).evaluate("canvas => canvas.toDataURL()") != path
    names = " → ".join(f"{t:,}" for t in plane.worst_path)
    if len(plane.worst_path) <= 12:
        assert names in page.locator(".sentence").inner_text()


@pytest.mark.browser
def test_keys_step_and_follow_the_path(open_mesh: Callable, plane: Survey) -> None:
    page = open_mesh(plane)
    start = int(plane.worst_path[0])
    assert chosen(page) == start
    page.locator(".stage").focus()
    page.keyboard.press("Enter")
    assert chosen(page) == plane.worst_path[1]
    before = chosen(page)
    seen = set()
    for key in ("ArrowLeft", "ArrowUp", "ArrowRight", "ArrowDown"):
        page.keyboard.press(key)
        after = chosen(page)
        assert after == before or after in plane.triangulation.neighbors[before]
        seen.add(after)
        before = after
    assert len(seen) > 1
    page.keyboard.press("Home")
    assert chosen(page) == 0


@pytest.mark.browser
def test_a_triangle_can_be_asked_for_and_the_drawing_moved(
    open_mesh: Callable, plane: Survey
) -> None:
    page = open_mesh(plane)
    page.get_by_role("button", name="Whole mesh").click()
    whole = picture(page)
    page.get_by_label("Triangle", exact=True).fill("41")
    page.keyboard.press("Enter")
    assert chosen(page) == 41
    assert picture(page) != whole
    page.get_by_role("button", name="Whole mesh").click()
    assert picture(page) == whole
    page.get_by_role("button", name="Closer").click()
    assert picture(page) != whole
    for number in ("99999", "-1"):
        page.get_by_label("Triangle", exact=True).fill(number)
        page.keyboard.press("Enter")
        said = page.locator(".sentence").inner_text()
        assert said.startswith(f"There is no triangle {number}.")
        assert f"from 0 to {len(plane.triangulation) - 1}." in said
        assert chosen(page) == 41
    page.get_by_role("button", name="Longest path").click()
    assert chosen(page) == plane.worst_path[0]


@pytest.mark.browser
def test_of_a_part_the_button_and_the_field_know_the_whole(
    open_mesh: Callable, plane: Survey, monkeypatch: pytest.MonkeyPatch
) -> None:
    drawn = drawn_triangles(plane, 60)
    monkeypatch.setattr(mesh_page, "drawn_triangles", lambda found: drawn)
    page = open_mesh(plane)
    assert page.get_by_role("button", name="Whole mesh").count() == 0
    assert page.get_by_role("button", name="All that is drawn").count() == 1
    absent = np.setdiff1d(np.arange(len(plane.triangulation)), drawn)[0]
    page.get_by_label("Triangle", exact=True).fill(str(absent))
    page.keyboard.press("Enter")
    said = page.locator(".sentence").inner_text()
    assert said == f"Triangle {absent} is not among the 60 that are drawn."
    page.get_by_label("Triangle", exact=True).fill(str(len(plane.triangulation)))
    page.keyboard.press("Enter")
    assert page.locator(".sentence").inner_text().startswith("There is no triangle")


@pytest.mark.browser
def test_a_link_opens_at_its_triangle(open_mesh: Callable, plane: Survey) -> None:
    page = open_mesh(plane, address="#triangle=41")
    assert chosen(page) == 41
    link = page.locator("a.link")
    assert link.get_attribute("href") == "#triangle=41"
    assert link.inner_text() == "Link to triangle 41"
    page.locator(".stage").focus()
    page.keyboard.press("Home")
    assert link.get_attribute("href") == "#triangle=0"
    link.click()
    assert page.evaluate("location.hash") == "#triangle=0"
    page.evaluate("location.hash = '#triangle=17'")
    page.wait_for_selector(".stage[data-chosen='17']")
    page.evaluate("location.hash = '#triangle=9999'")
    page.wait_for_function(
        "document.querySelector('.sentence').textContent.includes('no triangle')"
    )
    assert chosen(page) == 17
    page.evaluate("location.hash = '#spread'")  # a section, of no triangle
    assert chosen(page) == 17


@pytest.mark.browser
def test_what_is_drawn_can_be_saved(open_mesh: Callable, plane: Survey, tmp_path: Path) -> None:
    page = open_mesh(plane)

    def saved(name: str) -> tuple[str, bytes]:
        with page.expect_download() as waiting:
            page.get_by_role("button", name=name).click()
        waiting.value.save_as(tmp_path / "saved")
        return waiting.value.suggested_filename, (tmp_path / "saved").read_bytes()

    name, triangles = saved("The triangles drawn as CSV")
    assert name.endswith("-triangles.csv")
    head, *rows = triangles.decode().splitlines()
    assert head == "triangle,lepp_size,next_triangle,ends_at"
    assert [row.split(",")[:2] for row in rows] == [
        [str(t), str(size)] for t, size in enumerate(plane.paths.sizes)
    ]
    ends = {lepp.TYPE_NONE: "boundary", lepp.TYPE_C: "pair"}
    for t, row in enumerate(rows):
        _, _, following, end = row.split(",")
        assert int(following or -1) == plane.paths.successors[t]
        assert end == ends.get(plane.paths.neighbor_types[t], "")

    name, sizes = saved("Triangles by the size of their path: CSV")
    assert name.endswith("-sizes.csv")
    counts = np.bincount(plane.paths.sizes)
    counted = [f"{size},{counts[size]}" for size in np.flatnonzero(counts)]
    assert sizes.decode().splitlines() == ["lepp_size,triangles", *counted]
    name, regions = saved("Terminal-edge regions by their size: CSV")
    assert name.endswith("-regions.csv")
    rows = [row.split(",") for row in regions.decode().splitlines()[1:]]
    assert sum(int(size) * int(n) for size, n in rows) == len(plane.triangulation)

    before = picture(page)
    name, drawing = saved("The drawing as PNG")
    assert name.endswith("-lepp.png")
    assert drawing.startswith(b"\x89PNG")
    box = page.locator(".stage").bounding_box()
    assert box
    width, height = (int.from_bytes(drawing[k : k + 4], "big") for k in (16, 20))
    assert abs(width - 2 * box["width"]) <= 2
    assert abs(height - 2 * box["height"]) <= 2
    assert picture(page) == before


@pytest.mark.browser
@pytest.mark.parametrize("name", ["lattice", "fan"])
def test_paths_between_equal_edges_are_as_long_as_their_sizes(
    open_mesh: Callable, name: str, request: pytest.FixtureRequest
) -> None:
    found: Survey = request.getfixturevalue(name)
    paths = found.paths
    page = open_mesh(found)
    ends = set()
    mutual = []
    for t in range(len(found.triangulation)):
        page.get_by_label("Triangle", exact=True).fill(str(t))
        page.keyboard.press("Enter")
        said = page.locator(".sentence").inner_text()
        path = [t]
        while len(path) < paths.sizes[t]:
            path.append(int(paths.successors[path[-1]]))
        if len(path) == 1:
            assert said.endswith("LEPP size 1. Its longest edge lies on the boundary.")
            continue
        in_pair = paths.neighbor_types[path[-2]] == lepp.TYPE_C
        ends.add(bool(in_pair))
        mutual.append(paths.successors[path[-1]] == path[-2])
        assert said == (
            f"Triangle {t}: LEPP size {len(path)}. The path goes {' → '.join(map(str, path))}. "
            + (
                "It ends at an edge that is the longest of both triangles beside it."
                if in_pair
                else "It ends at an edge of the boundary."
            )
        )
    assert True in ends
    assert not all(mutual)  # or the mesh does not show what it is for


@pytest.mark.browser
@pytest.mark.parametrize("n_points", [100, 20_000])
def test_the_longest_path_is_large_enough_to_be_seen_at_the_start(
    open_mesh: Callable, n_points: int
) -> None:
    """Where the whole is shown it would be some pixels, but for its last triangles."""
    points = np.random.default_rng(4).random((n_points, 2))
    mesh = lepp.triangulate(points, method="delaunay")
    page = open_mesh(_survey(points, mesh.triangles, "random.vtu"))
    coloured = """canvas => {
        const { width, height } = canvas;
        const { data } = canvas.getContext("2d").getImageData(0, 0, width, height);
        return data.filter((value, k) => k % 4 === 3 && value).length;
    }"""
    overlay = page.locator("canvas").nth(1)
    assert overlay.evaluate(coloured) > 3000
    start = picture(page)
    page.get_by_role("button", name="Whole mesh").click()
    assert (picture(page) == start) == (n_points == 100)


@pytest.mark.browser
def test_a_surface_is_turned_and_its_front_is_pointed_at(
    open_mesh: Callable, surface: Survey
) -> None:
    page = open_mesh(surface)
    before = picture(page)
    box = page.locator(".stage").bounding_box()
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x + 90, y + 40, steps=5)
    page.mouse.up()
    assert picture(page) != before
    turned = picture(page)
    page.locator(".stage").focus()
    page.keyboard.press("Shift+ArrowLeft")
    assert picture(page) != turned


@pytest.mark.browser
def test_of_a_surface_the_front_is_pointed_at(open_mesh: Callable) -> None:
    sphere = trimesh.creation.icosphere(2)
    found = _survey(np.array(sphere.vertices), np.array(sphere.faces), "sphere.ply")
    page = open_mesh(found)
    box = page.locator(".stage").bounding_box()
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    centers = found.triangulation.points[found.triangulation.triangles].mean(axis=1)
    page.mouse.move(x, y)
    one = chosen(page)
    page.mouse.down()
    page.mouse.move(
        x + 75, y, steps=6
    )  # half a radian: the front goes along, the back the other way
    page.mouse.up()
    radius = (min(box["width"], box["height"]) - 32) / 2
    page.mouse.move(x + radius * np.sin(0.5), y)
    assert centers[one] @ centers[chosen(page)] > 0.97
    page.mouse.move(x, y)
    assert centers[one] @ centers[chosen(page)] < 0.95


@pytest.mark.browser
@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("width", [360, 1280])
def test_it_fits_and_follows_the_theme(
    open_mesh: Callable, surface: Survey, scheme: str, width: int
) -> None:
    page = open_mesh(surface, color_scheme=scheme, viewport={"width": width, "height": 900})
    assert page.evaluate("document.documentElement.scrollWidth") == width
    for histogram in page.locator(".scroll:has(.histogram)").all():
        assert histogram.evaluate("table => table.scrollWidth - table.clientWidth") == 0
    before = picture(page)
    theme = page.locator("#theme")
    other = "Dark" if scheme == "light" else "Light"
    assert (theme.text_content() or "").strip() == other  # the one it switches to
    theme.click()
    assert picture(page) != before
    assert (theme.text_content() or "").strip() == scheme.capitalize()
    legend = page.locator(".size-key li").all_inner_texts()
    assert legend == [
        str(low) if low == high else f"{low}–{high}"
        for low, high in size_classes(int(surface.paths.sizes.max()))
    ]


@pytest.mark.browser
def test_many_triangles_are_drawn_in_the_same_colours(
    open_mesh: Callable, plane: Survey, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Pixel by pixel as in shapes: the middle of a triangle has the same colour."""
    own = plane.triangulation
    colours = []
    original = mesh_page.static
    for few in (False, True):
        if few:
            monkeypatch.setattr(
                mesh_page,
                "static",
                lambda *names: original(*names).replace("const MANY = 12000;", "const MANY = 1;"),
            )
        page = open_mesh(plane)
        centers = on_screen(page, own.points)[own.triangles].mean(axis=1)
        box = page.locator(".stage").bounding_box()
        colours.append(
            page.locator("canvas").first.evaluate(
                """(canvas, places) => {
                    const pen = new OffscreenCanvas(canvas.width, canvas.height)
                        .getContext("2d", { willReadFrequently: true });
                    pen.drawImage(canvas, 0, 0);
                    return places.map(([x, y]) => [...pen.getImageData(x, y, 1, 1).data]);
                }""",
                (centers[::7] - [box["x"], box["y"]]).tolist(),
            )
        )
    same = [a == b for a, b in zip(*colours, strict=True)]
    assert np.mean(same) > 0.9  # a few middles lie on an edge's line
    assert len({tuple(colour) for colour in colours[0]}) >= 3


@pytest.mark.browser
def test_it_prints(open_mesh: Callable, plane: Survey) -> None:
    page = open_mesh(plane, color_scheme="dark")
    assert page.pdf().startswith(b"%PDF")


@pytest.mark.browser
def test_axe_finds_nothing(open_mesh: Callable, plane: Survey, violations: Callable) -> None:
    assert violations(open_mesh(plane)) == []
