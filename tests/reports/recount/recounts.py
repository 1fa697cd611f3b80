"""Which recount is of which sentence."""

import re
from collections.abc import Callable
from dataclasses import dataclass

from expected import Sheet
from run_data import METHODS, WORDS, Run


@dataclass(frozen=True)
class View:
    """A run, and the method and distribution that a sentence is of (``*``: of all)."""

    run: Run
    method: str
    distribution: str

    @property
    def key(self) -> tuple[Run, str, str]:
        """Where the data of the view are."""
        return self.run, self.method, self.distribution

    @property
    def sizes(self) -> list[int]:
        """Numbers of points that the method goes to."""
        return self.run.sizes_of(self.method)

    @property
    def word(self) -> str:
        """The distribution in a sentence."""
        return WORDS[self.distribution]

    @property
    def method_word(self) -> str:
        """The method in a sentence."""
        return METHODS[self.method]


Recount = Callable[[View, Sheet, int], str]
"""Writes the sentence that a view should have; the last argument counts those of its pattern."""

_RECOUNTS: list[tuple[str, re.Pattern[str], Recount]] = []


def recount(place: str, start: str = "") -> Callable[[Recount], Recount]:
    """Register the recount of the sentences of a place that start like this (a pattern)."""

    def register(function: Recount) -> Recount:
        _RECOUNTS.append((place, re.compile(start), function))
        return function

    return register


def recount_of(place: str, text: str) -> Recount | None:
    """Find the recount of a sentence."""
    for of_place, start, function in _RECOUNTS:
        if of_place == place and start.match(text):
            return function
    return None
