"""Runs that are unfinished, have failures, or are too small for a statistic."""

from pathlib import Path

import pytest
from tiny_runs import store_run

from reports.study_page.page import write_report
from study.design.design import Design
from study.run.kinds import Outcome
from study.run.triangulations import TRIANGULATIONS, Task

SMALL = Design(distributions=("uniform", "exponential"), sizes=(200, 400), repetitions=4)
ERROR = "ValueError: <script>alert(1)</script> & more"


def text_of(directory: Path) -> str:
    return write_report(directory).read_text(encoding="utf-8")


def test_unfinished_run_says_how_much_is_missing(tmp_path: Path) -> None:
    def half(task: Task, design: Design) -> Outcome | None:
        return TRIANGULATIONS.perform(task, design) if task.replicate < 2 else None

    text = text_of(store_run(tmp_path / "run", SMALL, half))
    assert "What is missing" in text
    assert "8 of 16 random triangulations" in text
    assert "Uniform: 4 of 8 tasks have not been run yet." in text


def test_run_without_any_result_has_a_report(tmp_path: Path) -> None:
    text = text_of(store_run(tmp_path / "run", SMALL, lambda task, design: None))
    assert "0 of 16 random triangulations" in text
    assert "Exponential: 8 of 8 tasks have not been run yet." in text
    assert "There is not enough data to draw this" in text


def test_failed_tasks_are_named_and_their_errors_escaped(tmp_path: Path) -> None:
    def failing(task: Task, design: Design) -> Outcome:
        if task.distribution == "exponential" and task.replicate == 0:
            return TRIANGULATIONS.failed(task, design, ERROR)
        return TRIANGULATIONS.perform(task, design)

    directory = store_run(tmp_path / "run", SMALL, failing)
    text = text_of(directory)
    assert "Exponential: 2 of 8 tasks failed" in text
    assert "alert(1)</script>" not in text
    assert "&lt;script&gt;alert(1)" in text
    assert (directory / "tables" / "failures.csv").read_text().count("alert(1)") == 2


@pytest.mark.parametrize(
    ("sizes", "repetitions", "lacking"),
    [((300,), 4, "analysis of variance"), ((200, 400), 1, "Shapiro-Wilk test")],
    ids=["one size", "one repetition"],
)
def test_what_cannot_be_computed_is_said(
    tmp_path: Path, sizes: tuple[int, ...], repetitions: int, lacking: str
) -> None:
    design = Design(distributions=("uniform",), sizes=sizes, repetitions=repetitions)
    text = text_of(store_run(tmp_path / "run", design, TRIANGULATIONS.perform))
    alarm = text[text.index("What is missing") : text.index("</ul>")]
    assert lacking in alarm


def test_full_run_has_no_alarm(report: Path) -> None:
    assert "What is missing" not in report.read_text(encoding="utf-8")
