"""The house style of the page's plots, as Plotly specifications.

They are plain dictionaries: plotly's own figure objects say the same, but take thirty times as
long to build. The tests hold every one of them against plotly's schema.

Colours are names of the style sheet's variables; the page's script puts the light or the dark
theme's colours in their place. Series differ by colour and by dash or symbol, never by colour
alone.
"""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from study.text.numbers import percent, show, ten_to, thousands

if TYPE_CHECKING:
    from pandas import Series

Spec = dict[str, Any]

INK = "var(--ink)"
MUTED = "var(--muted)"
SURFACE = "var(--surface)"
BAND = "var(--band)"
SERIES = tuple(f"var(--series-{k})" for k in range(1, 6))
#: From the least of a scale about 0, over 0, to the most: what rises and what falls differ by
#: colour, and what is near 0 is pale.
SCALE = [
    [k / 8, color]
    for k, color in enumerate(
        [f"var(--fall-{k})" for k in range(4, 0, -1)] + [f"var(--scale-{k})" for k in range(5)]
    )
]
DASHES = ("solid", "dash", "dot", "dashdot", "longdash")
SYMBOLS = ("circle", "diamond", "square", "triangle-up", "x")
#: Legend above the plot; Plotly's own place beside it takes a third of a narrow screen.
_LEGEND = {"orientation": "h", "x": 0, "xanchor": "left", "y": 1.02, "yanchor": "bottom"}
_CLEAR = "rgba(0,0,0,0)"
#: Distance of two rows of panels in CSS pixels: tick labels, and the next row's titles.
_GAP, _GAP_TITLED = 44, 84
#: As many decimals for all tick labels of an axis as the step between them needs.
_TICK_FORMATS = [
    *(
        {"dtickrange": [0.9 * 10.0**-k, 0.9 * 10.0 ** (1 - k)], "value": f".{k}f"}
        for k in range(6, 0, -1)
    ),
    {"dtickrange": [0.9, 900], "value": ",.0f"},
    {"dtickrange": [900, None], "value": "~s"},
]
_POWERS = range(-20, 21)
#: Factor beyond which a linear axis squeezes the smaller sizes together.
_WIDE = 50
#: Width of a bar on a logarithmic axis, as a share of its number of points.
_BAR = 0.3
#: What a logarithmic axis of numbers of points may have a label at, within each power of ten.
_STEPS = ((1, 2, 5), (1, 3), (1,))
#: Steps between the labels of an axis of shares.
_SHARE_STEPS = [step * 10.0**power for power in range(-5, 0) for step in (1, 2, 5)]
#: As many labels fit along an axis on a telephone.
_MOST_LABELS = 7


@dataclass(frozen=True)
class Level:
    """A dotted line across a plot at a value, with its name at the right end."""

    y: float
    name: str = ""
    above: bool = True


@dataclass(frozen=True)
class Panel:
    """One pair of axes of a figure, and what is drawn in it."""

    traces: Sequence[Spec]
    xaxis: Spec
    yaxis: Spec
    title: str = ""
    levels: Sequence[Level] = field(default=())
    height: float = 1.0


def scatter(**attributes: Any) -> Spec:  # noqa: ANN401 - Plotly's attributes are of any type
    """Trace of points and lines."""
    return {"type": "scatter", **attributes}


def bars(**attributes: Any) -> Spec:  # noqa: ANN401 - as above
    """Trace of bars."""
    return {"type": "bar", **attributes}


def box(**attributes: Any) -> Spec:  # noqa: ANN401 - as above
    """Trace of box plots."""
    return {"type": "box", **attributes}


def heatmap(**attributes: Any) -> Spec:  # noqa: ANN401 - as above
    """Trace of a grid of colours."""
    return {"type": "heatmap", **attributes}


def axis(title: str, **more: Any) -> Spec:  # noqa: ANN401 - as above
    """Axis in the house style."""
    return {
        "automargin": True,
        "gridcolor": "var(--grid)",
        "linecolor": MUTED,
        "tickcolor": MUTED,
        "ticks": "outside",
        "ticklen": 4,
        "zeroline": False,
        "showline": True,
        "tickangle": 0,
        "tickformatstops": _TICK_FORMATS,
        "title": {"text": title, "standoff": 10, "font": {"size": 13}},
        **more,
    }


def powers(title: str, **more: Any) -> Spec:  # noqa: ANN401 - as above
    """Logarithmic axis, a tick a power of ten."""
    return axis(
        title,
        type="log",
        exponentformat="power",  # of what the pointer shows
        tickvals=[10.0**power for power in _POWERS],
        ticktext=[ten_to(power) if power else "1" for power in _POWERS],
        tickformatstops=[],
        **more,
    )


