"""What the report says of methods, agreement and completeness, counted anew; and the opposite."""

import re
from dataclasses import replace
from functools import cache

import numpy as np
import pandas as pd
import pytest
from frames import adding, design, failed
from made_runs import DESIGN, METHODS, page, run
from page_text import PageText, drawn, page_text
from scipy import stats

from reports.page.blocks import TableBlock
from reports.study_page import sections
from reports.study_page.sections import agreement, methods
from study.analysis.building import MISSING
from study.paper import published

ONE = DESIGN.model_copy(update={"methods": ("incremental",)})


def by_method(name, column, n=8000):
    results = run(name)["results"]
    results = results[results["n_points"] == n]
    return [results.loc[results["method"] == m, column].to_numpy(float) for m in METHODS]


@pytest.mark.parametrize("name", ["drawn", "high p"])
def test_methods_on_the_same_points(name):
    means = [v.mean() for v in by_method(name, "mean_lepp")]
    shares = [
        (c / i).mean()
        for c, i in zip(
            by_method(name, "n_type_c"), by_method(name, "n_interior_longest"), strict=True
        )
    ]
    said = page(name).prose("same-points")
    assert (
        f"On the same 8,000 uniform points the mean LEPP sizes are {means[0]:.4f} "
        f"(plain insertion) and {means[1]:.4f} (Delaunay), and the shares p of type "
        f"C neighbours {shares[0]:.4f} (plain insertion) and {shares[1]:.4f} (Delaunay)."
    ) in said
    if name == "drawn":
        assert shares[1] < 1 / 3 < shares[0]
        assert "That of the Delaunay triangulations is below the 1/3" in said
    else:
        assert min(shares) > 1 / 3
        assert "above the 1/3 that Theorem 2 supposes" in said
        assert "below" not in said


def test_premise_of_methods_at_the_limit():
    third = 1 / 3
    assert "above the 1/3" in methods.premise({"incremental": third, "delaunay": 0.4})
    both = methods.premise({"incremental": 0.2, "delaunay": np.nextafter(third, 0)})
    assert both.startswith(
        "Those of the plain insertion and Delaunay triangulations are below the 1/3"
    )


def one_grows(results):
    factor = np.where(results["method"] == "incremental", 0.05, 0.0)
    return results.assign(mean_lepp=3 + factor * np.log2(results["n_points"] / 1000)).assign(
        mean_lepp=lambda f: f["mean_lepp"] + 0.001 * np.cos(np.arange(len(f)))
    )


def test_growth_of_methods():
    said = page_text(drawn(DESIGN, results=one_grows))
    # A logarithmic slope that the means do not follow is not said.
    assert "doubling" not in said.prose("same-points")
    assert said.finding("figure-methods").startswith(
        "From few points to many, plain insertion means go from 3.0"
    )
    ends = [[v.mean() for v in by_method("drawn", "mean_lepp", n)] for n in (1000, 8000)]
    assert page("drawn").finding("figure-methods") == (
        f"From few points to many, plain insertion means go from {ends[0][0]:.4f} at 1,000 to "
        f"{ends[1][0]:.4f} at 8,000 and Delaunay means go from {ends[0][1]:.4f} at 1,000 to "
        f"{ends[1][1]:.4f} at 8,000."
    )


@pytest.mark.parametrize("name", ["drawn", "high p"])
def test_paths_of_methods(name):
    rates, tails = [], []
    for method, word in METHODS.items():
        frame = run(name)["histograms"]
        frame = frame[frame["method"] == method]
        counts = np.bincount(frame["lepp_size"], frame["count"])
        reached = counts[::-1].cumsum()[::-1]
        two, five = (100 * counts[k] / reached[k] for k in (2, 5))
        rates.append(
            f"{two:.1f} % of the {word} paths that reach size 2 end there, and {five:.1f} % of "
            "those that reach size 5"
        )
        tails.append(
            f"{100 * counts[8:].sum() / counts.sum():.2f} % of the {word} triangles have a LEPP of "
            f"8 or more, and the longest is {len(counts) - 1}"
        )
    assert page(name).finding("figure-rates") == f"{'; '.join(rates)}."
    assert page(name).finding("figure-sizes") == f"{'; '.join(tails)}."


