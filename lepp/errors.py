"""What callers can get wrong."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from enum import Enum

import numpy as np


class InputError(ValueError):
    """An input that cannot be used; the message says what is wrong and what to do."""


class Remedy(Enum):
    """What to do about a problem of a mesh; the value says so to one who calls from Python."""

    CORRECT_INDICES = "number the points from 0, in the order in which they are given"
    GIVE_COORDINATES = "give them finite ones, or leave out the triangles that use them"
    SPLIT_QUADS = "give split_quads=True to split each into two triangles"
    IGNORE_VOLUMES = (
        "only triangles in the plane or on a surface are taken; give ignore_volumes=True to take "
        "the triangles that the mesh also has"
    )
    EXTRACT_SURFACE = (
        "only triangles in the plane or on a surface are taken; extract the surface of the volume "
        "first"
    )
    TRIANGULATE = "triangulate them first"
    REPAIR_QUADS = "they cross themselves, are flat or have a corner twice; repair or remove them"
    MERGE_OR_KEEP = 'give repeated_points="merge" to join them, or "keep" if the mesh is cut there'
    MERGE_AND_LEAVE_OUT = 'leave them out, and give repeated_points="merge" to join the points'
    LEAVE_OUT = "leave them out"
    MOVE_VERTEX = (
        "move a vertex; leaving them out would cut the mesh, as their neighbours on the long side "
        "and on the two short sides do not meet"
    )
    SPLIT_EDGES = "take triangles away until each edge has at most two, or split the mesh there"
    MOVE_BACK = "move their vertices back"
    UNFOLD = "unfold the mesh there"


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
    remedy : Remedy
        What to do about it.
    """

    kind: str
    ids: np.ndarray
    what: str
    remedy: Remedy

    def __str__(self) -> str:
        return f"{self.what}: {self.remedy.value}."


class MeshError(InputError):
    """A mesh on which no path can be trusted.

    Attributes
    ----------
    problems : tuple of MeshProblem
        All that were found, not just the first.
    """

    def __init__(self, problems: Sequence[MeshProblem]) -> None:
        self.problems = tuple(problems)
        super().__init__(self.worded(lambda remedy: remedy.value))

    def worded(self, words: Callable[[Remedy], str]) -> str:
        """Return a sentence a problem, a line each, with the remedies in some words."""
        sentences = [f"{problem.what}: {words(problem.remedy)}." for problem in self.problems]
        if len(sentences) > 1:
            sentences.insert(0, f"The mesh has {len(sentences)} problems.")
        return "\n".join(sentences)


def listed(ids: np.ndarray, most: int = 5) -> str:
    """Return the first few of some indices, and how many there are."""
    first = ", ".join(str(i) for i in ids[:most])
    return first if len(ids) <= most else f"{first}, … ({len(ids)} in all)"
