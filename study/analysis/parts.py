"""Parts of a mesh: the whole, and the interior, which the edge does not reach."""

from lepp import INTERIOR_LAYER
from study.analysis.table import Column

WHOLE, INTERIOR = "whole", "interior"
PARTS = (WHOLE, INTERIOR)
PART = Column("part", "Part of the mesh")

#: What the interior is, for the note of a table.
INTERIOR_NOTE = (
    f"The interior is all triangles that are {INTERIOR_LAYER} or more steps across edges away from "
    "a triangle at the hull."
)