@cache
def paper_run(shift=0.0, factor=1.0) -> PageText:
    """Groups with the published means and standard deviations, moved by standard errors."""
    sizes = published.sizes()
    asked = design(distributions=("uniform",), sizes=sizes, repetitions=published.REPETITIONS)
    small = drawn(asked.model_copy(update={"sizes": (1000,)}))
    scores = stats.zscore(stats.norm.ppf((np.arange(40) + 0.5) / 40), ddof=1)
    rows = []
    for triangles, largest, mean, sd in published.table_4():
        middle = mean.value + shift * sd.value / np.sqrt(20)
        group = small["results"].assign(
            n_points=mean.n_points, mean_lepp=middle + factor * sd.value * scores
        )
        group["n_triangles"] = round(triangles.value) + np.repeat([-3, 3], 20)
        group["max_lepp"] = np.repeat([int(largest.value) - 1, int(largest.value) + 1], 20)
        rows.append(group)
    frames = small.frames | {"results": pd.concat(rows, ignore_index=True)}
    return page_text(replace(small, frames=frames, design=asked))


TILE = "Independent published numbers met"


def independent(page_of):
    """Verdicts on the independent numbers."""
    frame = page_of.evidence.tables["reproduction"].frame
    return frame.loc[frame["standing"] == "independent", "verdict"]


def judged_rows(frame):
    """Index of the independent numbers with a verdict by standard errors."""
    judged = frame["verdict"].isin(["agrees", "close", "differs"])
    return frame.index[judged & (frame["standing"] == "independent")]


def test_what_does_not_count_is_said():
    said = paper_run().prose("scoreboard")
    assert (
        "Not counted are the other 65: 23 that follow from the paper's own Table 4, 6 that every "
        "run of this design gives, 4 that stand beside the p-value of the same test, "
    ) in said
    board = paper_run().evidence.tables["reproduction"].frame
    parts = said.partition("the other 65: ")[2].partition(". ")[0]
    counted = [int(number) for number in re.findall(r"\b(\d+) that ", parts)]
    assert sum(counted) == 65 == len(board) - len(independent(paper_run()).loc[judged_rows(board)])
    draws = paper_run().evidence.tables["reproduction"].frame.query("standing == 'random draw'")
    odd = (draws["verdict"] == "implausible draw").sum()
    assert (f", {odd} are not plausible" in said) == (odd > 1)
    assert "12 that belong to groups" not in said  # Table 1 is not run either
    run_none = (paper_run().evidence.tables["reproduction"].frame["verdict"] == "not run").sum()
    assert f"{run_none} that belong to groups which this run does not have." in said


def test_draws_are_held_against_ours():
    kept = paper_run().evidence
    for verdicts, words in [
        (["plausible draw"] * 20, "All 20 draws that can be held against ours are plausible."),
        (
            ["implausible draw"] + ["plausible draw"] * 19,
            "Of 20 draws that can be held against ours, 1 is not plausible.",
        ),
        (
            ["implausible draw"] * 2 + ["not run"] * 18,
            "Of 2 draws that can be held against ours, 2 are not plausible.",
        ),
    ]:
        frame = kept.tables["reproduction"].frame.copy()
        frame.loc[frame["standing"] == "random draw", "verdict"] = verdicts
        assert words in told_with(kept, "scoreboard", reproduction=frame)


def told_with(kept, part, **frames):
    """What a part of the section says once tables have other rows."""
    tables = kept.tables
    for name, frame in frames.items():
        tables = adding(tables, replace(tables[name], frame=frame))
    changed = replace(kept, tables=tables)
    return PageText(changed).prose(part)


