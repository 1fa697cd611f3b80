"""The methods of triangulation compared on the same points."""

from collections.abc import Callable

from reports.page import style
from reports.page.blocks import FigureBlock, Prose, Section, Subsection, TableBlock
from reports.page.evidence import Evidence
from reports.page.style import Spec
from reports.page.views import View, distribution_word, method_word
from reports.text.numbers import listed, show, significant


def section(evidence: Evidence) -> Section:
    """Means, rates, sizes, growth, statements; every figure has all methods."""
    every = _by_distribution
    return Section(
        "methods",
        "The triangulations compared",
        "Does the triangulation matter?",
        (
            Subsection(
                "same-points",
                "On the same points",
                (
                    Prose(every(evidence, _same_points)),
                    _growth(evidence),
                    TableBlock(
                        "methods",
                        "Paired differences at the largest number of points",
                        columns=(
                            "quantity",
                            "pairs",
                            "mean_1",
                            "mean_2",
                            "difference",
                            "low",
                            "high",
                            "log10_p",
                        ),
                        follows=("distribution",),
                        where={"n_points": max(evidence.design.sizes)},
                    ),
                    TableBlock(
                        "growth",
                        "Growth with each doubling of the points",
                        folded=True,
                        follows=("distribution",),
                    ),
                ),
            ),
            Subsection("paths-compared", "The paths", (_rates(evidence), _sizes(evidence))),
            Subsection(
                "statements-compared",
                "What of the paper holds for which",
                (
                    TableBlock(
                        "statements_compared",
                        "The paper's statements by triangulation",
                        follows=("distribution",),
                    ),
                ),
            ),
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
    rows = evidence.rows("methods", distribution=distribution)
    if rows.empty:
        return None
    last = rows[rows["n_points"] == rows["n_points"].max()].set_index("quantity")
    mean, p = last.loc["mean LEPP"], last.loc["share p of type C"]
    words = [
        f"{show(mean[f'mean_{k}'], 'fixed4')} ({method_word(mean[f'method_{k}'])})" for k in (1, 2)
    ]
    shares = [f"{show(p[f'mean_{k}'], 'fixed4')} ({method_word(p[f'method_{k}'])})" for k in (1, 2)]
    below = [method_word(p[f"method_{k}"]) for k in (1, 2) if p[f"mean_{k}"] < 1 / 3]
    premise = (
        f" That of the {listed(below)} triangulations is below the 1/3 that Theorem 2 supposes."
        if below
        else " Both are above the 1/3 that Theorem 2 supposes."
    )
    said = [
        f"The paper inserts the points as they come and never flips an edge (incremental); most "
        "programs make Delaunay triangulations, whose triangles are as far from thin as the points "
        "allow. "
        f"On the same {mean['n_points']:,} {distribution_word(distribution)} points the "
        f"mean LEPP sizes are {listed(words)}, and the shares p of type C neighbours "
        f"{listed(shares)}."
        f"{premise}"
    ]
    growth = evidence.one("growth", distribution=distribution)
    if growth is not None:
        slopes = [
            f"{significant(growth[f'slope_{k}'], 2)} ({method_word(growth[f'method_{k}'])})"
            for k in (1, 2)
        ]
        same = growth["low"] <= 0 <= growth["high"]
        said.append(
            f"With each doubling of the points the mean changes by {listed(slopes)}; the growth "
            + ("is not shown to differ." if same else "differs.")
        )
    return said


def _growth(evidence: Evidence) -> FigureBlock:
    def draw(evidence: Evidence, distribution: str) -> Spec | None:
        if any(evidence.rows("groups", view).empty for view in _views(evidence, distribution)):
            return None
        means = _lines(evidence, distribution, "groups", "mean_lepp", "Mean LEPP size")
        shares = _lines(
            evidence,
            distribution,
            "theorem_2",
            "p_type_c",
            "Share p of type C",
            levels=(style.Level(1 / 3, "p = 1/3"),),
        )
        return style.panels([means, shares], height=580)

    def say(evidence: Evidence, distribution: str) -> str | None:
        words = []
        for view in _views(evidence, distribution):
            groups = evidence.rows("table_4", view)
            if groups.empty:
                return None
            first, last = groups.iloc[0], groups.iloc[-1]
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
        reading="Both methods triangulate the same points.",
        data=(
            TableBlock(
                "methods",
                "Data: paired differences at every number of points",
                follows=("distribution",),
            ),
        ),
    )


def _lines(
    evidence: Evidence,
    distribution: str,
    table: str,
    column: str,
    title: str,
    levels: tuple[style.Level, ...] = (),
) -> style.Panel:
    traces = []
    for series, view in enumerate(_views(evidence, distribution)):
        rows = evidence.rows(table, view)
        traces.append(
            style.scatter(
                x=rows["n_points"],
                y=rows[column],
                mode="lines+markers",
                name=view.method_name,
                legendgroup=view.method,
                showlegend=table == "groups",
                line=style.line(series),
                marker=style.marker(series),
                hovertemplate="%{x:,} points: %{y:.4f}<extra>" + view.method_name + "</extra>",
            )
        )
    return style.Panel(traces, style.axis("Number of points"), style.axis(title), levels=levels)


def _rates(evidence: Evidence) -> FigureBlock:
    def draw(evidence: Evidence, distribution: str) -> Spec | None:
        traces = []
        for series, view in enumerate(_views(evidence, distribution)):
            rows = evidence.rows("termination", view)
            if rows.empty:
                return None
            rows = rows[(rows["lepp_size"] >= 2) & rows["low"].notna()]
            traces.append(
                style.scatter(
                    x=rows["lepp_size"],
                    y=rows["rate"],
                    mode="lines+markers",
                    name=view.method_name,
                    line=style.line(series),
                    marker=style.marker(series),
                    hovertemplate="size %{x}: %{y:.4f}<extra>" + view.method_name + "</extra>",
                )
            )
        return style.plot(
            *traces,
            xaxis=style.axis("LEPP size reached", dtick=1),
            yaxis=style.axis("Share of paths that end there", range=[0, 1.02]),
        )

    def say(evidence: Evidence, distribution: str) -> str | None:
        words = []
        for view in _views(evidence, distribution):
            rows = evidence.rows("termination", view)
            steps = rows[rows["lepp_size"].isin([2, 5])] if not rows.empty else rows
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
        reading="Theorem 1 takes each line to be level.",
        data=(
            TableBlock(
                "termination",
                "Data: termination rates of all triangulations",
                follows=("distribution",),
            ),
        ),
    )


