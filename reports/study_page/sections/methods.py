"""The methods of triangulation compared on the same points."""

from collections.abc import Callable

from lepp import METHODS
from lepp.theory import LEAST_P, LEAST_P_TEXT
from reports.page import style
from reports.page.blocks import FigureBlock, Prose, Section, Subsection, TableBlock
from reports.page.evidence import Evidence
from reports.page.style import Spec
from reports.page.views import View, distribution_word
from reports.study_page.sections.continuation import LONG
from reports.study_page.tables import TABLE_4, statements_compared_by
from reports.text.words import LEVEL, every
from study.analysis.group_summaries import GROUPS
from study.analysis.method_comparison import GROWTH, MEAN_LEPP, METHODS_COMPARED, SHARE_P
from study.analysis.path_lengths import LAW, TERMINATION
from study.analysis.table import DISTRIBUTION, Declaration, Rows
from study.analysis.theorems import THEOREM_2
from study.paper.published import REFERENCE_METHOD
from study.text.numbers import listed, show


def section(evidence: Evidence) -> Section:
    """Means, rates, sizes, growth, statements; every figure has all methods."""
    return Section(
        "methods",
        "The triangulations compared",
        "Does the triangulation matter?",
        (
            _compared(evidence),
            Subsection("paths-compared", "The paths", (_rates(evidence), _sizes(evidence))),
            Subsection(
                "statements-compared",
                "What of the paper holds for which",
                (
                    TableBlock(
                        statements_compared_by(evidence.design.methods),
                        "The paper's statements by triangulation",
                    ),
                ),
            ),
        ),
    )


def _compared(evidence: Evidence) -> Subsection:
    others = ("method_2",) if len(evidence.design.methods) > 2 else ()
    return Subsection(
        "same-points",
        "On the same points",
        (
            Prose(_by_distribution(evidence, _same_points)),
            _growth(evidence),
            TableBlock(
                METHODS_COMPARED,
                "Paired differences at the largest number of points",
                columns=(
                    "quantity",
                    *others,
                    "pairs",
                    "mean_1",
                    "mean_2",
                    "difference",
                    "low",
                    "high",
                    "log10_p",
                ),
                where={"n_points": evidence.design.largest_of_all},
            ),
            TableBlock(GROWTH, "Growth with each doubling of the points", folded=True),
        ),
    )


def _by_distribution(evidence: Evidence, make: Callable[[Evidence, str], object]) -> dict:
    """One variant a distribution, the same under every method."""
    made = {}
    for view in evidence.views:
        value = make(evidence, view.distribution)
        if value is not None:
            made[view.key] = value
    return made


def _views(evidence: Evidence, distribution: str) -> list[View]:
    return [View(method, distribution) for method in evidence.design.methods]


def _same_points(evidence: Evidence, distribution: str) -> list[str] | None:
    rows = evidence.rows(METHODS_COMPARED, distribution=distribution)
    if rows.empty:
        return None
    largest = rows.select(n_points=rows["n_points"].max())
    means = _by_method(largest.select(quantity=MEAN_LEPP), "mean")
    shares = _by_method(largest.select(quantity=SHARE_P), "mean")
    sentences = [
        f"{_each_method(evidence)} On the same {largest.first['n_points']:,} "
        f"{distribution_word(distribution)} points the mean LEPP sizes are "
        f"{listed(_beside(means, 'fixed4'))}, and the shares p of type C neighbours "
        f"{listed(_beside(shares, 'fixed4'))}. {premise(shares)}"
    ]
    return sentences


def _each_method(evidence: Evidence) -> str:
    """Say what each method does, the paper's first."""
    of_paper = [name for name in evidence.design.methods if name == REFERENCE_METHOD]
    others = [METHODS[name] for name in evidence.design.methods if name != REFERENCE_METHOD]
    words = [
        f"the {METHODS[name].word} method, the paper's, {METHODS[name].description}"
        for name in of_paper
    ]
    words += [f"the {method.word} method {method.description}" for method in others]
    text = "; ".join(words)
    return f"{text[0].upper()}{text[1:]}."


def _by_method(rows: Rows, quantity: str) -> dict[str, float]:
    """Give the value of the reference, and of each method that is compared with it."""
    values = {rows.first["method_1"]: float(rows.first[f"{quantity}_1"])}
    for name, value in zip(rows["method_2"], rows[f"{quantity}_2"], strict=True):
        values[name] = float(value)
    return values


def _beside(values: dict[str, float], shown_as: str) -> list[str]:
    return [f"{show(value, shown_as)} ({METHODS[name].word})" for name, value in values.items()]


def premise(shares: dict[str, float]) -> str:
    """Say which methods keep the premise of Theorem 2, from their shares p by name."""
    below = [METHODS[name].word for name, p in shares.items() if p < LEAST_P]
    if not below:
        return f"{every(len(shares))} are above the {LEAST_P_TEXT} that Theorem 2 supposes."
    verb = "That of the" if len(below) == 1 else "Those of the"
    return (
        f"{verb} {listed(below)} triangulations {'is' if len(below) == 1 else 'are'} below the "
        f"{LEAST_P_TEXT} that Theorem 2 supposes."
    )


