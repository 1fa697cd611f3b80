"""Lines of a figure, one a distribution."""

from collections.abc import Callable

import pandas as pd

from reports.page import style
from reports.page.evidence import Evidence
from reports.page.style import Spec
from reports.page.views import distribution_name
from study.analysis.table import Rows


def lines_by_distribution(
    evidence: Evidence,
    rows_of: Callable[[str], Rows | pd.DataFrame],
    x: str,
    y: str,
    hover: str,
    in_legend: bool | None = None,
) -> list[Spec]:
    """Draw a line for each distribution that has rows, with intervals where there are some.

    Whether they are in the legend is said where several panels share one.
    """
    shared = in_legend is not None
    lines = []
    for series, distribution in enumerate(evidence.design.distributions):
        rows = rows_of(distribution)
        if rows.empty:
            continue
        name = distribution_name(distribution)
        line = style.scatter(
            x=rows.column(x) if isinstance(rows, Rows) else rows[x],
            y=rows.column(y) if isinstance(rows, Rows) else rows[y],
            mode="lines+markers",
            name=name,
            line=style.line(series),
            marker=style.marker(series),
            hovertemplate=f"{hover}<extra>{name}</extra>",
            **({"legendgroup": distribution, "showlegend": in_legend} if shared else {}),
        )
        if isinstance(rows, Rows) and "low" in rows.frame:
            line["error_y"] = style.interval(
                rows[y], rows["low"], rows["high"], style.line(series)["color"], thin=True
            )
        lines.append(line)
    return lines
