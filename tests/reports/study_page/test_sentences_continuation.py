"""What the report says of the chance to go on, at the edge and inside, of tables made for it."""

import pytest
from frames import design

from reports.page.blocks import FigureBlock
from reports.page.evidence import Evidence
from reports.page.views import View
from reports.study_page.sections import continuation, theory
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
from study.analysis.table import Tables
from study.analysis.theorems import THEOREM_1, THEOREM_2
from study.design.design import Design
from study.statistics.groups import ENOUGH
from study.statistics.thresholds import ROUGH_RATE
from study.statistics.verdicts import NO, NOT_REJECTED, REJECTED, YES

VIEW = View("incremental", "uniform")
KEY = VIEW.where | {"n_points": 8000}
#: Half of an interval of a chance that is known well.
HALF = 0.005

Rates = dict[int, float]


def rates(part: str, chances: Rates, half: float = HALF, rough: tuple = (), **key: object) -> list:
    """Rows of the chances of a part; those of the sizes in `rough` are not known well."""
    return [
        KEY
        | key
        | {"part": part, "lepp_size": k, "rate": chance, "constant": chance}
        | dict(zip(("low", "high"), (chance - width, chance + width), strict=True))
        for k, chance in chances.items()
        for width in [ROUGH_RATE if k in rough else half]
    ]


def law(name: str, part: str = "interior", **values: object) -> dict:
    numbers = {"f": 1.25, "df": 7, "df_residual": 39, "log10_p": -1.0, "upto_size": 5}
    counts = {"paths": 16_000_000, "longest_seen": 31}
    return KEY | numbers | counts | {"law": name, "part": part} | values


def caption(name: str, tables: list, **asked: object) -> str:
    """The caption of a figure of the chances."""
    made = continuation.going_on(Evidence(Tables(tables), design(**asked), {}))
    (figure,) = (b for b in made.blocks if isinstance(b, FigureBlock) and b.id == f"figure-{name}")
    return str(figure.alternatives.get(VIEW.key, "")).replace("\u00a0", " ")


def said(rows: list, laws: list, **asked: object) -> str:
    tables = [TERMINATION.table([]), LAW.table([]), CONTINUATION.table(rows), PATH_LAWS.table(laws)]
    return caption("continuation", tables, **asked)


LAWS = [law(CONSTANT, verdict=REJECTED)]
INSIDE = {2: 0.52, 3: 0.5, 4: 0.45, 5: 0.4}
DOWN_AND_UP = {2: 0.52, 3: 0.5, 4: 0.46, 5: 0.53, 6: 0.55, 7: 0.54}
RISE = (
    "In the whole mesh it falls to 46.0 % after 4 triangles and rises again, to 55.0 % after 6: "
    "the longest paths are those along the edge."
)


def test_the_chance_of_the_whole_mesh_rises_again():
    assert RISE in said(rates("interior", INSIDE) + rates("whole", DOWN_AND_UP), LAWS)


@pytest.mark.parametrize(
    ("inside", "whole"),
    [
        (INSIDE, {2: 0.52, 3: 0.5, 4: 0.46, 5: 0.45}),  # the last is the least
        (INSIDE, {2: 0.52, 3: 0.5, 4: 0.46, 5: 0.469}),  # the intervals overlap
        (INSIDE | {6: 0.56}, DOWN_AND_UP),  # the interior's rises as well
        ({}, DOWN_AND_UP),
        (INSIDE, {}),
    ],
)
def test_the_chance_of_the_whole_mesh_does_not_rise(inside, whole):
    text = said(rates("interior", inside) + rates("whole", whole), LAWS)
    assert "rises again" not in text


@pytest.mark.parametrize(
    ("least", "end", "told"),
    [
        # Intervals of 0.01 that are just apart, or only touch: of the whole mesh, of the interior.
        (0.539, 0.5, True),
        (0.541, 0.5, False),
        (0.5, 0.539, True),
        (0.5, 0.541, False),
    ],
)
def test_a_rise_is_one_beyond_the_intervals(least, end, told):
    rows = rates("interior", {2: 0.6, 3: end}) + rates("whole", {2: 0.6, 3: least, 4: 0.55})
    assert ("rises again" in said(rows, LAWS)) == told


