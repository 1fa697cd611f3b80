"""The key figures and the opening, of tables made for them."""

import pytest
from frames import design
from scipy import stats

from reports.page.evidence import Evidence
from reports.page.views import View
from reports.study_page.sections import summary
from reports.study_page.tables import TABLE_4
from study.analysis.group_summaries import GROUPS, OVERVIEW
from study.analysis.table import Tables
from study.analysis.terminal_regions import REGIONS
from study.analysis.theorems import THEOREM_1, THEOREM_2
from study.paper.judging import AGREES, CLOSE, DIFFERS, NOT_RUN
from study.paper.published import BY_CONSTRUCTION, INDEPENDENT
from study.paper.reproduction import REPRODUCTION
from study.paper.statements import NOT_TESTED, STATEMENTS
from study.statistics.verdicts import NO, NOT_REJECTED, NOT_SHOWN, UNDECIDED, YES

METHODS = ("incremental", "delaunay", "swept")  # names on both sides of that of the paper's
VIEWS = [View(method, d) for method in METHODS for d in ("uniform", "exponential")]


def printed(verdict: str, difference: float | None, **where: str) -> dict:
    asked = {"method": "incremental", "distribution": "uniform", "standing": INDEPENDENT} | where
    return asked | {"verdict": verdict, "difference": difference}


NUMBERS = [
    printed(AGREES, 1.5),
    printed(CLOSE, -2.5),
    printed(DIFFERS, 4.0),
    printed(NOT_RUN, None),
    printed(DIFFERS, 9.0, standing=BY_CONSTRUCTION),
    printed(AGREES, 0.5, distribution="exponential"),
    printed(DIFFERS, -3.5, distribution="exponential"),
    printed(DIFFERS, 20.0, method="delaunay"),
    printed(DIFFERS, 20.0, method="delaunay", distribution="exponential"),
    printed(DIFFERS, 20.0, method="swept"),
    printed(DIFFERS, 20.0, method="swept", distribution="exponential"),
]


def tiles(view: View, numbers: list = NUMBERS, regions: bool = True) -> dict:
    """Value and context of the tiles of a view, by their labels."""
    tables = [REPRODUCTION.table(numbers), THEOREM_1.table([]), THEOREM_2.table([])]
    rows = {
        OVERVIEW: {"max_lepp": 21, "triangles": 3_400_000, "triangulations": 12},
        TABLE_4: {"n_points": 4000, "mean_lepp": 3.05},
        GROUPS: {"n_points": 4000, "mean_low": 3.04, "mean_high": 3.06},
        REGIONS: {"n_points": 4000, "pair_share": 0.4567},
    }
    for declared, row in rows.items():
        made = [] if declared is REGIONS and not regions else [v.where | row for v in VIEWS]
        tables.append(declared.table(made))
    found = summary._tiles(Evidence(Tables(tables), design(), {}), view)
    assert found is not None
    return {t.label: tuple(x.replace("\u00a0", " ") for x in (t.value, t.context)) for t in found}


def together(*differences: float) -> str:
    p = stats.chi2.sf(sum(z * z for z in differences), len(differences))
    return f"within 3 standard errors; χ² of all has p = {p:.4f}"


ALL = "Independent published numbers met"
OF_ONE = "Published numbers of exponential points met"


