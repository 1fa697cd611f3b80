"""What was found: the key figures, what a path is (Figure 1), and the paper's statements."""

import pandas as pd

from reports.page.blocks import (
    Drawing,
    Prose,
    Section,
    Subsection,
    TableBlock,
    Tile,
    Tiles,
    per_view,
)
from reports.page.evidence import Evidence
from reports.page.views import View
from reports.study_page.explorer import N_POINTS
from reports.study_page.sections.regressions import best
from reports.text.numbers import count, large, listed, show


def section(evidence: Evidence) -> Section:
    """Tiles, sentences, the explorer, the statements."""
    return Section(
        "found",
        "What was found",
        "In short",
        (
            Subsection(
                "key-figures",
                "",
                (
                    Tiles(per_view(evidence.views, lambda view: _tiles(evidence, view))),
                    Prose(per_view(evidence.views, lambda view: _sentences(evidence, view))),
                ),
            ),
            Subsection("path", "What a path is", (_figure_1(evidence),)),
            Subsection(
                "statements",
                "What the paper states, and whether it holds",
                (
                    Prose(per_view(evidence.views, lambda view: _statements(evidence, view))),
                    TableBlock(
                        "statements",
                        "The paper's statements, tested on this run",
                        columns=("source", "statement", "holds", "evidence"),
                    ),
                ),
            ),
        ),
    )


def _largest_group(evidence: Evidence, view: View) -> pd.Series | None:
    groups = evidence.rows("table_4", view)
    return None if groups.empty else groups.iloc[-1]


def _tiles(evidence: Evidence, view: View) -> list[Tile] | None:
    overview = evidence.one("overview", view)
    group = _largest_group(evidence, view)
    if overview is None or group is None:
        return None
    (interval,) = evidence.rows("groups", view, n_points=group["n_points"]).to_dict("records")
    tiles = [
        Tile(
            show(group["mean_lepp"], "fixed4"),
            f"Mean LEPP at {group['n_points']:,} points",
            f"95\u00a0% interval {show(interval['mean_low'], 'fixed4')} to "
            f"{show(interval['mean_high'], 'fixed4')}",
        ),
        Tile(
            str(overview["max_lepp"]),
            "Longest path",
            f"among {large(overview['triangles'])} triangles",
        ),
    ]
    theorem = evidence.one("theorem_2", view, n_points=group["n_points"])
    if theorem is not None:
        tiles.append(
            Tile(
                show(theorem["p_type_c"], "fixed4"),
                "Chance p that a path ends",
                "Theorem 2 supposes at least 1/3",
            )
        )
    moment = evidence.one("theorem_1", view, n_points=group["n_points"], statistic="mean")
    if moment is not None:
        tiles.append(
            Tile(
                show(moment["predicted"], "fixed4"),
                "Mean LEPP by Theorem 1",
                f"measured is {_off(moment['relative_difference'])}",
            )
        )
    verdicts = evidence.rows("reproduction_summary", method=view.method)
    compared = verdicts[["agrees", "close", "differs"]].sum() if len(verdicts) else None
    # Of other triangulations the paper prints nothing.
    if view.method == "incremental" and compared is not None and compared.sum():
        tiles.append(
            Tile(
                f"{compared['agrees'] + compared['close']} of {compared.sum()}",
                "Published numbers met",
                "within 3 standard errors",
            )
        )
    regions = evidence.rows("regions", view)
    if not regions.empty:
        tiles.append(
            Tile(
                show(regions.iloc[-1]["pair_share"], "percent1"),
                "In a terminal pair",
                "triangles where a refinement stays local",
            )
        )
    return tiles


def _off(relative: float) -> str:
    side = "below" if relative < 0 else "above"
    return f"{show(abs(relative), 'percent1')} {side}"


def _sentences(evidence: Evidence, view: View) -> list[str] | None:
    parts = (_spread(evidence, view), _growth(evidence, view), _theory(evidence, view))
    said = [part for part in parts if part]
    return said or None


def _spread(evidence: Evidence, view: View) -> str | None:
    overview = evidence.one("overview", view)
    group = _largest_group(evidence, view)
    if overview is None or group is None:
        return None
    return (
        f"A refinement that starts at a random triangle of {group['n_points']:,} "
        f"{view.distribution_word} points, triangulated by the {view.method_word} method, runs "
        f"through {show(group['mean_lepp'], 'fixed2')} triangles on average. In "
        f"{count(overview['triangulations'], 'triangulation')} with {large(overview['triangles'])} "
        f"triangles, no path was longer than {overview['max_lepp']}."
    )


