import re
import shutil
from dataclasses import replace
from math import log10
from pathlib import Path

import pandas as pd
import pytest
from expected import Sheet
from page_sentences import Sentence, page_sentences
from recount import Outcome, recount_sentences
from run_data import Run, log10_chi2_tail, log10_f_tail, log10_t_tail
from scipy import stats
from tiny_runs import SMALL, store_run

from reports.study_page.sections import layers, parts
from study.design.design import Design
from study.run.triangulations import TRIANGULATIONS
from study.text.numbers import show

DESIGN = Design(
    methods=("incremental", "delaunay"),
    distributions=("uniform", "exponential"),
    sizes=(1000, 1400, 2000, 2800, 4000, 5600, 8000, 11_200),
    repetitions=7,
)
#: A number but for the power of ten behind it, and for a letter's index.
NUMBER = re.compile(r"(?<![\w⁰¹²³⁴⁵⁶⁷⁸⁹.])\d[\d,]*(?:\.\d+)?(?![\d.]*[⁰¹²³⁴⁵⁶⁷⁸⁹⁻])")


@pytest.fixture(scope="module")
def directory(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return store_run(tmp_path_factory.mktemp("recount") / "run", DESIGN, TRIANGULATIONS.perform)


@pytest.fixture(scope="module")
def sentences(directory: Path) -> list[Sentence]:
    return page_sentences(directory)


@pytest.fixture(scope="module")
def outcome(directory: Path, sentences: list[Sentence]) -> Outcome:
    return recount_sentences(sentences, Run(directory))


def test_every_sentence_of_a_run_is_recounted(outcome: Outcome) -> None:
    assert outcome.differing == []
    assert outcome.unchecked == []
    assert outcome.numbers > 1000


def test_every_sentence_of_a_run_too_small_for_much_is_recounted(tmp_path: Path) -> None:
    directory = store_run(tmp_path / "run", SMALL, TRIANGULATIONS.perform)
    outcome = recount_sentences(page_sentences(directory), Run(directory))
    assert outcome.differing == []
    assert outcome.unchecked == []


def test_every_sentence_of_a_run_of_which_a_method_stops_is_recounted(tmp_path: Path) -> None:
    stops = {"methods": ("incremental", "delaunay"), "largest": {"delaunay": SMALL.sizes[-2]}}
    design = SMALL.model_copy(update=stops)
    directory = store_run(tmp_path / "run", design, TRIANGULATIONS.perform)
    outcome = recount_sentences(page_sentences(directory), Run(directory))
    assert outcome.differing == []
    assert outcome.unchecked == []


def _moved(text: str, match: re.Match[str]) -> str:
    """The text with one of its numbers two units of its last digit larger."""
    digits = match[0].replace(",", "")
    places = len(digits.partition(".")[2])
    larger = f"{float(digits) + 2 * 10.0**-places:,.{places}f}"
    return text[: match.start()] + larger + text[match.end() :]


def test_nearly_every_number_that_is_moved_by_two_units_is_noticed(outcome: Outcome) -> None:
    moved, unnoticed = 0, []
    for sentence, expected, sheet in outcome.recounted:
        for match in NUMBER.finditer(sentence.text):
            moved += 1
            if sheet.differences(expected, _moved(sentence.text, match)) == []:
                unnoticed.append(f"{match[0]} in: {sentence.text}")
    assert moved > 1000
    # A large count in words shows three digits; some fits are known to fewer than they show.
    assert len(unnoticed) < 0.02 * moved, "\n".join(unnoticed)


def _altered(directory: Path, copy: Path, name: str, column: str, by: float, row: int) -> Run:
    shutil.copytree(directory, copy)
    path = copy / f"{name}.parquet"
    frame = pd.read_parquet(path)
    frame.loc[row, column] += type(frame.loc[row, column])(by)
    frame.to_parquet(path)
    return Run(copy)


@pytest.mark.parametrize(
    ("name", "column", "by", "place"),
    [
        ("results", "mean_lepp", 0.01, "figure-means"),
        ("results", "n_type_c", 60, "types"),
        ("histograms", "count", 5000, "figure-law"),
        ("layers", "count", 5000, "layers"),
        ("regions", "count", 20_000, "figure-regions"),
        ("point_sets", "ks_p_x", 0.99, "randomness"),
    ],
)
def test_a_number_altered_in_a_file_is_noticed(
    directory: Path,
    sentences: list[Sentence],
    tmp_path: Path,
    name: str,
    column: str,
    by: float,
    place: str,
) -> None:
    frame = pd.read_parquet(directory / f"{name}.parquet")
    largest = frame["n_points"] == frame["n_points"].max()
    chosen = frame[largest & (frame["distribution"] == "exponential")]
    row = int(chosen.index[0])
    if name == "point_sets":
        row, by = int(frame[column].idxmin()), by - float(frame[column].min())
    run = _altered(directory, tmp_path / "copy", name, column, by, row)
    of_place = [one for one in sentences if one.place == place]
    outcome = recount_sentences(of_place, run)
    assert outcome.differing
    assert all(text.startswith(place) for text in outcome.differing)


def test_a_number_that_a_section_gets_wrong_is_noticed(
    directory: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def wrong(value: float, how: str) -> str:
        return show(value + 0.0002, how) if how == "fixed4" else show(value, how)

    for module in (parts, layers):
        monkeypatch.setattr(module, "show", wrong)
    outcome = recount_sentences(page_sentences(directory), Run(directory))
    places = {text.partition(" ")[0] for text in outcome.differing}
    assert places == {"parts", "figure-parts", "layers", "key-figures"}


def test_other_words_and_a_sentence_that_is_not_known_are_noticed(
    directory: Path, sentences: list[Sentence]
) -> None:
    falls = next(one for one in sentences if " grows with the number of points" in one.text)
    lie = replace(falls, text=falls.text.replace(" grows ", " falls "))
    new = Sentence("types", "incremental", "uniform", "Nobody has counted 3 of these.")
    outcome = recount_sentences([lie, new], Run(directory))
    assert len(outcome.differing) == 1
    assert outcome.unchecked == [f"types [incremental/uniform]: {new.text}"]
    assert not outcome.good


@pytest.mark.parametrize(
    ("value", "text", "same"),
    [
        (3.06689, "3.0669", True),
        (3.06683, "3.0669", False),
        (-1.9, "−1.90", True),
        (671_960_000, "672 million", True),
        (671_400_000, "672 million", False),
        (3.2304e9, "3.23 billion", True),
        (1.0123e6, "1.01 × 10⁶", True),
        (1.04e6, "1.01 × 10⁶", False),
        (1e9, "10⁹", True),
        (0, "none", True),
        (1, "none", False),
        (float("inf"), "∞", True),
    ],
)
def test_a_number_is_held_against_the_digits_shown(value: float, text: str, same: bool) -> None:
    sheet = Sheet()
    assert (sheet.differences(f"It is {sheet(value)}.", f"It is {text}.") == []) is same


@pytest.mark.parametrize(
    ("log10_p", "text", "same"),
    [
        (-37.1267, "7.5 × 10⁻³⁸", True),
        (-37.11, "7.5 × 10⁻³⁸", False),
        (-0.0649, "0.8612", True),
        (-0.0652, "0.8612", False),
        (-1000.0, "< 10⁻³⁰⁷", True),
    ],
)
def test_a_p_value_is_held_against_the_digits_shown(log10_p: float, text: str, same: bool) -> None:
    sheet = Sheet()
    assert (sheet.differences(f"p = {sheet.p(log10_p)}.", f"p = {text}.") == []) is same


def test_tails_far_out_meet_those_of_scipy_as_far_as_it_has_them() -> None:
    # Below 10^-200 series take over; SciPy's own go on to 10^-300.
    assert log10_f_tail(200.0, 19, 780) == pytest.approx(log10(stats.f.sf(200.0, 19, 780)))
    assert log10_chi2_tail(1200.0, 20) == pytest.approx(log10(stats.chi2.sf(1200.0, 20)))
    assert log10_t_tail(1e8, 30) == pytest.approx(log10(stats.t.sf(1e8, 30)))


def test_a_recount_uses_nothing_of_what_it_checks() -> None:
    for path in Path(__file__).parent.glob("*.py"):
        if path.stem not in ("page_sentences", "test_recount"):  # the page, and this
            imported = re.findall(r"^\s*(?:from|import) ([\w.]+)", path.read_text(), re.MULTILINE)
            ours = {name for name in imported if name.startswith(("study", "reports", "lepp"))}
            assert ours <= {"lepp", "study.design.sampling"}, path.name
