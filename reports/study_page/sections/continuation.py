"""The chance that a path goes on, its laws, and the sizes against the geometric law."""

import pandas as pd

from reports.page import style
from reports.page.blocks import FigureBlock, Subsection, TableBlock, per_view
from reports.page.evidence import Evidence
from reports.page.style import Spec
from reports.page.views import View
from reports.text.words import LEVEL
from study.analysis.parts import INTERIOR, WHOLE
from study.analysis.path_lengths import (
    ALL_STEPS,
    CONSTANT,
    CONTINUATION,
    FALLING,
    FIRST_STEP,
    LAW,
    PATH_LAWS,
    TERMINATION,
)
from study.statistics.groups import ENOUGH
from study.statistics.thresholds import ROUGH_RATE
from study.statistics.verdicts import REJECTED
from study.text.numbers import f_test, large, listed, p_is, show

#: The size from which on paths are called long.
LONG = 8

#: Width of an interval from which on a chance is not drawn.
DRAWN = 0.5

#: The parts of a mesh in words.
_WHERE = {INTERIOR: "in the interior", WHOLE: "in the whole mesh"}


def going_on(evidence: Evidence) -> Subsection:
    """Draw the chance to go on, list its laws, and draw the geometric one."""
    return Subsection(
        "steps",
        "How often does a path go on?",
        (
            _continuation(evidence),
            TableBlock(PATH_LAWS, "Laws of the chance to go on"),
            _law(evidence),
        ),
    )


def one_chance(evidence: Evidence, view: View) -> str:
    """Say whether one chance fits all steps, which is Theorem 1's premise."""
    part = _part(evidence, view)
    test = evidence.one(PATH_LAWS, view, part=part, law=CONSTANT)
    if test is None:
        return "The run is too small to test whether one chance fits all steps."
    numbers = f"({_test(test)}, {_WHERE[part]})"
    if test["verdict"] == REJECTED:
        return f"No single chance fits the steps {numbers}, whichever it is."
    return f"That one chance fits all steps is not rejected {numbers}."


def one_chance_in_short(evidence: Evidence, view: View) -> str:
    """Say whether one chance fits all steps in a clause that follows Theorem 1's premise."""
    test = evidence.one(PATH_LAWS, view, part=_part(evidence, view), law=CONSTANT)
    if test is None:
        return "which this run is too small to test"
    return f"which is {test['verdict']} ({p_is(test['log10_p'])})"


def _test(law: pd.Series) -> str:
    return f"{f_test(law['f'], law['df'], law['df_residual'])}, {p_is(law['log10_p'])}"


def _part(evidence: Evidence, view: View) -> str:
    """Return the part of the mesh whose law is told: the interior, if there is one."""
    inside = evidence.rows(PATH_LAWS, view, part=INTERIOR)
    return WHOLE if inside.empty else INTERIOR


def _continuation(evidence: Evidence) -> FigureBlock:
    def draw(view: View) -> Spec | None:
        part = _part(evidence, view)
        rows = _measured(evidence, view, part)
        if rows.empty:
            return None
        traces = [_measured_rates(rows, f"measured, {_WHERE[part]}", style.marker(0))]
        if part == INTERIOR:
            whole = _measured(evidence, view, WHOLE)
            behind = style.marker(2, 11, symbol="square-open")
            traces.insert(0, _measured_rates(whole, f"measured, {_WHERE[WHOLE]}", behind))
        if rows["fitted"].notna().any():
            traces.append(
                style.scatter(
                    x=rows["lepp_size"],
                    y=rows["fitted"],
                    mode="lines",
                    name=f"law {FALLING}",
                    line=style.line(1),
                    hovertemplate="%{x} triangles: %{y:.4f}<extra>law</extra>",
                )
            )
        first = float(rows["constant"].iloc[0])
        return style.plot(
            *traces,
            xaxis=style.axis("Triangles k that the path has", dtick=2),
            yaxis=style.axis("Share of the paths that go on", range=[0, 1.02]),
            levels=[style.Level(first, f"Theorem 1: {show(first, 'fixed4')}")],
        )

    def say(view: View) -> str | None:
        part = _part(evidence, view)
        rows = evidence.rows(CONTINUATION, view, part=part).frame
        if rows.empty:
            return None
        return " ".join(
            sentence
            for sentence in (
                f"At {_largest(evidence, view, rows)}, {_WHERE[part]}, the chance to go on "
                f"{_trend(rows, _one_fits(evidence, view, part))}.",
                _rise_at_the_edge(evidence, view) if part == INTERIOR else "",
                _fitted(evidence, view, part),
                _longest(evidence, view, part),
            )
            if sentence
        )

    return FigureBlock(
        id="figure-continuation",
        title="Chance to go on after k triangles",
        specs=per_view(evidence.views, draw),
        alternatives=per_view(evidence.views, say),
        reading="Of the paths that have k triangles or more, the share that have more, with "
        f"{LEVEL} intervals, at the largest number of points with {ENOUGH} triangulations or more: "
        "of fewer the covariance of the chances is not known. Theorem 1 takes it to be constant. "
        "Long paths come in bundles that "
        "share most of their triangles: the longest one seen scatters more widely around what a "
        "law expects than independent paths would.",
        data=(
            TableBlock(CONTINUATION, "chances to go on"),
            TableBlock(TERMINATION, "the same from the other side, at all sizes together"),
        ),
    )


