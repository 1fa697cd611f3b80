"""The worst case: a strip whose first path covers all of it (Figure 2, equation 1)."""

import numpy as np

import lepp
from reports.page.blocks import ALWAYS, Drawing, Subsection, TableBlock, common
from reports.page.evidence import Evidence
from study.analysis.worst_case_strip import WORST_CASE
from study.statistics.verdicts import YES, all_of

_TRIANGLES = 12
_WIDTH = 640.0
_MARGIN = 12.0


def worst_case(evidence: Evidence) -> Subsection:
    """Draw the strip, and hold larger ones against the formula."""
    return Subsection(
        "worst-case",
        "The worst case",
        (
            common(
                "No bound holds for all meshes: in a strip whose edges grow from one end to the "
                "other, the first triangle's path covers everything, and the mean is (n + 1) / 2."
            ),
            _figure_2(evidence),
        ),
    )


def _figure_2(evidence: Evidence) -> Drawing:
    strip = lepp.worst_case_strip(_TRIANGLES)
    sizes = lepp.lepp_sizes(strip)
    x, y = strip.points.T
    scale = (_WIDTH - 2 * _MARGIN) / np.ptp(x)
    corners = np.column_stack([(x - x.min()) * scale, (y.max() - y) * scale]) + _MARGIN
    triangles = [
        {
            "points": " ".join(f"{a:.2f},{b:.2f}" for a, b in corners[triangle]),
            "size": int(size),
            "x": f"{corners[triangle, 0].mean():.2f}",
            "y": f"{corners[triangle, 1].mean():.2f}",
            "shade": int((size - 1) * 2 // (_TRIANGLES - 1)),
        }
        for triangle, size in zip(strip.triangles, sizes, strict=True)
    ]
    rows = evidence.rows(WORST_CASE)
    largest = rows.last
    equal = bool(all_of(rows["equal"]) == YES)
    return Drawing(
        id="figure-worst-case",
        template="strip.html.j2",
        context={
            "triangles": triangles,
            "width": f"{_WIDTH:g}",
            "height": f"{np.ptp(y) * scale + 2 * _MARGIN:.2f}",
        },
        title="The worst case",
        paper="Figure 2",
        alternatives={
            ALWAYS: (
                f"A strip of {_TRIANGLES} triangles; the number in each is its LEPP size, from "
                f"{sizes.max()} at the narrow end to {sizes.min()}. Strips of up to "
                f"{largest['n_triangles']:,} triangles, measured by the same kernels as the study, "
                + (
                    "all have the mean (n + 1) / 2 and the maximum n exactly."
                    if equal
                    else "do not all have the mean (n + 1) / 2: see the table."
                )
            )
        },
        reading="Every edge across the strip is longer than the one to its left.",
        data=(TableBlock(WORST_CASE, "strips of growing length", follows=()),),
    )