def test_a_rise_of_chances_that_are_not_known_is_none():
    unknown = rates("interior", INSIDE) + rates("whole", DOWN_AND_UP, rough=(5,))
    assert "rises again" not in said(unknown, LAWS)
    # What is not known inside does not count against it either.
    inside = rates("interior", INSIDE | {6: 0.9}, rough=(6,))
    assert RISE in said(inside + rates("whole", DOWN_AND_UP), LAWS)
    none = rates("interior", INSIDE, rough=(2,))
    assert "rises again" not in said(none + rates("whole", DOWN_AND_UP), LAWS)


@pytest.mark.parametrize(
    ("chances", "rough", "words"),
    [
        (
            {2: 0.5, 3: 0.4, 4: 0.3},
            (),
            "falls with every step, from 50.0 % to 30.0 %, up to size 4, as far as it is known to "
            "within 0.05",
        ),
        (
            {2: 0.5, 3: 0.4, 4: 0.45},
            (4,),
            "falls with every step, from 50.0 % to 40.0 %, up to size 3, as far",
        ),
        ({2: 0.3, 3: 0.4, 4: 0.5}, (), "rises with every step, from 30.0 % to 50.0 %"),
        ({2: 0.5, 3: 0.501, 4: 0.4}, (), "falls from 50.0 % to 40.0 %, up to"),
        ({2: 0.5, 3: 0.499, 4: 0.6}, (), "rises from 50.0 % to 60.0 %, up to"),
        ({2: 0.5, 3: 0.4, 4: 0.45}, (), "moves between 40.0 % and 50.0 %, up to size 4"),
        ({2: 0.5, 3: 0.501, 4: 0.5}, (), "moves between 50.0 % and 50.1 %"),
        (
            {2: 0.5, 3: 0.4},
            (3,),
            "falls with every step, from 50.0 % to 40.0 %, up to size 3, where it is not known to "
            "within 0.05",
        ),
        (
            {2: 0.5, 3: 0.4},
            (2,),
            "falls with every step, from 50.0 % to 40.0 %, up to size 3, where it is not known",
        ),
    ],
)  # fmt: skip
def test_how_the_chance_changes(chances, rough, words):
    text = said(rates("interior", chances, rough=rough), LAWS)
    assert f"At 8,000 points, in the interior, the chance to go on {words}" in text


@pytest.mark.parametrize(
    "chances", [{2: 0.5, 3: 0.4}, {2: 0.4, 3: 0.5}, {2: 0.5, 3: 0.499, 4: 0.6}]
)
def test_one_chance_that_fits_moves(chances):
    text = said(rates("interior", chances), [law(CONSTANT, verdict=NOT_REJECTED)])
    shown = [f"{100 * end(chances.values()):.1f} %" for end in (min, max)]
    assert f"the chance to go on moves between {shown[0]} and {shown[1]}, up to" in text
    assert "One chance for all steps is not rejected (F = 1.25 on 7 and 39 " in text
    assert "The law" not in text


def test_why_the_chances_are_not_of_the_largest_number_of_points():
    rows = rates("interior", INSIDE)
    assert said(rows, LAWS, sizes=(1000, 8000)).startswith("At 8,000 points, in the interior,")
    assert said(rows, LAWS, sizes=(8000, 16_000)).startswith(
        f"At 8,000 points (the largest number with {ENOUGH} triangulations or more), in the"
    )


FITTED = {
    "scale": 0.9, "scale_error": 0.012, "shift": 0.35, "shift_error": 0.07, "exponent": 0.5,
    "exponent_error": 0.003, "longest_expected": 28,
}  # fmt: skip


@pytest.mark.parametrize(
    ("upto", "rough", "why"),
    [
        (5, (), ""),
        (4, (), " (no more sizes than a third of the covariance's degrees of freedom)"),
        (4, (5,), ""),  # it is not known
    ],
)
def test_why_the_law_is_not_fitted_further(upto, rough, why):
    laws = [*LAWS, law(FALLING, verdict=NOT_REJECTED, **FITTED | {"upto_size": upto})]
    rows = rates("interior", INSIDE, rough=rough) + rates("whole", INSIDE | {9: 0.3})
    assert (
        "The law λ / (k + b)ᵃ with λ = 0.900 ± 0.012, b = 0.350 ± 0.070 and a = 0.500 ± 0.003, "
        f"fitted up to size {upto}{why}, is {NOT_REJECTED} (F = 1.25 on 7 and 39 "
    ) in said(rows, laws)


