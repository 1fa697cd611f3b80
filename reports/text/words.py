"""Words and signs that texts of the report share."""

from lepp.theory import LEAST_P_TEXT
from study.paper.judging import AGREES, CLOSE, DIFFERS, IMPLAUSIBLE, PLAUSIBLE
from study.statistics.thresholds import CONFIDENCE, ONE_IN_TWENTY
from study.statistics.verdicts import NO, YES

#: Title of the study's page.
TITLE = "How far does one refinement spread?"
#: The level of intervals, with a space at which no line ends.
LEVEL = f"{100 * CONFIDENCE:g}\u00a0%"
#: Theorem 2's premise.
PREMISE = f"p\u00a0≥\u00a0{LEAST_P_TEXT}"
#: Begin of a sentence on what is rejected.
AFTER_HOLM = (
    f"After Holm's correction, which lets a false rejection through in {ONE_IN_TWENTY} such "
    "studies,"
)

_SENSES = dict.fromkeys((AGREES, CLOSE, PLAUSIBLE, YES), "good")
_SENSES |= dict.fromkeys((DIFFERS, IMPLAUSIBLE, NO), "bad")


def sense(verdict: str) -> str:
    """Whether a verdict is ``good`` or ``bad`` news for what is judged; empty if neither."""
    return _SENSES.get(verdict, "")


def every(number: int) -> str:
    """Word for all of a number of things, at the begin of a sentence."""
    return "Both" if number == 2 else "All"
