"""The page of one mesh: one HTML file with the mesh drawn, coloured by LEPP size."""

import base64
import zlib
from collections.abc import Iterable

import numpy as np

import lepp
from reports.mesh_page import findings
from reports.page.assets import environment, static
from reports.page.blocks import ALWAYS, Facts, Prose, Tiles
from study.meshes.as_json import size_counts
from study.meshes.survey import Survey
from study.text.numbers import show

MOST_DRAWN = 100_000
"""Triangles that a browser draws at once without a pause; of larger meshes a part is shown."""

_MOST_CLASSES = 5  # shades that can be told apart
_STEPS = 60  # of the longest path that the table shows

# Where the longest edge, across from vertex k, is terminal; 0 where the path goes on.
_BOUNDARY, _PAIR = 1, 4


def render(survey: Survey) -> str:
    """Make the page's HTML; the same for the same mesh."""
    drawn = drawn_triangles(survey)
    return (
        environment()
        .get_template("mesh.html.j2")
        .render(
            static=static,
            name=survey.mesh.path.name,
            warnings=findings.warnings(survey).values(),
            headline=findings.headline(survey),
            tiles=Tiles({ALWAYS: findings.tiles(survey)}),
            spread=_prose(findings.spread(survey), findings.ties(survey)),
            worst=_prose(findings.worst(survey)),
            regions=_prose(findings.regions(survey)),
            theory=_prose(findings.theory(survey)),
            facts=Facts(tuple(findings.facts(survey))),
            notes=survey.mesh.notes,
            space=survey.triangulation.points.shape[1] == 3,
            n_drawn=len(drawn),
            whole=len(drawn) == len(survey.triangulation),
            n_triangles=len(survey.triangulation),
            sizes=_histogram(survey.counts.counts),
            region_sizes=_histogram(np.bincount(survey.region_sizes)),
            path=list(_path_rows(survey)),
            n_path=len(survey.worst_path),
            drawing=drawing(survey, drawn),
            data=packed(survey, drawn),
        )
    )


def drawn_triangles(survey: Survey, most: int = MOST_DRAWN) -> np.ndarray:
    """Return the triangles to draw: all, or those around the longest path, ascending."""
    triangulation = survey.triangulation
    if len(triangulation) <= most:
        return np.arange(len(triangulation))
    centers = triangulation.points[triangulation.triangles].mean(axis=1)
    path = survey.worst_path[:most]
    distances = np.linalg.norm(centers - centers[path].mean(axis=0), axis=1)
    distances[path] = -1.0
    return np.sort(np.argsort(distances, kind="stable")[:most])


def size_classes(largest: int) -> list[tuple[int, int]]:
    """Return the first and last size of each shade: one each, or doubling where there are many."""
    if largest <= _MOST_CLASSES:
        return [(size, size) for size in range(1, largest + 1)]
    starts = [1, 2, 3, 5, 9] if largest <= 16 else [1, 3, 5, 9, 17]
    starts = [start for start in starts if start <= largest]
    ends = [start - 1 for start in starts[1:]] + [largest]
    return list(zip(starts, ends, strict=True))


def drawing(survey: Survey, drawn: np.ndarray) -> dict[str, object]:
    """Describe the drawing to the page's script."""
    return {
        "points": len(np.unique(survey.triangulation.triangles[drawn])),
        "triangles": len(drawn),
        "dimensions": survey.triangulation.points.shape[1],
        "classes": size_classes(survey.counts.max),
        "worst": int(np.searchsorted(drawn, survey.worst_path[0])),
        "total": len(survey.triangulation),
        "name": survey.mesh.path.stem,
        "histograms": {
            "sizes": {
                "header": "lepp_size,triangles",
                "counts": size_counts(survey.counts.counts),
            },
            "regions": {
                "header": "triangles,regions",
                "counts": size_counts(np.bincount(survey.region_sizes)),
            },
        },
    }


def packed(survey: Survey, drawn: np.ndarray) -> str:
    """Pack the arrays that the page draws, compressed, as base64.

    Little-endian, one after the other: coordinates (float32, between -1 and 1); vertices,
    successors (as places in what is drawn; -1 where none is), sizes, and the numbers that the
    triangles have in the whole mesh (int32); and where paths end (uint8): 0 where the path goes on,
    1 + k where the longest edge, across from vertex k, is on the boundary, and 4 + k where it is
    the longest of the triangle beside it, too.
    """
    triangles = survey.triangulation.triangles[drawn]
    used, vertices = np.unique(triangles, return_inverse=True)
    points = survey.triangulation.points[used]
    low, high = points.min(axis=0), points.max(axis=0)
    middle = low / 2 + high / 2
    points = (points - middle) / max(float((high / 2 - low / 2).max()), np.finfo(float).tiny)
    arrays = (
        points.astype("<f4"),
        vertices.astype("<i4"),
        _successors(survey, drawn).astype("<i4"),
        survey.paths.sizes[drawn].astype("<i4"),
        drawn.astype("<i4"),
        _ends(survey, drawn),
    )
    content = b"".join(array.tobytes() for array in arrays)
    return base64.b64encode(zlib.compress(content, 9)).decode("ascii")


def _successors(survey: Survey, drawn: np.ndarray) -> np.ndarray:
    place = np.full(len(survey.triangulation) + 1, -1)  # the last for no successor
    place[drawn] = np.arange(len(drawn))
    return place[survey.paths.successors[drawn]]


def _ends(survey: Survey, drawn: np.ndarray) -> np.ndarray:
    types = survey.paths.neighbor_types[drawn]
    edges = survey.paths.terminal_edges[survey.paths.regions[drawn]]
    triangles = survey.triangulation.triangles[drawn]
    across = (triangles[:, :, None] != edges[:, None, :]).all(axis=2).argmax(axis=1)
    kinds = [_BOUNDARY + across, _PAIR + across]
    return np.select([types == lepp.TYPE_NONE, types == lepp.TYPE_C], kinds, 0).astype(np.uint8)


def _prose(*paragraphs: str) -> Prose:
    return Prose({ALWAYS: list(paragraphs)})


def _histogram(counts: np.ndarray) -> list[dict[str, object]]:
    rows = findings.size_rows(counts)
    most = max(share for _, _, share, _ in rows)
    return [
        {
            "size": size,
            "number": f"{number:,}",
            "share": show(share, "percent2"),
            "below": show(below, "percent2"),
            "bar": f"{100 * share / most:.1f}",
        }
        for size, number, share, below in rows
    ]


def _path_rows(survey: Survey) -> Iterable[tuple[str, ...]]:
    triangulation = survey.triangulation
    for step, t in enumerate(survey.worst_path[:_STEPS], 1):
        vertices = triangulation.triangles[t]
        centre = triangulation.points[vertices].mean(axis=0)
        yield (
            f"{step:,}",
            f"{t:,}",
            f"{survey.mesh.blocks[t]}",
            f"{survey.mesh.cells[t]:,}",
            ", ".join(f"{vertex:,}" for vertex in vertices),
            ", ".join(show(float(x), "g5") for x in centre),
        )