def _growth(evidence: Evidence) -> FigureBlock:
    def draw(evidence: Evidence, distribution: str) -> Spec | None:
        if any(evidence.rows(GROUPS, view).empty for view in _views(evidence, distribution)):
            return None
        means = _lines(evidence, distribution, GROUPS, "mean_lepp", "Mean LEPP size")
        shares = _lines(
            evidence,
            distribution,
            THEOREM_2,
            "p_type_c",
            "Share p of type C",
            levels=(style.Level(LEAST_P, f"p = {LEAST_P_TEXT}"),),
        )
        return style.panels([means, shares], height=580)

    def say(evidence: Evidence, distribution: str) -> str | None:
        words = []
        for view in _views(evidence, distribution):
            groups = evidence.rows(TABLE_4, view)
            if groups.empty:
                return None
            first, last = groups.first, groups.last
            words.append(
                f"{view.method_word} means go from {show(first['mean_lepp'], 'fixed4')} at "
                f"{first['n_points']:,} to {show(last['mean_lepp'], 'fixed4')} at "
                f"{last['n_points']:,}"
            )
        return f"From few points to many, {listed(words)}."

    return FigureBlock(
        id="figure-methods",
        title="Mean LEPP size and p by triangulation",
        specs=_by_distribution(evidence, draw),
        alternatives=_by_distribution(evidence, say),
        reading=f"{every(len(evidence.design.methods))} methods triangulate the same points.",
        data=(
            TableBlock(
                METHODS_COMPARED,
                "paired differences at every number of points",
                follows=(DISTRIBUTION.name,),
            ),
        ),
    )


def _lines(
    evidence: Evidence,
    distribution: str,
    table: Declaration,
    column: str,
    title: str,
    levels: tuple[style.Level, ...] = (),
) -> style.Panel:
    traces = []
    for series, view in enumerate(_views(evidence, distribution)):
        rows = evidence.rows(table, view)
        traces.append(
            style.scatter(
                x=rows.column("n_points"),
                y=rows.column(column),
                mode="lines+markers",
                name=view.method_title,
                legendgroup=view.method,
                showlegend=table == GROUPS,
                line=style.line(series),
                marker=style.marker(series),
                hovertemplate="%{x:,} points: %{y:.4f}<extra>" + view.method_title + "</extra>",
            )
        )
    return style.Panel(
        traces, style.number_of_points(evidence.design.sizes), style.axis(title), levels=levels
    )


def _rates(evidence: Evidence) -> FigureBlock:
    def draw(evidence: Evidence, distribution: str) -> Spec | None:
        traces = []
        largest = 1
        for series, view in enumerate(_views(evidence, distribution)):
            rows = evidence.rows(TERMINATION, view)
            if rows.empty:
                return None
            steps = rows.frame[(rows["lepp_size"] >= 2) & rows["low"].notna()]
            largest = max([largest, *steps["lepp_size"]])
            traces.append(
                style.scatter(
                    x=steps["lepp_size"],
                    y=steps["rate"],
                    mode="lines+markers",
                    name=view.method_title,
                    line=style.line(series),
                    marker=style.marker(series),
                    error_y=style.interval(
                        steps["rate"], steps["low"], steps["high"], style.SERIES[series]
                    ),
                    hovertemplate="size %{x}: %{y:.4f}<extra>" + view.method_title + "</extra>",
                )
            )
        return style.plot(
            *traces,
            xaxis=style.whole("LEPP size reached", largest),
            yaxis=style.axis("Share of paths that end there", range=[0, 1.02]),
        )

    def say(evidence: Evidence, distribution: str) -> str | None:
        words = []
        for view in _views(evidence, distribution):
            rows = evidence.rows(TERMINATION, view)
            steps = rows.frame[rows["lepp_size"].isin([2, 5])]
            if len(steps) < 2:
                return None
            words.append(
                f"{show(steps['rate'].iloc[0], 'percent1')} of the {view.method_word} paths that "
                f"reach size 2 end there, and {show(steps['rate'].iloc[1], 'percent1')} of those "
                "that reach size 5"
            )
        return f"{'; '.join(words)}."

    return FigureBlock(
        id="figure-rates",
        title="Termination rates by triangulation",
        specs=_by_distribution(evidence, draw),
        alternatives=_by_distribution(evidence, say),
        reading=f"All numbers of points are taken together. Bars are {LEVEL} intervals. Theorem 1 "
        "takes each line to be level.",
        data=(
            TableBlock(
                TERMINATION,
                "termination rates of all triangulations",
                follows=(DISTRIBUTION.name,),
            ),
        ),
    )


def _sizes(evidence: Evidence) -> FigureBlock:
    def draw(evidence: Evidence, distribution: str) -> Spec | None:
        traces = []
        largest = 1
        for series, view in enumerate(_views(evidence, distribution)):
            rows = evidence.rows(LAW, view)
            if rows.empty:
                return None
            largest = max([largest, *rows["lepp_size"]])
            traces.append(
                style.scatter(
                    x=rows.column("lepp_size"),
                    y=rows["share"].where(rows["share"] > 0),
                    mode="lines+markers",
                    name=view.method_title,
                    line=style.line(series),
                    marker=style.marker(series),
                    hovertemplate="size %{x}: %{y}<extra>" + view.method_title + "</extra>",
                )
            )
        return style.plot(
            *traces,
            xaxis=style.whole("LEPP size", largest),
            yaxis=style.powers("Share of triangles"),
        )

    def say(evidence: Evidence, distribution: str) -> str | None:
        words = []
        for view in _views(evidence, distribution):
            rows = evidence.rows(LAW, view)
            if rows.empty:
                return None
            long = rows["share"][rows["lepp_size"] >= LONG].sum()
            words.append(
                f"{show(long, 'percent2')} of the {view.method_word} triangles have a LEPP of "
                f"{LONG} or more, and the longest is {rows['lepp_size'].max()}"
            )
        return f"{'; '.join(words)}."

    return FigureBlock(
        id="figure-sizes",
        title="LEPP sizes by triangulation",
        specs=_by_distribution(evidence, draw),
        alternatives=_by_distribution(evidence, say),
        reading="All numbers of points are taken together. The vertical scale is logarithmic.",
        data=(TableBlock(LAW, "LEPP sizes of all triangulations", follows=(DISTRIBUTION.name,)),),
    )
