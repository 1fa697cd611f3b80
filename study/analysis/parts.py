"""Parts of a mesh: the whole, and the interior, which the edge does not reach."""

import pandas as pd

from lepp import INTERIOR_LAYER
from study.analysis.table import Column
from study.statistics.thresholds import LEVEL

WHOLE, INTERIOR = "whole", "interior"
PARTS = (WHOLE, INTERIOR)
PART = Column("part", "Part of the mesh")
#: Ends of an interval of a mean, or of a difference of means.
INTERVAL = (
    Column("low", f"{LEVEL} from", "triangles", "fixed4"),
    Column("high", f"{LEVEL} to", "triangles", "fixed4"),
)

#: What the interior is, for the note of a table.
INTERIOR_NOTE = (
    f"The interior is all triangles that are {INTERIOR_LAYER} or more steps across edges away from "
    "a triangle at the hull."
)


def interior_shares(by_layer: pd.DataFrame) -> pd.Series:
    """Share of all triangles of each number of points that the interior has.

    Parameters
    ----------
    by_layer : pandas.DataFrame
        n_points, layer, count.

    Returns
    -------
    pandas.Series
        By n_points; NaN where no mesh has an interior.
    """
    inside = by_layer[by_layer["layer"] == INTERIOR_LAYER]
    return inside.groupby("n_points")["count"].sum() / by_layer.groupby("n_points")["count"].sum()
