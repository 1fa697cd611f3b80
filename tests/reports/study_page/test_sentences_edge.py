"""What the report says of the edge and the interior, on runs made one way and the other."""

import re
from dataclasses import replace

import pandas as pd
import pytest
from frames import adding
from grown_runs import grown
from made_runs import page

from lepp import INTERIOR_LAYER
from reports.page.views import View
from reports.study_page.sections import layers, longest_paths
from study.analysis.part_changes import LAST_LAYERS, PART_CHANGES
from study.analysis.part_means import COMMON_MEANS, LAYER_MEANS, LONGEST_PATHS, PART_MEANS

VIEW_OF = View("incremental", "uniform")
VIEW = {"method": "incremental", "distribution": "uniform"}


@pytest.mark.parametrize(
    ("curves", "interior_grows"), [(("saturating", "level"), 0), (("level", "saturating"), 1)]
)
def test_the_trend_of_both_parts(curves, interior_grows):
    text = grown(*curves)
    frame = text.evidence.rows(PART_MEANS, **VIEW).frame.set_index("part")
    ends = {part: frame.loc[part, "mean_lepp"].iloc[[0, -1]].tolist() for part in set(frame.index)}
    changes = {part: f"{last - first:.4f}" for part, (first, last) in ends.items()}
    changes = {part: change.replace("-", "−") for part, change in changes.items()}
    said = text.prose("parts")
    assert f"{INTERIOR_LAYER} or more steps across edges away from a triangle at the hull" in said
    assert (
        "From 10,000 to 2,000,000 points the mean of the whole mesh changes by "
        f"{changes['whole']}, from {ends['whole'][0]:.4f} to {ends['whole'][1]:.4f}, and that of "
        f"the interior by {changes['interior']}, from {ends['interior'][0]:.4f} to "
        f"{ends['interior'][1]:.4f}."
    ) in said
    grows = {part: last - first > 0.02 for part, (first, last) in ends.items()}
    assert grows == {"whole": not interior_grows, "interior": bool(interior_grows)}


@pytest.mark.parametrize(
    ("curves", "spread", "words"),
    [
        (("saturating", "level"), 0.3, "most of the growth of the whole mesh is the edge's"),
        (("thickening", "level"), 0.3, "most of the fall of the whole mesh is the edge's"),
        (("logarithmic", "logarithmic"), 0.3, "most of the growth of the whole mesh is the "
            "interior's own"),
        (("falling", "falling"), 0.3, "most of the fall of the whole mesh is the interior's own"),
        (("logarithmic", "halfway"), 0.3, "how much of the growth of the whole mesh is the edge's "
            "stays open"),
        (("level", "saturating"), 0.3, ""),
    ],
)  # fmt: skip
def test_whose_the_trend_is(curves, spread, words):
    text = grown(*curves, spread=spread)
    opening, said = text.prose("key-figures"), text.prose("parts")
    row = text.evidence.rows(PART_CHANGES, **VIEW, part="interior").first
    ends = [f"{row[name]:.4f}".replace("-", "−") for name in ("change", "low", "high")]
    sentence = (
        "In the interior, 30 steps or more from the hull, it changes by {} (95 % from {} to {}) "
        "from 10,000 points to 2,000,000: "
    ).format(*ends)
    assert (f"{sentence}{words}." in opening) == bool(words)
    assert ("In the interior, 30" in opening) == bool(words)
    assert (f"{words[:1].upper()}{words[1:]}." in said) == bool(words) or not words
    assert ("of the whole mesh is the" in said) == bool(words)


@pytest.mark.parametrize(
    ("verdict", "words"),
    [
        ("rejected", "3.0652 together, 0.0416 below that of the interior (difference 95 % from "
            "−0.0500 to −0.0300; p = 0.0010): of uniform points the edge, or what the "
            "density of the points has to do with it, reaches further, and some of it is in what "
            "is called the interior here."),
        ("not rejected", "3.0652 together, which is not shown to differ from that of the interior "
            "(by −0.0416, 95 % from −0.0500 to −0.0300): no reach of the edge beyond them is "
            "seen."),
    ],
)  # fmt: skip
def test_whether_the_edge_reaches_into_the_interior(verdict, words):
    evidence = grown("saturating", "level").evidence
    table = LAST_LAYERS.table(
        [
            VIEW
            | {"n_points": 2_000_000, "triangulations": 12, "last_layers": 3.0652}
            | {"interior": 3.1068, "difference": -0.0416, "low": -0.05, "high": -0.03}
            | {"p": 0.001, "log10_p": -3.0, "same_mean": verdict}
        ]
    )
    changed = replace(evidence, tables=adding(evidence.tables, table))
    *_, said = layers._layers(changed, VIEW_OF)
    assert said.replace("\u00a0", " ") == (
        f"Layers 24 to 29, the last before the interior, have a mean of {words}"
    )
    assert len(layers._layers(changed, View("incremental", "exponential"))) == 1