def _sizes(evidence: Evidence) -> FigureBlock:
    def draw(evidence: Evidence, distribution: str) -> Spec | None:
        traces = []
        for series, view in enumerate(_views(evidence, distribution)):
            rows = evidence.rows("law", view)
            if rows.empty:
                return None
            traces.append(
                style.scatter(
                    x=rows["lepp_size"],
                    y=rows["share"].where(rows["share"] > 0),
                    mode="lines+markers",
                    name=view.method_name,
                    line=style.line(series),
                    marker=style.marker(series),
                    hovertemplate="size %{x}: %{y:.3%}<extra>" + view.method_name + "</extra>",
                )
            )
        return style.plot(
            *traces,
            xaxis=style.axis("LEPP size", dtick=1),
            yaxis=style.powers("Share of triangles"),
        )

    def say(evidence: Evidence, distribution: str) -> str | None:
        words = []
        for view in _views(evidence, distribution):
            rows = evidence.rows("law", view)
            if rows.empty:
                return None
            long = rows.loc[rows["lepp_size"] >= 8, "share"].sum()
            words.append(
                f"{show(long, 'percent2')} of the {view.method_word} triangles have a LEPP of 8 or "
                f"more, and the longest is {rows['lepp_size'].max()}"
            )
        return f"{'; '.join(words)}."

    return FigureBlock(
        id="figure-sizes",
        title="LEPP sizes by triangulation",
        specs=_by_distribution(evidence, draw),
        alternatives=_by_distribution(evidence, say),
        reading="The vertical scale is logarithmic.",
        data=(
            TableBlock("law", "Data: LEPP sizes of all triangulations", follows=("distribution",)),
        ),
    )