def test_published_numbers_met_are_those_of_the_view():
    # In the view of the paper's own tables all are counted, in another its distribution's.
    plain = tiles(VIEWS[0])
    value, context = plain[ALL]
    assert value == "3 of 5"
    z = (1.5, -2.5, 4.0, 0.5, -3.5)
    p = stats.chi2.sf(sum(d * d for d in z), 5)
    assert context.startswith("within 3 standard errors; χ² of all has p = ")
    mantissa, power = context.split("p = ")[1].replace("⁻", "-").split(" × 10")
    shown = float(mantissa) * 10.0 ** int(
        power.translate(str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹", "0123456789"))
    )
    assert shown == pytest.approx(p, rel=0.05)
    assert OF_ONE not in plain
    other = tiles(VIEWS[1])
    assert other[OF_ONE] == ("1 of 2", together(0.5, -3.5))
    assert ALL not in other


@pytest.mark.parametrize("view", VIEWS[2:], ids=lambda view: view.key)
def test_no_published_number_is_met_by_another_method(view):
    assert not [label for label in tiles(view) if "ublished" in label]


def test_published_numbers_that_were_not_run_make_no_tile():
    numbers = [printed(NOT_RUN, None), printed(NOT_RUN, None, distribution="exponential")]
    for view in VIEWS:
        assert not [label for label in tiles(view, numbers) if "ublished" in label]
    # One of which no standard error is known, as of a count, is judged but not summed.
    counted = [printed(AGREES, None, distribution="exponential")]
    assert tiles(VIEWS[1], counted)[OF_ONE] == ("1 of 1", "within 3 standard errors")


def test_tiles_of_what_was_measured():
    found = tiles(VIEWS[3], regions=False)
    assert found == {
        "Mean LEPP at 4,000 points": ("3.0500", "95 % interval 3.0400 to 3.0600"),
        "Longest path": ("21", "among 3.4 million triangles"),
    }
    pair = ("45.7 %", "triangles where a refinement stays local")
    assert tiles(VIEWS[3]) == found | {"In a terminal pair": pair}


@pytest.mark.parametrize("lacking", [OVERVIEW, TABLE_4], ids=lambda declared: declared.name)
def test_nothing_is_said_of_what_was_not_run(lacking):
    tables = {declared: declared.table([VIEWS[0].where]) for declared in (OVERVIEW, TABLE_4)}
    tables[lacking] = lacking.table([])
    evidence = Evidence(Tables(tables.values()), design(), {})
    assert summary._spread(evidence, VIEWS[0]) is None
    assert summary._tiles(evidence, VIEWS[0]) is None


@pytest.mark.parametrize("lacking", [THEOREM_1, THEOREM_2], ids=lambda declared: declared.name)
def test_nothing_is_said_of_theorems_that_were_not_tested(lacking):
    tables = {one: one.table([VIEWS[0].where | {"n_points": 1}]) for one in (THEOREM_1, THEOREM_2)}
    tables[lacking] = lacking.table([])
    assert summary._theory(Evidence(Tables(tables.values()), design(), {}), VIEWS[0]) is None


@pytest.mark.parametrize(
    ("relative", "words"), [(-0.0123, "1.2 % below"), (0.0, "0.0 % above"), (0.02, "2.0 % above")]
)
def test_how_far_off(relative, words):
    assert summary._off(relative).replace("\u00a0", " ") == words


def bounds(*groups: dict) -> Evidence:
    rows = [VIEWS[0].where | {"n_points": 1000 * k} | row for k, row in enumerate(groups, 1)]
    return Evidence(Tables([THEOREM_2.table(rows)]), design(), {}).rows(THEOREM_2)


@pytest.mark.parametrize(
    ("groups", "words"),
    [
        (
            [{"premise": YES, "upto_size": 7}, {"premise": YES, "upto_size": 7}],
            ". So does what they follow from, that every step ends a path with a chance of at "
            "least 1/3, as far as the chances are known to within 0.05 (up to size 7)",
        ),
        (
            [{"premise": YES, "upto_size": 9}, {"premise": YES, "upto_size": 7}],
            "0.05 (up to size 7 to 9, by the number of points)",
        ),
        (
            [{"premise": NO, "lowest_rate": 0.31}, {"premise": NO, "lowest_rate": 0.3}],
            "although not every step ends a path with a chance of at least 1/3 (the least is "
            "0.3000), from which they would follow",
        ),
        (
            [{"premise": NO, "lowest_rate": 0.31}, {"premise": YES, "lowest_rate": 0.4}],
            "1/3 (at 1 of 2 numbers of points, the least is 0.3100), from",
        ),
        (
            [{"premise": UNDECIDED}, {"premise": YES}],
            "while it stays open whether every step ends a path with a chance of at least 1/3, "
            "from which they would follow",
        ),
    ],
)
def test_what_theorem_2_supposes(groups, words):
    assert words in summary._supposed(bounds(*groups))


@pytest.mark.parametrize(
    ("verdicts", "words"),
    [
        ((YES, NO), "Of 2 statements of the paper, for uniform points and the plain insertion "
         "method: 1 holds and 1 does not."),
        ((YES, YES, NO, NO), "2 hold and 2 do not."),
        ((UNDECIDED, NOT_REJECTED, NOT_SHOWN, NOT_TESTED, NOT_TESTED),
         f"1 is {UNDECIDED}, 1 is {NOT_REJECTED}, 1 is {NOT_SHOWN} and 2 are {NOT_TESTED}."),
    ],
)  # fmt: skip
def test_statements_are_counted_by_verdict(verdicts, words):
    rows = [VIEWS[0].where | {"holds": verdict} for verdict in verdicts]
    (said,) = summary._statements(
        Evidence(Tables([STATEMENTS.table(rows)]), design(), {}), VIEWS[0]
    )
    assert words in said