def _measured(evidence: Evidence, view: View, part: str) -> pd.DataFrame:
    """Return the chances to go on that are known well enough to be drawn."""
    rows = evidence.rows(CONTINUATION, view, part=part).frame
    return rows[rows["high"] - rows["low"] < DRAWN]


def _measured_rates(rows: pd.DataFrame, name: str, marker: Spec) -> Spec:
    return style.scatter(
        x=rows["lepp_size"],
        y=rows["rate"],
        mode="markers",
        name=name,
        marker=marker,
        error_y=style.interval(rows["rate"], rows["low"], rows["high"], marker["color"]),
        hovertemplate="%{x} triangles: %{y:.4f}<extra>" + name + "</extra>",
    )


def _one_fits(evidence: Evidence, view: View, part: str) -> bool:
    """Whether one chance for all steps has been tested and is not rejected."""
    test = evidence.one(PATH_LAWS, view, part=part, law=CONSTANT)
    return test is not None and test["verdict"] != REJECTED


def sure(rows: pd.DataFrame) -> pd.DataFrame:
    """Return the chances up to the first that is not known to within `ROUGH_RATE`."""
    return rows[(rows["high"] - rows["low"] < ROUGH_RATE).cummin()]


def _largest(evidence: Evidence, view: View, rows: pd.DataFrame) -> str:
    """Say how many points the chances are of, and why no more."""
    n_points = rows["n_points"].iloc[0]
    if n_points == evidence.design.sizes_of(view.method)[-1]:
        return f"{n_points:,} points"
    return f"{n_points:,} points (the largest number with {ENOUGH} triangulations or more)"


def _rise_at_the_edge(evidence: Evidence, view: View) -> str:
    """Say that in the whole mesh the chance rises again, where the interior's does not."""
    whole = sure(evidence.rows(CONTINUATION, view, part=WHOLE).frame)
    inside = sure(evidence.rows(CONTINUATION, view, part=INTERIOR).frame)
    if whole.empty or inside.empty:
        return ""
    least = whole.loc[whole["rate"].idxmin()]
    after = whole[whole["lepp_size"] > least["lepp_size"]]
    if after.empty:
        return ""
    most = after.loc[after["rate"].idxmax()]
    end = inside.iloc[-1]
    if not (most["low"] > least["high"] and most["low"] > end["high"]):
        return ""
    return (
        f"In the whole mesh it falls to {show(least['rate'], 'percent1')} after "
        f"{least['lepp_size']} triangles and rises again, to {show(most['rate'], 'percent1')} "
        "after "
        f"{most['lepp_size']}: the longest paths are those along the edge."
    )


def _trend(rows: pd.DataFrame, level: bool) -> str:
    """Say how the chances change, of those that are known well, or of all if none is."""
    known = sure(rows)
    well = len(known) > 1
    if not well:
        known = rows
    rates, last = known["rate"], known.iloc[-1]
    upto = (
        f"up to size {last['lepp_size']}, as far as it is known to within {ROUGH_RATE:g}"
        if well
        else f"up to size {last['lepp_size']}, where it is not known to within {ROUGH_RATE:g}"
    )
    ends = f"from {show(rates.iloc[0], 'percent1')} to {show(rates.iloc[-1], 'percent1')}"
    if rates.is_monotonic_decreasing and not level:
        return f"falls with every step, {ends}, {upto}"
    if rates.is_monotonic_increasing and not level:
        return f"rises with every step, {ends}, {upto}"
    before = rates.shift()
    rises, falls = (known["low"] > before).any(), (known["high"] < before).any()
    if rises != falls and not level:
        return f"{'rises' if rises else 'falls'} {ends}, {upto}"
    least, most = show(rates.min(), "percent1"), show(rates.max(), "percent1")
    return f"moves between {least} and {most}, {upto}"


