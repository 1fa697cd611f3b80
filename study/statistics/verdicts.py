"""What a test or an interval says, in the words that tables have for it."""

from collections.abc import Iterable

YES, NO, UNDECIDED = "yes", "no", "undecided"
REJECTED, NOT_REJECTED = "rejected", "not rejected"
#: Verdict on a statement that a test could have shown, and did not: it may be true or not.
NOT_SHOWN = "not shown"


def rejected(holds: bool) -> str:
    """Verdict on a null hypothesis."""
    return REJECTED if holds else NOT_REJECTED


def yes(holds: bool) -> str:
    """Verdict on a statement that is either true or not."""
    return YES if holds else NO


def all_of(verdicts: Iterable[str]) -> str:
    """Verdict on a statement about all cases, from those on each.

    One case that surely is not so refutes it; it holds only if every case does.
    """
    seen = set(verdicts)
    if NO in seen:
        return NO
    return YES if seen == {YES} else UNDECIDED