@pytest.mark.parametrize(
    ("paths", "inside", "layer", "of_layer", "words"),
    [
        (1, 1, 30, 1, "starts in the interior"),
        (1, 0, 7, 1, "starts in layer 7"),
        (4, 4, 30, 4, "all start in the interior"),
        (4, 0, 7, 4, "all start in layer 7"),
        (4, 1, 7, 3, "most start in layer 7"),
        (4, 3, 30, 3, "most start in the interior"),
        (4, 1, 7, 1, "1 of them starts in the interior"),
        (4, 2, 7, 2, "2 of them start in the interior"),
        (3, 0, 15, 1, "none of them starts in the interior"),
    ],
)
def test_where_the_longest_paths_start(paths, inside, layer, of_layer, words):
    evidence = grown("saturating", "level").evidence
    table = evidence.tables["longest_paths"]
    frame = table.frame.assign(
        paths=paths, interior_paths=inside, layer=layer, layer_paths=of_layer
    )
    changed = replace(evidence, tables=adding(evidence.tables, replace(table, frame=frame)))
    (said,) = longest_paths._longest(changed, VIEW_OF)
    assert said.endswith(f" the largest size of all, 20, and {words}.")


@pytest.mark.parametrize(
    ("apart", "words"), [(-0.0003, "may have one mean (p = "), (0.02, "do not have one mean (p = ")]
)
def test_whether_distributions_have_one_interior_mean(apart, words):
    text = grown("saturating", "level", apart=apart)
    said = text.prose("parts")
    assert f"At 2,000,000 points the interiors of the 2 distributions {words}" in said
    row = text.evidence.rows(COMMON_MEANS, method="incremental", part="interior").last
    lowest, highest = row["lowest"], row["highest"]
    assert f"the {lowest} points have the lowest and the {highest} ones the highest, " in said
    assert f"{row['largest_difference']:.4f} apart" in said
    if apart > 0:
        assert (lowest, highest) == ("uniform", "exponential")
    else:
        assert f"{row['mean_lepp']:.4f} (95 % from {row['low']:.4f} to {row['high']:.4f})" in said


@pytest.mark.parametrize("edge", [(5, 20, 30), (12, 25, 3)])
def test_the_layers_of_the_highest_mean_and_of_the_longest_paths(edge):
    text = grown("saturating", "level", edge=edge)
    layer, size, paths = edge
    rows = text.evidence.rows(LAYER_MEANS, **VIEW, n_points=2_000_000).frame.set_index("layer")
    mean = (paths * size + 4 * 2005.5) / (paths + 2005.5)
    assert rows.loc[layer, "mean_lepp"] == pytest.approx(mean)
    said = text.prose("layers")
    assert "The mean of the interior is 3.47" in said
    tested = rows["against_interior"].dropna()
    assert tested[tested == "above"].index.tolist() == [layer]
    assert "below" not in set(tested)  # a layer that never varies has no error to test by
    assert (
        "by tests of all layers, with Holm's correction, that of the edge is above it in layer "
        f"{layer}, most in layer {layer}, at {mean:.2f}"
    ) in said
    longest = text.prose("longest")
    assert (
        f"At this number of points {12 * paths} paths have the largest size of all, {size}, and "
        f"all start in layer {layer}."
    ) in longest
    of_long = (
        f"Of the {12 * paths:,} paths of {size} triangles and more at 2,000,000 points, "
        f"{12 * paths:,} start at the edge; by its share of the triangles, "
    )
    assert (of_long in longest) == (12 * paths >= 100)


def test_longest_paths_of_the_interior():
    # nothing at the edge is longer than in the interior
    text = grown("saturating", "level", edge=(5, 2, 30))
    assert "and most start in the interior." in text.prose("longest")
    row = text.evidence.rows(LONGEST_PATHS, **VIEW, lepp_size=4).first
    seen = row["paths"] - row["interior_paths"]
    expected = f"{row['paths'] * row['edge_triangles']:,.1f}"
    assert (
        f"of 4 triangles and more at 2,000,000 points, {seen:,} start at the edge; by its share of "
        f"the triangles, {100 * row['edge_triangles']:.2f} %, {expected} would."
    ) in text.prose("longest")
    said = text.finding("figure-longest")
    assert f": {seen:,} and {expected} of {row['paths']:,} for uniform points (of 4 " in said


