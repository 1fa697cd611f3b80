"""Recount every sentence of a run's page from its Parquet files.

    .venv/bin/python tests/reports/recount/recount.py DIRECTORY

Prints how many sentences and numbers the page has, what differs, and what is not checked; the exit
code is 1 if anything is. The page is made by the project; what its numbers should be is computed
here anew, without `study.statistics`, `study.analysis` or `study.paper`.
"""

import sys
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

if __name__ == "__main__":
    _ROOT = Path(__file__).resolve().parents[3]
    sys.path[:0] = [str(_ROOT), str(_ROOT / "tests" / "lepp")]

import of_comparisons
import of_consistency
import of_edge
import of_growth
import of_paper
import of_rest
import of_statistics
import of_theory
from definitions import DEFINITIONS, FIGURE
from expected import Sheet
from page_sentences import Sentence, page_sentences
from recounts import View, recount_of
from run_data import Run

MODULES = (
    of_comparisons, of_consistency, of_edge, of_growth, of_paper, of_rest, of_statistics, of_theory,
)  # fmt: skip


@dataclass
class Outcome:
    """What a recount has come to.

    Attributes
    ----------
    sentences, definitions, numbers : int
        Sentences of the page; of which have nothing to count; numbers held against ours.
    differing, unchecked : list of str
    recounted : list of (Sentence, str, Sheet)
        Each with the sentence that is expected, and its numbers.
    """

    sentences: int = 0
    definitions: int = 0
    numbers: int = 0
    differing: list[str] = field(default_factory=list)
    unchecked: list[str] = field(default_factory=list)
    recounted: list[tuple[Sentence, str, Sheet]] = field(default_factory=list)

    @property
    def good(self) -> bool:
        """Whether every sentence is checked, and none differs."""
        return not (self.differing or self.unchecked)

    def summary(self) -> str:
        """All in a line."""
        checked = self.sentences - self.definitions - len(self.unchecked)
        return (
            f"{self.sentences:,} sentences: {checked:,} recounted with {self.numbers:,} numbers, "
            f"{self.definitions:,} definitions, {len(self.differing):,} differing, "
            f"{len(self.unchecked):,} unchecked"
        )


def recount_sentences(sentences: Sequence[Sentence], run: Run) -> Outcome:
    """Hold sentences of a page against a run's Parquet files."""
    outcome = Outcome(sentences=len(sentences))
    seen: Counter = Counter()
    for one in sentences:
        place = f"{one.place} [{one.method}/{one.distribution}]"
        if any(FIGURE.sub("Figure N", one.text) in texts for texts in DEFINITIONS.values()):
            outcome.definitions += 1
            continue
        function = recount_of(one.place, one.text)
        if function is None:
            outcome.unchecked.append(f"{place}: {one.text}")
            continue
        key = function, one.place, one.method, one.distribution
        sheet, view = Sheet(), View(run, one.method, one.distribution)
        try:
            expected = function(view, sheet, seen[key])
        except Exception as error:
            outcome.differing.append(f"{place}: {one.text}\n    not recounted: {error!r}")
            continue
        finally:
            seen[key] += 1
        differences = sheet.differences(expected, one.text)
        outcome.numbers += len(sheet.numbers)
        outcome.recounted.append((one, expected, sheet))
        if differences is None:
            differences = [f"other words; recounted: {sheet.filled(expected)}"]
        if differences:
            outcome.differing.append("\n    ".join([f"{place}: {one.text}", *differences]))
    return outcome


def main(directory: Path) -> int:
    """Recount one run, print what comes of it, and return the exit code."""
    outcome = recount_sentences(page_sentences(directory), Run(directory))
    for title, each in (("Differing", outcome.differing), ("Unchecked", outcome.unchecked)):
        for text in each:
            print(f"{title}: {text}")
    print(outcome.summary())
    return 0 if outcome.good else 1


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1])))
