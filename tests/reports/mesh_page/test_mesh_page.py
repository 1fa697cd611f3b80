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


def unpacked(found: Survey, drawn: np.ndarray) -> list[np.ndarray]:
    about = mesh_page.drawing(found, drawn)
    content = zlib.decompress(base64.b64decode(packed(found, drawn)))
    m, n, d = about["triangles"], about["points"], about["dimensions"]
    lengths = np.cumsum([n * d, 3 * m, m, m])
    points, *rest = np.split(np.frombuffer(content, "<i4"), lengths)
    return [points.view("<f4").reshape(n, d), rest[0].reshape(m, 3), *rest[1:]]


def test_data_block_is_the_survey(plane: Survey) -> None:
    drawn = drawn_triangles(plane)
    points, triangles, successors, sizes, numbers = unpacked(plane, drawn)
    own = plane.triangulation
    corners = own.points[own.triangles]
    scale = np.ptp(own.points, axis=0).max() / 2
    middle = (own.points.min(axis=0) + own.points.max(axis=0)) / 2
    assert np.allclose(points[triangles], (corners - middle) / scale, atol=1e-6)
    assert np.array_equal(sizes, plane.paths.sizes)
    assert np.array_equal(numbers, np.arange(len(own)))
    inner = plane.paths.successors >= 0
    assert np.array_equal(successors[inner], plane.paths.successors[inner])
    for t in np.flatnonzero(~inner):
        edge = np.delete(own.triangles[t], -1 - successors[t])
        assert set(edge) == set(plane.paths.terminal_edges[plane.paths.regions[t]])


def test_of_a_large_mesh_the_surroundings_of_the_longest_path_are_drawn(plane: Survey) -> None:
    drawn = drawn_triangles(plane, 60)
    assert len(drawn) == 60
    assert np.isin(plane.worst_path, drawn).all()
    _, _, successors, sizes, numbers = unpacked(plane, drawn)
    assert np.array_equal(sizes, plane.paths.sizes[drawn])
    for place, t in enumerate(drawn):
        following = plane.paths.successors[t]
        if following < 0:
            assert -3 <= successors[place] <= -1
        elif following in drawn:
            assert numbers[successors[place]] == following
        else:
            assert successors[place] == -4


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

    def open_page(found: Survey, **options: object) -> Page:
        path = tmp_path / "mesh.html"
        path.write_text(render(found), encoding="utf-8")
        options.setdefault("viewport", {"width": 1280, "height": 1000})
        context = browser.new_context(**options)  # type: ignore[arg-type]
        contexts.append(context)
        page = context.new_page()
        page.on("console", lambda m: complaints.append(f"{m.type}: {m.text}"))
        page.on("pageerror", lambda error: complaints.append(f"error: {error}"))
        page.on("request", lambda request: complaints.append(request.url))
        page.goto(path.as_uri())
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
    """Where points of a plane mesh lie when the whole of it is shown."""
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
        said = page.locator(".said").inner_text()
        assert said.startswith(f"Triangle {t}: LEPP size {plane.paths.sizes[t]}.")
    path = page.locator("canvas").nth(1).evaluate("canvas => canvas.toDataURL()")
    page.mouse.move(*centers[plane.worst_path[0]])
    assert page.locator("canvas").nth(1).evaluate("canvas => canvas.toDataURL()") != path
    names = " → ".join(f"{t:,}" for t in plane.worst_path)
    if len(plane.worst_path) <= 12:
        assert names in page.locator(".said").inner_text()


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
    whole = picture(page)
    page.get_by_label("Triangle", exact=True).fill("41")
    page.keyboard.press("Enter")
    assert chosen(page) == 41
    assert picture(page) != whole
    page.get_by_role("button", name="Whole mesh").click()
    assert picture(page) == whole
    page.get_by_role("button", name="Closer").click()
    assert picture(page) != whole
    page.get_by_label("Triangle", exact=True).fill("99999")
    page.keyboard.press("Enter")
    assert "is not drawn here" in page.locator(".said").inner_text()
    page.get_by_role("button", name="Longest path").click()
    assert chosen(page) == plane.worst_path[0]


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
    before = picture(page)
    page.locator("#theme").click()
    assert picture(page) != before
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
def test_axe_finds_nothing(open_mesh: Callable, plane: Survey, axe: str) -> None:
    page = open_mesh(plane)
    page.evaluate(axe)
    found = page.evaluate("axe.run()")
    assert [violation["id"] for violation in found["violations"]] == []