def number_of_points(
    sizes: Iterable[int],
    columns: int = 1,
    *,
    fixed: bool = False,
    **more: Any,  # noqa: ANN401 - as above
) -> Spec:
    """Axis of numbers of points: logarithmic where they span more than a factor of 50.

    `columns` is the number of panels side by side; a `fixed` axis ends with the sizes, whatever is
    drawn beyond.
    """
    title, seen = "Number of points", list(sizes)
    if not seen:
        return axis(title, **more)
    low, high = min(seen), max(seen)
    wide = _is_wide(seen)
    if fixed:
        ends = (math.log10(low), math.log10(high)) if wide else (low, high)
        margin = 0.03 * (ends[1] - ends[0] or ends[1])
        more["range"] = [ends[0] - margin, ends[1] + margin]
    if not wide:
        return axis(title, **more)
    ticks = _ticks(low, high, _MOST_LABELS // columns)
    labels = [thousands(tick) for tick in ticks]
    return axis(title, type="log", tickvals=ticks, ticktext=labels, tickformatstops=[], **more)


def bar_widths(drawn: Iterable[int], sizes: Iterable[int]) -> list[float] | None:
    """Widths of bars that look alike on the `number_of_points` axis of all sizes.

    None where that is linear: Plotly's own are.
    """
    seen = list(sizes)
    return [_BAR * size for size in drawn] if seen and _is_wide(seen) else None


def _is_wide(sizes: list[int]) -> bool:
    return max(sizes) > _WIDE * min(sizes)


def _ticks(low: int, high: int, most: int) -> list[int]:
    """Round numbers about `low` to `high`, of which `most` at most lie between."""
    powers_of_ten = range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1)
    each = ([step * 10**power for power in powers_of_ten for step in steps] for steps in _STEPS)
    few = (ticks for ticks in each if sum(low <= tick <= high for tick in ticks) <= most)
    return next(few, [10**power for power in powers_of_ten])


def shares(title: str, largest: float) -> Spec:
    """Axis of shares from 0 to a little above the largest, as percentages."""
    largest = max(largest, _SHARE_STEPS[0])
    step = next((step for step in _SHARE_STEPS if 6 * step >= largest), _SHARE_STEPS[-1])
    ticks = [k * step for k in range(7)]
    decimals = max(0, -math.floor(math.log10(100 * step)))
    return axis(
        title,
        range=[-0.03 * largest, 1.08 * largest],
        tickvals=ticks,
        ticktext=[percent(tick, decimals) for tick in ticks],
    )


def percents(title: str, **more: Any) -> Spec:  # noqa: ANN401 - as above
    """Axis of shares, a tick every ten percent."""
    shares = [k / 10 for k in range(11)]
    return axis(title, tickvals=shares, ticktext=[percent(share, 0) for share in shares], **more)