def _fitted(evidence: Evidence, view: View, part: str) -> str:
    if _one_fits(evidence, view, part):
        constant = evidence.rows(PATH_LAWS, view, part=part, law=CONSTANT).first
        return f"One chance for all steps is not rejected ({_test(constant)})."
    falling = evidence.one(PATH_LAWS, view, part=part, law=FALLING)
    if falling is None:
        return ""
    coefficients = [
        f"{sign}\u00a0=\u00a0{show(falling[name], 'fixed3')}\u00a0±\u00a0"
        f"{show(falling[f'{name}_error'], 'fixed3')}"
        for sign, name in (("λ", "scale"), ("b", "shift"), ("a", "exponent"))
    ]
    return (
        f"The law {FALLING} with {listed(coefficients)}, fitted up to size "
        f"{falling['upto_size']}{_why_no_further(evidence, view, part, falling)}, is "
        f"{falling['verdict']} ({_test(falling)})."
    )


def _why_no_further(evidence: Evidence, view: View, part: str, law: pd.Series) -> str:
    """Say why a law is not fitted to all chances that are known well."""
    known = sure(evidence.rows(CONTINUATION, view, part=part).frame)
    if not (known["lepp_size"] > law["upto_size"]).any():
        return ""
    return " (no more sizes than a third of the covariance's degrees of freedom)"


def _longest(evidence: Evidence, view: View, part: str) -> str:
    laws = evidence.rows(PATH_LAWS, view, part=part).frame.set_index("law")
    if laws.empty:
        return ""
    expected = [
        f"{laws.loc[law, 'longest_expected']} by {words}"
        for law, words in (
            (FALLING, f"this law{_although(laws)}"),
            (FIRST_STEP, "Theorem 1 with the chance at the first step"),
            (ALL_STEPS, "Theorem 1 with that of all steps"),
        )
        if law in laws.index and not pd.isna(laws.loc[law, "longest_expected"])
    ]
    first = laws.iloc[0]
    told = (
        f"The longest of {large(first['paths'])} such paths at {first['n_points']:,} points has "
        f"{first['longest_seen']} triangles"
    )
    return f"{told}; expected are {listed(expected)}." if expected else f"{told}."


def _although(laws: pd.DataFrame) -> str:
    rejected = FALLING in laws.index and laws.loc[FALLING, "verdict"] == REJECTED
    return " (which is rejected)" if rejected else ""


def _law(evidence: Evidence) -> FigureBlock:
    def draw(view: View) -> Spec | None:
        rows = evidence.rows(LAW, view)
        if rows.empty:
            return None
        return style.plot(
            style.bars(
                x=rows.column("lepp_size"),
                y=rows.column("share"),
                name="measured",
                marker={"color": style.SERIES[0]},
                hovertemplate="size %{x}: %{y}<extra>measured</extra>",
            ),
            style.scatter(
                x=rows.column("lepp_size"),
                y=rows["geometric_share"].where(rows["geometric_share"] > 0),
                mode="lines+markers",
                name="geometric law of the measured p",
                line=style.line(1),
                marker=style.marker(1),
                hovertemplate="size %{x}: %{y}<extra>geometric law</extra>",
            ),
            xaxis=style.whole("LEPP size", int(rows["lepp_size"].max())),
            yaxis=style.powers("Share of triangles"),
            bargap=0.3,
        )

    def say(view: View) -> str | None:
        law = evidence.rows(LAW, view)
        rows = law.frame[law["geometric_share"] > 0]
        if rows.empty:
            return None
        common = rows.loc[rows["share"].idxmax()]
        long = rows[rows["lepp_size"] >= LONG]
        sentence = (
            f"The commonest size is {common['lepp_size']} ({show(common['share'], 'percent1')} of "
            f"the triangles; the law has {show(common['geometric_share'], 'percent1')})."
        )
        if len(long):
            # The law's own tail: (1 - p)^(k - 2) of the paths are of size k and more.
            p = float(evidence.rows(TERMINATION, view).first["p_type_c"])
            measured, expected = float(long["share"].sum()), float((1 - p) ** (LONG - 2))
            sentence += (
                f" Sizes of {LONG} and more are {show(expected / measured, 'g2')} times rarer than "
                "in the law."
                if measured < expected
                else f" Sizes of {LONG} and more are {show(measured / expected, 'g2')} times as "
                "common as in the law."
            )
        return sentence

    return FigureBlock(
        id="figure-law",
        title="LEPP sizes against the geometric law",
        specs=per_view(evidence.views, draw),
        alternatives=per_view(evidence.views, say),
        reading="All numbers of points are taken together. The vertical scale is logarithmic: a "
        "geometric law is a straight line.",
        data=(TableBlock(LAW, "LEPP sizes and the law"),),
    )