def test_the_longest_path_expected_by_a_law_though_it_is_rejected():
    beside = [law(FIRST_STEP, longest_expected=20), law(ALL_STEPS, longest_expected=22)]
    told = "The longest of 16 million such paths at 8,000 points has 31 triangles"
    others = "20 by Theorem 1 with the chance at the first step and 22 by Theorem 1 with that of "
    for verdict, although in ((REJECTED, " (which is rejected)"), (NOT_REJECTED, "")):
        laws = [*LAWS, law(FALLING, verdict=verdict, **FITTED), *beside]
        text = said(rates("interior", INSIDE), laws)
        assert f"{told}; expected are 28 by this law{although}, {others}all steps." in text
    text = said(rates("interior", INSIDE), [*LAWS, *beside])
    assert f"{told}; expected are {others}all steps." in text
    assert said(rates("interior", INSIDE), LAWS).endswith(f"{told}.")
    assert "The longest" not in said(rates("interior", INSIDE), [])


def test_of_the_whole_mesh_where_there_is_no_interior():
    laws = [law(CONSTANT, part="whole", verdict=REJECTED)]
    text = said(rates("whole", DOWN_AND_UP), laws)
    assert text.startswith("At 8,000 points, in the whole mesh, the chance to go on ")
    assert "rises again" not in text
    assert said([], []) == ""


@pytest.mark.parametrize("part", ["interior", "whole"])
@pytest.mark.parametrize("verdict", [REJECTED, NOT_REJECTED, None])
def test_one_chance_for_all_steps(part, verdict):
    where = {"interior": "in the interior", "whole": "in the whole mesh"}[part]
    # The whole mesh is not asked where there is an interior.
    laws = [law(FIRST_STEP, part=part), law(CONSTANT, part="whole", verdict="of the whole mesh")]
    if part == "whole":
        laws.pop()
    if verdict:
        laws.append(law(CONSTANT, part=part, verdict=verdict))
    evidence = Evidence(Tables([PATH_LAWS.table(laws)]), design(), {})
    numbers = f"(F = 1.25 on 7 and 39 degrees of freedom, p = 0.1000, {where})"
    long, short = {
        REJECTED: (f"No single chance fits the steps {numbers}, whichever it is.", "rejected"),
        NOT_REJECTED: (f"That one chance fits all steps is not rejected {numbers}.", NOT_REJECTED),
        None: ("The run is too small to test whether one chance fits all steps.", ""),
    }[verdict]
    assert continuation.one_chance(evidence, VIEW).replace("\u00a0", " ") == long
    assert continuation.one_chance_in_short(evidence, VIEW).replace("\u00a0", " ") == (
        f"which is {short} (p = 0.1000)" if verdict else "which this run is too small to test"
    )


def law_said(p: float, shares: Rates) -> str:
    """The caption of the geometric law, which has no triangles of size 1."""
    rows = [
        VIEW.where
        | {
            "lepp_size": k,
            "share": share,
            "geometric_share": (1 - p) ** (k - 2) * p if k > 1 else 0,
        }
        for k, share in shares.items()
    ]
    ended = [VIEW.where | {"lepp_size": k, "p_type_c": p} for k in shares]
    tables = [
        TERMINATION.table(ended),
        LAW.table(rows),
        CONTINUATION.table([]),
        PATH_LAWS.table([]),
    ]
    return caption("law", tables)


@pytest.mark.parametrize(
    ("shares", "words"),
    [
        (
            {1: 0.6, 2: 0.1, 3: 0.3},
            "The commonest size is 3 (30.0 % of the triangles; the law has 25.0 %).",
        ),
        # Half of the paths go on: in the law a share of 2⁻⁶ is of 8 triangles and more.
        (
            {2: 0.5, 7: 0.4375, 8: 2**-5, 9: 2**-5},
            "The commonest size is 2 (50.0 % of the triangles; the law has 50.0 %). Sizes of 8 and "
            "more are 4.0 times as common as in the law.",
        ),
        (
            {2: 0.5, 7: 0.492, 8: 2**-8, 9: 2**-8},
            "The commonest size is 2 (50.0 % of the triangles; the law has 50.0 %). Sizes of 8 and "
            "more are 2.0 times rarer than in the law.",
        ),
        (
            {2: 0.5, 7: 0.48, 8: 2**-6},
            "The commonest size is 2 (50.0 % of the triangles; the law has 50.0 %). Sizes of 8 and "
            "more are 1.0 times as common as in the law.",
        ),
        ({}, ""),
        ({1: 1.0}, ""),
    ],
)  # fmt: skip
def test_the_geometric_law(shares, words):
    assert law_said(0.5, shares) == words