def whole(title: str, largest: int) -> Spec:
    """Axis of whole numbers up to `largest`, with labels that fit side by side on a telephone."""
    return axis(title, dtick=-(-largest // 10))


def sizes_axis(sizes: Iterable[int], title: str) -> Spec:
    """Axis with equal steps from one size to the next, whatever their distance."""
    ordered = [int(size) for size in sizes]
    shown = range(0, len(ordered), -(-len(ordered) // 6))  # six labels fit on a telephone
    return axis(
        title,
        type="category",
        categoryorder="array",
        categoryarray=ordered,
        tickvals=list(shown),
        ticktext=[thousands(ordered[k]) for k in shown],
    )


def interval(
    middle: "Series", low: "Series", high: "Series", color: str = MUTED, *, thin: bool = False
) -> Spec:
    """Bars from `low` to `high` through points at `middle`, for ``error_y``; thin ones for many."""
    return {
        "type": "data",
        "symmetric": False,
        "array": _rough(high - middle),
        "arrayminus": _rough(middle - low),
        "thickness": 1 if thin else 1.5,
        "width": 0 if thin else 3,
        "color": color,
    }


def _rough(lengths: "Series") -> list[float]:
    """Lengths to draw, with four digits: more are not seen, and would make the page larger."""
    return [float(f"{length:.4g}") for length in lengths]


def color_bar(title: str, most: float) -> Spec:
    """Scale of a heat map, above it: beside it, it takes a quarter of a narrow screen.

    It reaches from −`most` to `most`, and has these labels and 0.
    """
    ends = (-most, 0.0, most)
    return {
        "title": {"text": title, "side": "top", "font": {"size": 13}},
        "orientation": "h",
        "thickness": 10,
        "outlinewidth": 0,
        "x": 0,
        "xanchor": "left",
        "len": 0.85,
        "y": 1.02,
        "yanchor": "bottom",
        "tickfont": {"size": 12},
        "tickvals": list(ends),
        "ticktext": [show(end, "fixed4") for end in ends],
    }


def plot(
    *traces: Spec,
    xaxis: Spec,
    yaxis: Spec,
    levels: Sequence[Level] = (),
    **layout: Any,  # noqa: ANN401 - as above
) -> Spec:
    """Make a figure of one panel; `layout` has further settings of Plotly's layout."""
    return panels([Panel(traces, xaxis, yaxis, levels=levels)], **layout)


def panels(
    parts: Sequence[Panel],
    columns: int = 1,
    height: int = 380,
    ratio: float | None = None,
    **layout: Any,  # noqa: ANN401 - as above
) -> Spec:
    """Make a figure of panels, row by row.

    Parameters
    ----------
    parts : sequence of Panel
    columns : int
    height : int
        Of the whole figure in CSS pixels; the width is the page's.
    ratio : float, optional
        Most that the height may be as a multiple of the width, where panels keep their shape.
    **layout
        Further settings of Plotly's layout.
    """
    names = {trace.get("name") for part in parts for trace in part.traces}
    titled = any(part.title for part in parts)
    legend = len(names) > 1
    spec: Spec = {
        "data": [],
        "layout": {
            "height": height,
            "font": {"color": INK, "size": 13},
            "paper_bgcolor": _CLEAR,
            "plot_bgcolor": _CLEAR,
            "margin": {"l": 12, "r": 20, "t": 16 + 20 * titled + 24 * (legend and titled), "b": 12},
            "hovermode": "closest",
            "hoverlabel": {"bgcolor": SURFACE, "bordercolor": MUTED, "font": {"color": INK}},
            "legend": _LEGEND | {"bgcolor": _CLEAR} | ({"y": 1 + 40 / height} if titled else {}),
            "showlegend": legend,
            "shapes": [],
            "annotations": [],
            **({"meta": {"ratio": ratio}} if ratio else {}),
            **layout,
        },
    }
    gap = (_GAP_TITLED if titled else _GAP) / height
    for k, (part, (x, y)) in enumerate(zip(parts, _domains(parts, columns, gap), strict=True)):
        _place(spec, part, "" if k == 0 else str(k + 1), x, y)
        if k + columns < len(parts):  # the panel below names what both have along x
            axis_name = f"xaxis{'' if k == 0 else k + 1}"
            spec["layout"][axis_name] = spec["layout"][axis_name] | {"title": {"text": ""}}
    return spec


def _place(spec: Spec, part: Panel, number: str, x: list[float], y: list[float]) -> None:
    layout = spec["layout"]
    few = {"nticks": 4} if x[1] - x[0] < 0.9 else {}  # narrow on a telephone
    layout[f"xaxis{number}"] = part.xaxis | few | {"domain": x, "anchor": f"y{number}"}
    layout[f"yaxis{number}"] = part.yaxis | {"domain": y, "anchor": f"x{number}"}
    spec["data"] += [
        trace | ({"xaxis": f"x{number}", "yaxis": f"y{number}"} if number else {})
        for trace in part.traces
    ]
    if part.title:
        layout["annotations"].append(
            _note(part.title, x=sum(x) / 2, y=y[1], yshift=4, yanchor="bottom", xanchor="center")
        )
    across = {"xref": f"x{number} domain", "yref": f"y{number}"}
    for level in part.levels:
        line = {"color": MUTED, "width": 1.5, "dash": "dot"}
        layout["shapes"].append(
            {"type": "line", "x0": 0, "x1": 1, "y0": level.y, "y1": level.y, "line": line, **across}
        )
        if level.name:
            anchor = "bottom" if level.above else "top"
            note = _note(level.name, x=1, y=level.y, yanchor=anchor, xanchor="right")
            note["font"] = {"color": MUTED, "size": 12}
            layout["annotations"].append(note | across)


def _note(text: str, **place: Any) -> Spec:  # noqa: ANN401 - as above
    return {"text": text, "showarrow": False, "xref": "paper", "yref": "paper", **place}


def _domains(
    parts: Sequence[Panel], columns: int, gap_y: float
) -> list[tuple[list[float], list[float]]]:
    """Where each panel lies, as shares of the figure, the first row on top."""
    gap_x = 0.12
    rows = [parts[k : k + columns] for k in range(0, len(parts), columns)]
    width = (1 - gap_x * (columns - 1)) / columns
    share = (1 - gap_y * (len(rows) - 1)) / sum(row[0].height for row in rows)
    domains = []
    top = 1.0
    for row in rows:
        bottom = top - share * row[0].height
        for column in range(len(row)):
            left = column * (width + gap_x)
            # Rounding errors must not lead beyond 0 and 1, which Plotly refuses.
            domains.append(([left, min(left + width, 1.0)], [max(bottom, 0.0), top]))
        top = bottom - gap_y
    return domains


def marker(series: int, size: float = 7, **more: Any) -> Spec:  # noqa: ANN401 - as above
    """Marker of a series."""
    color, symbol = _pair(series, SYMBOLS)
    return {"color": color, "symbol": symbol, "size": size, **more}


def line(series: int, width: float = 2) -> Spec:
    """Line of a series."""
    color, dash = _pair(series, DASHES)
    return {"color": color, "dash": dash, "width": width}


def _pair(series: int, signs: Sequence[str]) -> tuple[str, str]:
    """Color and sign of a series: beyond the last color they begin again, with another sign."""
    around, place = divmod(series, len(SERIES))
    return SERIES[place], signs[(place + around) % len(signs)]


def band(x: object, low: object, high: object, name: str) -> list[Spec]:
    """Two traces that fill the space between two curves."""
    edge = {"mode": "lines", "line": {"width": 0, "color": BAND}, "hoverinfo": "skip", "x": x}
    return [
        scatter(y=low, showlegend=False, name=name, **edge),
        scatter(y=high, fill="tonexty", fillcolor=BAND, name=name, **edge),
    ]