def _growth(evidence: Evidence, view: View) -> str | None:
    test = evidence.one("anova", view, test="Welch")
    groups = evidence.rows("table_4", view)
    if test is None or len(groups) < 2:
        return None
    first, last = groups.iloc[0], groups.iloc[-1]
    if test["p"] >= 0.05:
        return (
            "The mean does not depend on the number of points, as far as this run can tell "
            f"(Welch's analysis of variance, p\u00a0=\u00a0{show(test['log10_p'], 'log10p')})."
        )
    direction = "grows" if last["mean_lepp"] > first["mean_lepp"] else "falls"
    said = (
        f"The mean {direction} with the number of points, from "
        f"{show(first['mean_lepp'], 'fixed4')} at {first['n_points']:,} to "
        f"{show(last['mean_lepp'], 'fixed4')} at {last['n_points']:,} "
        f"(Welch's analysis of variance, p\u00a0=\u00a0{show(test['log10_p'], 'log10p')})"
    )
    chosen = best(evidence, view)
    return said + (
        f"; the {chosen['model']} model describes it best by AIC." if chosen is not None else "."
    )


def _theory(evidence: Evidence, view: View) -> str | None:
    rows = evidence.rows("theorem_1", view)
    bounds = evidence.rows("theorem_2", view)
    if rows.empty or bounds.empty:
        return None
    last = rows[rows["n_points"] == rows["n_points"].max()].set_index("statistic")
    mean, sd = (last.loc[name] for name in ("mean", "standard deviation"))
    kept = (bounds["bounds"] == "yes").all()
    premise = bounds["premise"].iloc[-1]
    p = f"p is {show(mean['p_type_c'], 'fixed4')}"
    supposed = {
        "yes": "and so does what it supposes, p\u00a0≥\u00a01/3",
        "no": f"although what it supposes, p\u00a0≥\u00a01/3, does not: {p}",
    }.get(premise, "while it stays open whether p\u00a0≥\u00a01/3, which it supposes")
    outcome = (
        "Theorem 2's bounds hold in every triangulation" if kept else "Theorem 2's bounds fail"
    )
    if not kept:
        supposed = p
    if max(abs(mean["relative_difference"]), abs(sd["relative_difference"])) < 0.01:
        first = "Theorem 1 gives the mean and the standard deviation within one per cent."
    else:
        first = (
            f"Theorem 1 gives {show(mean['predicted'], 'fixed2')} for the mean, and the measured "
            f"one is {_off(mean['relative_difference'])}; for the standard deviation it gives "
            f"{show(sd['predicted'], 'fixed2')}, and the measured one is "
            f"{_off(sd['relative_difference'])}."
        )
    return f"{outcome}, {supposed}. {first}"


def _figure_1(evidence: Evidence) -> Drawing:
    def say(view: View) -> str:
        triangles = evidence.rows("explorer_triangles", view)
        sizes = triangles["lepp_size"]
        edges = triangles[["terminal_a", "terminal_b"]].drop_duplicates()
        return (
            f"{len(triangles)} triangles of {N_POINTS} {view.distribution_word} points by the "
            f"{view.method_word} method. Their paths are {show(sizes.mean(), 'fixed2')} triangles "
            f"long on average and {sizes.max()} at most, and end at "
            f"{count(len(edges), 'terminal edge')}."
        )

    return Drawing(
        id="figure-1",
        template="explorer.html.j2",
        context={},
        title="Figure 1. The longest-edge propagation path of any triangle",
        alternatives=per_view(evidence.views, say),
        reading="From a triangle, the path crosses its longest edge into the neighbour, then the "
        "neighbour's longest edge, and so on, until an edge is the longest of both triangles "
        "beside it, or lies on the boundary: the terminal edge. To refine the first triangle well, "
        "all of its path has to be refined.",
        data=(
            TableBlock("explorer_triangles", "Data of Figure 1: the triangles and their paths"),
            TableBlock("explorer_points", "Data of Figure 1: the points"),
        ),
    )


def _statements(evidence: Evidence, view: View) -> list[str] | None:
    rows = evidence.rows("statements", view)
    if rows.empty:
        return None
    holds = rows["holds"].value_counts()
    counted = [
        f"{holds[key]} {word}"
        for key, word in (
            ("yes", "hold"),
            ("no", "do not"),
            ("undecided", "undecided"),
            ("not tested", "not tested"),
        )
        if key in holds
    ]
    return [
        f"Of {len(rows)} statements of the paper, for {view.distribution_word} points and the "
        f"{view.method_word} method: {listed(counted)}."
    ]