# Theorem 2's premise, at the edge

EDGE = " The edge of the mesh has a part in it: in the interior, at 8,000 points, the least is "


def premise(inside: list, groups: list, asked: Design | None = None) -> str:
    known = {"bounds": YES, "p_type_c": 0.48, "highest_mean": 3.2, "lowest_mean": 3.0,
             "highest_sd": 1.5}  # fmt: skip
    rows = [VIEW.where | known | group for group in groups]
    tables = [CONTINUATION.table(inside), THEOREM_1.table([]), THEOREM_2.table(rows)]
    paragraphs = theory._premise(Evidence(Tables(tables), asked or design(), {}), VIEW)
    assert paragraphs is not None
    return " ".join(paragraphs).replace("\u00a0", " ")


def group(n: int, verdict: str, rate: float | None, size: int = 9, high: float = 0.45) -> dict:
    found = {"lowest_rate": rate, "lowest_size": size, "lowest_high": high} if rate else {}
    return {"n_points": n, "premise": verdict} | found


@pytest.mark.parametrize(("high", "told"), [(0.464, True), (0.466, False)])
def test_the_least_chance_to_end_is_of_the_edge_where_the_interior_has_more(high, told):
    # The most that the interior has: 0.53 ± 0.005 go on after 3 triangles, 0.47 end.
    inside = rates("interior", {2: 0.52, 3: 0.53, 4: 0.5, 5: 0.9}, rough=(5,))
    text = premise(inside, [group(4000, YES, 0.46, high=0.459), group(8000, YES, 0.44, high=high)])
    assert "is 0.4400, at size 9 and 8,000 points." in text
    words = (
        "0.4700, at size 3, as far as the chances there are known (up to size 4). The bounds hold "
    )
    assert (f"{EDGE}{words}" in text) == told
    assert (EDGE in text) == told


@pytest.mark.parametrize(("high", "told"), [(0.464, True), (0.466, False)])
def test_the_interior_is_held_against_the_whole_mesh_of_as_many_points(high, told):
    # With more points the least is less: that is not the edge's doing.
    inside = rates("interior", {2: 0.52, 3: 0.53})
    text = premise(inside, [group(8000, YES, 0.455, high=high), group(16_000, YES, 0.44)])
    assert "is 0.4400, at size 9 and 16,000 points." in text
    words = "Where it is 0.4550, the edge of the mesh has a part in it: in the interior, at 8,000 "
    assert (words in text) == ("a part in it" in text) == told


@pytest.mark.parametrize(("ended", "below"), [(0.327, True), (0.329, False)])
def test_an_interior_below_a_third_is_no_excuse(ended, below):
    # The interval is 0.005 to either side.
    text = premise(rates("interior", {2: 0.52, 3: 1 - ended}), [group(8000, NO, 0.29, high=0.295)])
    words = " It is higher in the interior, but below 1/3 there as well: at 8,000 points, the least"
    assert (words in text) == below
    assert (EDGE in text) != below


@pytest.mark.parametrize("inside", [[], rates("interior", INSIDE, rough=(2,))])
def test_nothing_is_said_of_an_interior_that_is_not_known(inside):
    assert EDGE not in premise(inside, [group(8000, YES, 0.1, high=0.2)])


def test_no_step_is_known():
    text = premise([], [group(8000, YES, None)])
    assert "No step is known to within 0.05, so that this stays open." in text
    assert "the least chance to end" not in text


@pytest.mark.parametrize(
    ("verdicts", "words"),
    [
        ((YES, YES, YES), "this holds in every group: "),
        ((NO, NO, NO), "this fails in every group: "),
        ((YES, NO, NO), "this fails in 2 of 3 groups: "),
        ((YES, NO, "undecided"), "this fails in 1 of 3 groups: "),
        ((YES, YES, "undecided"), "this is clear in 2 of 3 groups: "),
    ],
)
def test_the_premise_by_groups(verdicts, words):
    groups = [group(1000 * k, verdict, 0.4 + k / 100) for k, verdict in enumerate(verdicts, 1)]
    assert words in premise([], groups)
    alone = {"n_points": 8000, "premise": None}
    asked = design(repetitions=(6, 6, 6, 1))
    said = premise([], [*groups, alone], asked)
    has = "has" if "every" in words else "have"
    assert words.replace(": ", f" that {has} a spread: ") in said