@pytest.mark.parametrize(
    ("verdict", "words"),
    [
        ("agrees", "All together they are as far from ours as chance puts them (χ² = 81.2 on 93"),
        ("differs", "All together they are further from ours than chance puts them"),
        ("closer than chance", "All together they are nearer to ours than chance puts them"),
    ],
)
def test_all_independent_numbers_together(verdict, words):
    kept = paper_run().evidence
    frame = kept.tables["reproduction_overall"].frame.copy()
    last = frame["quantity"] == "all independent numbers"
    frame.loc[last, ["chi2", "expected_beyond", "p", "log10_p", "p_less"]] = [
        81.2, 3.96, 0.8, np.log10(0.8), 0.2,
    ]  # fmt: skip
    frame.loc[last, ["df", "beyond"]] = [93, 1]
    frame.loc[last, "verdict"] = verdict
    said = told_with(kept, "scoreboard", reproduction_overall=frame)
    assert words in said
    assert "p = 0.8000 for more, 0.2000 for less)" in said
    assert "By chance 4.0 would be beyond 2; 1 is." in said
    frame.loc[last, "beyond"] = 0
    assert "By chance 4.0 would be beyond 2; none is." in told_with(
        kept, "scoreboard", reproduction_overall=frame
    )
    frame.loc[last, "beyond"] = 9
    assert "beyond 2; 9 are." in told_with(kept, "scoreboard", reproduction_overall=frame)


def test_a_shift_beyond_all_doubles_has_a_p_below_the_least():
    rows = pd.DataFrame({"quantity": ["mean LEPP"], "shift": [-99.0], "shift_p": [0.0]})
    said = agreement._shifts(rows).replace("\u00a0", " ")
    assert "the mean LEPP size −99.00 (p < 10⁻³⁰⁷)" in said


def test_a_common_shift_is_said():
    none = paper_run().prose("scoreboard")
    assert "Over all groups no kind of number is shifted to one side by more than chance" in none
    moved = paper_run(shift=-1.0).prose("scoreboard")
    assert "Over all groups the mean LEPP size is shifted to one side; ours less the" in moved
    # of 20 groups, each one standard error below
    assert "in standard errors: the mean LEPP size −4.4" in moved
    both = paper_run(shift=1.0, factor=1.3).prose("scoreboard")
    assert "the mean LEPP size and its standard deviation are shifted to one side" in both


def test_the_paper_is_held_against_itself():
    said = paper_run().prose("consistency")
    assert said == (
        "24 published numbers of Tables 5, 6 and 7 follow from the means and standard deviations "
        "of the paper's own Table 4; 23 of them lie in the range that the rounding of Table 4 "
        "leaves open. 1 number is a misprint, whatever the data were: 7.535 × 10⁵ (linear, b, as "
        "printed), where Table 4 gives 7.473 × 10⁻⁵ to 7.623 × 10⁻⁵."
    )
    kept = paper_run().evidence
    frame = kept.tables["consistency"].frame

    def told(verdicts):
        table = replace(kept.tables["consistency"], frame=frame.assign(verdict=verdicts))
        return agreement.consistent(replace(kept, tables=adding(kept.tables, table)))

    right = told(["consistent"] * 24)
    assert "; all of them lie in the range" in right
    assert "misprint" not in right
    assert "decided" not in right
    assert "2 numbers do not fit, whatever the data were: 33.34 (F, ANOVA), where" in told(
        ["misprint"] * 2 + ["consistent"] * 22
    )
    assert told(["undecided"] * 3 + ["consistent"] * 21).endswith("3 cannot be decided.")


def test_the_sets_of_table_1_are_named():
    said = paper_run().prose("table-1-sets")
    assert said == (
        "The runs test counts whole numbers of runs, so that sets of a given size can have only "
        "certain p-values. The 8 that Table 1 prints are all possible for sets of 10,000 points "
        "(0.14 would be by chance), and at most 6 of them for any other size: Table 1 tests sets "
        "of that group, and is compared with ours of that size."
    )
    kept = paper_run().evidence
    frame = kept.tables["runs_lattice"].frame

    def told(fits):
        table = replace(kept.tables["runs_lattice"], frame=frame.assign(fits=fits))
        return agreement.tested_sets(replace(kept, tables=adding(kept.tables, table)))

    assert told("no").endswith("are not all possible for any one of the published sizes.")
    two = told(["yes"] * 2 + ["no"] * 18)
    assert "are all possible for sets of 10,000 and 20,000 points" in two
    assert "Table 1 tests sets" not in two


