"""What callers can get wrong."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np


class InputError(ValueError):
    """An input that cannot be used; the message says what is wrong and what to do."""


@dataclass(frozen=True, eq=False)
class MeshProblem:
    """One thing that is wrong with a mesh.

    Attributes
    ----------
    kind : str
        A word for it, such as "repeated points"; the same whatever the mesh.
    ids : (k,) int ndarray
        The points, triangles or cells concerned, ascending.
    what : str
        A clause that says what is wrong, how often, and where first.
    remedy : str
        What to do about it.
    """

    kind: str
    ids: np.ndarray
    what: str
    remedy: str

    def __str__(self) -> str:
        return f"{self.what}: {self.remedy}."


class MeshError(InputError):
    """A mesh on which no path can be trusted.

    Attributes
    ----------
    problems : tuple of MeshProblem
        All that were found, not just the first.
    """

    def __init__(self, problems: Sequence[MeshProblem]) -> None:
        self.problems = tuple(problems)
        sentences = [str(problem) for problem in self.problems]
        if len(sentences) > 1:
            sentences.insert(0, f"The mesh has {len(sentences)} problems.")
        super().__init__("\n".join(sentences))


def listed(ids: np.ndarray, most: int = 5) -> str:
    """Return the first few of some indices, and how many there are."""
    first = ", ".join(str(i) for i in ids[:most])
    return first if len(ids) <= most else f"{first}, … ({len(ids)} in all)"