@pytest.mark.parametrize(
    ("at_edge", "words"), [(0, "none starts"), (1, "1 starts"), (2, "2 start"), (159, "159 start")]
)
def test_long_paths_that_start_at_the_edge(at_edge, words):
    evidence = grown("saturating", "level", edge=(5, 2, 30)).evidence
    table = evidence.tables["longest_paths"]
    frame = table.frame.assign(
        paths=159, interior_paths=159 - at_edge, edge_triangles=0.0072, edge_share=at_edge / 159
    )
    changed = replace(evidence, tables=adding(evidence.tables, replace(table, frame=frame)))
    (said,) = longest_paths._longest(changed, VIEW_OF)
    assert f"points, {words} at the edge; by its share of the triangles, 0.72 %, 1.1 would." in (
        said.replace("\u00a0", " ")
    )
    found = longest_paths._figure_longest(changed).alternatives[VIEW_OF.key]
    assert f": {at_edge} and 1.1 of 159 for uniform points" in found


def test_lines_of_long_paths_end_where_few_are_left():
    evidence = grown("saturating", "level").evidence
    table = evidence.tables["longest_paths"]
    last = table.frame["lepp_size"] == table.frame["lepp_size"].max()
    for paths, left in ((100, 0), (99, 1)):
        frame = table.frame.assign(paths=table.frame["paths"].where(~last, paths))
        changed = replace(evidence, tables=adding(evidence.tables, replace(table, frame=frame)))
        drawn = longest_paths._figure_longest(changed).specs[VIEW_OF.key]["data"][0]
        rows = evidence.rows(LONGEST_PATHS, **VIEW).frame
        assert len(drawn["x"]) == len(rows) - left


def test_figures_have_all_distributions():
    text = grown("saturating", "level")
    said = text.finding("figure-parts")
    assert said.startswith(
        "At 2,000,000 points, in the whole mesh the means of 2 distributions lie between "
    )
    assert " and in the interior the means of 2 distributions lie between " in said
    assert "begins at layer 30: uniform points, 5 (4.24); exponential points, 5 (4" in text.finding(
        "figure-layers"
    )
    said = text.finding("figure-longest")
    assert " for uniform points (of 20 triangles and more); " in said
    seen, of = re.search(r": (\S+) and \S+ of (\S+) for uniform", said).groups()
    assert seen == of
    for figure in ("figure-parts", "figure-layers", "figure-longest"):
        (block,) = (
            block
            for part in ("parts", "layers", "longest")
            for block in text.blocks(part)
            if getattr(block, "id", "") == figure
        )
        names = {trace["name"] for trace in block.specs["incremental/uniform"]["data"]}
        assert names == {"Uniform", "Exponential"}


@pytest.mark.parametrize(
    ("words", "sentence", "figure"),
    [
        (["below", "below", "above"], "is below it in layer 0 and above it in layer 2, most"
            " in layer 2, at ", "uniform points, 2 ("),
        (["below", "not shown", "below"], "is below it in layers 0 and 2.",
            "No layer is shown to lie above the interior, which begins at layer 30, for any"),
        (["not shown"] * 3, "is not shown to differ from it in any layer.",
            "No layer is shown to lie above the interior, which begins at layer 30, for any"),
    ],
)  # fmt: skip
def test_layers_are_named_by_what_tests_of_them_show(words, sentence, figure):
    evidence = grown("saturating", "level", edge=(2, 20, 30)).evidence
    table = evidence.tables["layer_means"]
    frame = table.frame.copy()
    for layer in range(INTERIOR_LAYER):
        told = words[layer] if layer < len(words) else "not shown"
        frame.loc[frame["layer"] == layer, "against_interior"] = told
    changed = replace(evidence, tables=adding(evidence.tables, replace(table, frame=frame)))
    (said,) = layers._layers(changed, VIEW_OF)
    assert sentence in said
    assert figure in layers._figure_layers(changed).alternatives[VIEW_OF.key]


def test_layers_in_a_row_are_named_by_their_ends():
    named = layers._layers_named(pd.DataFrame({"layer": [0, 1, 2, 5, 7, 8]}))
    assert named == "layers 0 to 2, 5 and 7 to 8"


def test_small_meshes_still_have_their_edge():
    assert "the edge has" in page("growing").prose("parts")