def test_scoreboard_counts_what_agrees():
    right, wrong = paper_run(), paper_run(shift=2.5)
    board = independent(right).value_counts()
    judged = sum(int(board.get(v, 0)) for v in ("agrees", "close", "differs"))
    assert judged == 81  # one distribution was run
    said = right.prose("scoreboard")
    assert said.startswith("The paper prints 146 numbers in its seven tables.")
    assert (
        f"{judged} of them are not derived from another printed number, and can be held against "
        f"ours by their standard errors: {board['agrees']} within 2 (agreement), "
        f"{board.get('close', 0)} within "
        f"3 (close) and {board.get('differs', 0)} beyond (different)."
    ) in said
    means = right.finding("figure-means")
    assert means.startswith("20 of 20 group means lie within 2 standard errors")
    assert "0 of 20 group means lie within 2 standard errors" in wrong.finding("figure-means")
    assert "and 20 within 3" in wrong.finding("figure-means")
    far = paper_run(shift=6.0)
    assert "and 0 within 3; the largest" in far.finding("figure-means")
    verdicts = independent(far).value_counts()
    assert verdicts["differs"] >= 20
    met = verdicts["agrees"] + verdicts.get("close", 0)
    assert far.tiles()[TILE][0] == f"{met} of {met + verdicts['differs']}"
    value, context = right.tiles()[TILE]
    agreeing = int(board["agrees"] + board.get("close", 0))
    assert value == f"{agreeing} of {judged}"
    rows = right.evidence.tables["reproduction"].frame.query("standing == 'independent'")
    z = rows.loc[rows["verdict"].isin(["agrees", "close", "differs"]), "difference"].dropna()
    p = stats.chi2.sf((z**2).sum(), len(z))
    assert context == f"within 3 standard errors; χ² of all has p = {p:.4f}"


def test_table_4_as_a_whole():
    assert (
        paper_run()
        .prose("table-4")
        .startswith(
            "Over all groups together, the mean LEPP size agrees closer than chance (χ² = 0.0 on "
            "20 degrees of freedom"
        )
    )
    moved = paper_run(shift=2.5).prose("table-4")
    z = 2.5  # of the difference, as both have the published standard deviations
    chi2 = float(moved.split("χ² = ")[1].split(" ")[0])
    assert abs(chi2 - 20 * z * z) < 2
    assert "the mean LEPP size differs" in moved
    assert "its standard deviation agrees closer than chance" in moved
    sd = moved.split("its standard deviation ")[1].split(";")[0].replace("\u202f", " ")
    less = stats.chi2.cdf(float(sd.split("χ² = ")[1].split(" ")[0]), 20)
    assert less < 0.01
    assert sd.endswith(" for less")
    assert "for less" not in moved.split("its standard deviation ")[0]
    kept = paper_run().evidence
    frame = kept.tables["reproduction_overall"].frame.assign(verdict="agrees")
    some = told_with(kept, "table-4", reproduction_overall=frame)
    assert "its standard deviation agrees (χ² = " in some
    assert "the largest LEPP agrees (χ² = " in some
    spread = paper_run(factor=2.0).prose("table-4")
    assert "its standard deviation differs" in spread


def test_other_methods_are_no_failure_to_reproduce():
    note = "that they differ is no failure to reproduce"
    assert note in page("drawn").prose("scoreboard", "delaunay/uniform")
    assert note not in page("drawn").prose("scoreboard", "incremental/uniform")
    assert "Independent published numbers met" not in page("drawn").tiles("delaunay/uniform")


def test_completeness():
    made = "All 64 triangulations were made; none failed. "
    assert page("drawn").prose("completeness").startswith(made)

    def lose(results):
        rows = results.index[(results["n_points"] == 2000) & (results["replicate"] < 2)]
        return failed(results, rows).drop(index=results.index[-3:])

    said = page_text(drawn(ONE, results=lose))
    assert said.prose("completeness").startswith(
        "Of 32 triangulations, 27 were made, 2 failed and 3 have not been run. "
    )
    alarms = sections.alarms(said.evidence)
    assert any("2 of 32 tasks failed, the first of them with 2000 points" in a for a in alarms)
    assert any("3 of 32 tasks have not been run yet" in a for a in alarms)
    description = sections.description(said.evidence)
    assert description.startswith("27 of 32 random triangulations of 1,000 to 8,000 points, ")
    assert sections.description(page("drawn").evidence).startswith(
        "64 random triangulations of 1,000 to 8,000 points, "
    )
    assert not [a for a in sections.alarms(page("drawn").evidence) if "tasks" in a]


