"""The data: what the points look like, and what every triangulation measured (Figures 3 to 5)."""

from reports.page import style
from reports.page.blocks import ALWAYS, FigureBlock, Section, Subsection, TableBlock, per_view
from reports.page.evidence import Evidence
from reports.page.style import Spec
from reports.page.views import View, distribution_name
from reports.study_page.tables import SAMPLED_POINTS, TRIANGULATIONS
from study.analysis.group_summaries import GROUPS
from study.text.numbers import count, listed, show


def section(evidence: Evidence) -> Section:
    """Points, means of single triangulations, and the group table."""
    return Section(
        "data",
        "The data",
        "What was measured?",
        (
            Subsection("points", "The points", (_figure_3(evidence),)),
            Subsection(
                "means",
                "The mean of every triangulation",
                (_figure_4(evidence), _figure_5(evidence)),
            ),
        ),
    )


def _figure_3(evidence: Evidence) -> FigureBlock:
    names = evidence.design.distributions
    parts = []
    for k, name in enumerate(names):
        points = evidence.rows(SAMPLED_POINTS, distribution=name)
        dots = style.scatter(
            x=points.column("x"),
            y=points.column("y"),
            mode="markers",
            name="points",
            marker=style.marker(0, 4, opacity=0.65),
            hovertemplate="%{x:.3f}, %{y:.3f}<extra></extra>",
        )
        number = "" if k == 0 else str(k + 1)
        square = {"scaleanchor": f"x{number}", "scaleratio": 1}
        parts.append(
            style.Panel(
                [dots],
                style.axis("", constrain="domain"),
                style.axis("", constrain="domain", constraintoward="top", **square),
                distribution_name(name),
            )
        )
    many = len(names) > 1
    figure = style.panels(parts, columns=2 if many else 1, height=700 if many else 420, ratio=1.2)
    rows = evidence.rows(SAMPLED_POINTS)
    each = len(rows) // len(names)
    words = listed([_shape(name, evidence.design.correlation) for name in names])
    return FigureBlock(
        id="figure-points",
        title="The points",
        paper="Figure 3",
        specs={ALWAYS: figure},
        alternatives={ALWAYS: f"{count(each, 'point')} of each distribution: {words}."},
        reading="The first points of the first point set of each distribution, as drawn.",
        data=(TableBlock(SAMPLED_POINTS, "the points drawn"),),
    )


def _shape(name: str, correlation: float) -> str:
    return {
        "uniform": "the uniform ones fill the unit square",
        "normal": "the normal ones are a round cloud about the origin",
        "bivariate_normal": (
            f"the bivariate normal ones are a cloud stretched by a correlation of {correlation:g} "
            "(assumed, as the paper names none)"
        ),
        "exponential": "the exponential ones crowd into the corner at the origin",
    }[name]


def _figure_4(evidence: Evidence) -> FigureBlock:
    def draw(view: View) -> Spec | None:
        rows = evidence.rows(TRIANGULATIONS, view)
        if rows.empty:
            return None
        groups = evidence.rows(GROUPS, view)
        return style.plot(
            style.scatter(
                x=rows.column("n_points"),
                y=rows.column("mean_lepp"),
                mode="markers",
                name="one triangulation",
                marker=style.marker(0, 5, opacity=0.45),
                hovertemplate="%{x:,} points: %{y:.4f}<extra></extra>",
            ),
            style.scatter(
                x=groups.column("n_points"),
                y=groups.column("mean_lepp"),
                mode="lines+markers",
                name="mean of the group",
                line=style.line(1),
                marker=style.marker(1, 7),
                hovertemplate="%{x:,} points, mean %{y:.4f}<extra></extra>",
            ),
            xaxis=style.number_of_points(evidence.design.sizes),
            yaxis=style.axis("Mean LEPP size"),
        )

    return FigureBlock(
        id="figure-triangulations",
        title="Mean LEPP size of every triangulation",
        paper="Figure 4",
        specs=per_view(evidence.views, draw),
        alternatives=per_view(evidence.views, lambda view: _range(evidence, view)),
        reading="A dot is one triangulation; it is drawn at its number of points.",
        data=(TableBlock(TRIANGULATIONS, "every triangulation"),),
    )


def _figure_5(evidence: Evidence) -> FigureBlock:
    def draw(view: View) -> Spec | None:
        rows = evidence.rows(TRIANGULATIONS, view)
        if rows.empty:
            return None
        return style.plot(
            style.box(
                x=rows.column("n_points"),
                y=rows.column("mean_lepp"),
                boxpoints="outliers",
                line={"color": style.SERIES[0], "width": 1.5},
                fillcolor=style.BAND,
                marker={"size": 4, "color": style.SERIES[0]},
                name="mean LEPP sizes",
            ),
            xaxis=style.sizes_axis(rows["n_points"].unique(), "Number of points"),
            yaxis=style.axis("Mean LEPP size"),
        )

    return FigureBlock(
        id="figure-groups",
        title="Mean LEPP size by group",
        paper="Figure 5",
        specs=per_view(evidence.views, draw),
        alternatives=per_view(evidence.views, lambda view: _spread(evidence, view)),
        reading="Boxes span the quartiles, whiskers reach to 1.5 times their distance.",
        data=(
            TableBlock(
                GROUPS,
                "the groups",
                columns=("n_points", "triangulations", "lowest", "q1", "median", "q3", "highest"),
            ),
        ),
    )


def _range(evidence: Evidence, view: View) -> str | None:
    means = evidence.rows(TRIANGULATIONS, view)
    if means.empty:
        return None
    lowest = means.frame.loc[means["mean_lepp"].idxmin()]
    highest = means.frame.loc[means["mean_lepp"].idxmax()]
    return (
        f"The means of {count(len(means), 'triangulation')} lie between "
        f"{show(lowest['mean_lepp'], 'fixed4')}, at {lowest['n_points']:,} points, and "
        f"{show(highest['mean_lepp'], 'fixed4')}, at {highest['n_points']:,}."
    )


def _spread(evidence: Evidence, view: View) -> str | None:
    groups = evidence.rows(GROUPS, view).frame
    groups = groups[groups["sd_between"].notna()]
    if len(groups) < 2:
        return None
    first, last = groups.iloc[0], groups.iloc[-1]
    ratio = first["sd_between"] / last["sd_between"]
    change = "shrinks" if ratio > 1 else "grows"
    return (
        f"The spread between triangulations {change} from {show(first['sd_between'], 'fixed4')} "
        f"at {first['n_points']:,} points to {show(last['sd_between'], 'fixed4')} at "
        f"{last['n_points']:,}."
    )