def test_ties_are_counted():
    triangles = run("drawn")["results"]["n_triangles"].sum()
    none = page("drawn").prose("completeness")
    assert none.endswith(
        "No triangle has longest edges of exactly equal length, and 0 of "
        f"{triangles:,} have two that agree to 10⁻⁶ of their length: lengths are compared exactly, "
        "and where they are equal a path takes the shortest way."
    )


def test_statements_are_counted():
    for name in ("drawn", "growing"):
        rows = page(name).evidence.tables["statements"].frame.query("method == 'incremental'")
        counts = rows["holds"].value_counts()
        said = page(name).prose("statements")
        assert said.startswith(f"Of {len(rows)} statements of the paper, for uniform points and")
        for verdict, word, one in (
            ("yes", "hold", "holds"),
            ("no", "do not", "does not"),
            ("not tested", "are not tested", "is not tested"),
        ):
            n = counts.get(verdict, 0)
            words = re.findall(rf"\b{n} {one if n == 1 else word}\b", said)
            assert bool(words) == (verdict in counts)


def test_one_statement_holds_and_one_does_not():
    kept = page("drawn").evidence
    table = kept.tables["statements"]
    holds = ["yes", "no"] + ["undecided"] * (len(table.frame) - 2)
    frame = table.frame.assign(holds=holds)
    changed = replace(kept, tables=adding(kept.tables, replace(table, frame=frame)))
    said = PageText(changed).prose("statements")
    assert "method: 1 holds, 1 does not and 13 are undecided." in said


def test_worst_case_and_points():
    said = page("drawn")
    assert "all have the mean (n + 1) / 2 and the maximum n exactly" in said.finding(
        "figure-worst-case"
    )
    assert said.finding("figure-points") == (
        "400 points of each distribution: the uniform ones fill the unit square."
    )
    assert "from 12 at the narrow end to 1." in said.finding("figure-worst-case")


def test_methods_are_introduced_the_papers_first():
    assert (
        page("drawn")
        .prose("same-points")
        .startswith(
            "The plain insertion method, the paper's, inserts the points as they come and never "
            "flips an edge; the Delaunay method makes triangles that are as far from thin as the "
            "points allow. On the same"
        )
    )


def test_many_alarms_are_cut_short():
    one = design(
        methods=("incremental",), distributions=("uniform", "exponential"), sizes=(1000,),
        repetitions=1,
    )  # fmt: skip
    evidence = page_text(drawn(one)).evidence
    missing = evidence.rows(MISSING).frame
    alarms = sections.alarms(evidence)
    reasons = missing[~missing["what"].str.contains("saturating|law of path")]
    reasons = reasons[reasons["distribution"].isin(one.distributions)]["why"].nunique()
    assert len(alarms) == min(6, reasons)
    if reasons > 6:
        assert alarms[-1] == f"{reasons - 5} more, listed under “How it was made”."


def test_a_run_of_nothing_says_nothing():
    def none(frame):
        return frame.iloc[:0]

    said = page_text(drawn(ONE, results=none, histograms=none, regions=none, point_sets=none))
    assert said.prose("key-figures") == ""
    assert said.prose("anova") == ""
    assert said.prose("completeness").startswith("Of 32 triangulations, 0 were made")
    captions = [b.caption for b in said.blocks("completeness") if isinstance(b, TableBlock)]
    assert "What could not be computed, and why" in captions
    whole = [b.caption for b in page("growing").blocks("completeness") if isinstance(b, TableBlock)]
    missing = page("growing").evidence.rows(MISSING).empty
    assert ("What could not be computed, and why" in whole) == (not missing)
