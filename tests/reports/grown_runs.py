"""Made runs of many sizes, whose means follow a curve, in the whole mesh and in the interior."""

from collections.abc import Callable
from functools import cache

import numpy as np
import pandas as pd
from frames import design, frames
from page_text import PageText, page_text

from lepp import INTERIOR_LAYER
from study.results.store import Results
from study.run.triangulations import TRIANGULATIONS

Curve = Callable[[np.ndarray], np.ndarray]

SIZES = (10_000, 20_000, 50_000, 100_000, 200_000, 500_000, 1_000_000, 2_000_000)
_SMALL = tuple(range(200, 1000, 100))
_TRIANGLES = 10_000_000

CURVES: dict[str, Curve] = {
    "saturating": lambda x: 3.09 - 0.1 * x**-0.3,
    "logarithmic": lambda x: 3 + 0.005 * np.log(x),
    "falling": lambda x: 3.6 - 0.005 * np.log(x),
    "thickening": lambda x: 3.4765 + (0.2 + 0.05 * np.log(x)) * x**-0.5,
    "level": lambda x: 3.4765 + 0 * x,
    "off": lambda x: 3.4965 + 0 * x,
    "halfway": lambda x: 3 + 0.0025 * np.log(x),
    "wave": lambda x: 3 + 0.03 * np.sin(2 * np.log(x)),
    "slow": lambda x: 2.9 + 0.06 * np.log(np.log(1000 * x)),
}


def results(
    whole: str,
    interior: str,
    *,
    spread: float = 0.3,
    apart: float = 0.0,
    edge: tuple[int, int, int] = (5, 20, 30),
) -> Results:
    """Results of two distributions.

    `apart` is what the exponential points have more in the interior. The edge has the layers 0 and
    one more, with the size and number of long paths: (layer, size, paths).
    """
    small = design(distributions=("uniform", "exponential"), sizes=_SMALL, repetitions=12)
    asked = design(distributions=("uniform", "exponential"), sizes=SIZES, repetitions=12)
    larger = dict(zip(small.sizes, SIZES, strict=True))
    names = ("results", "histograms", "regions", "layers", "point_sets")
    made = {
        name: frame.assign(n_points=frame["n_points"].map(larger))
        for name, frame in zip(names, frames(small), strict=True)
    }
    rows = made["results"]
    n = rows["n_points"].to_numpy(float)
    noise = np.random.default_rng(5).normal(0, spread, len(n)) * n**-0.45
    made["results"] = rows.assign(mean_lepp=CURVES[whole](n / 1000) + noise)
    inside = CURVES[interior](n / 1000) + noise + apart * (rows["distribution"] == "exponential")
    made["layers"] = _layers(rows, inside, edge)
    manifest = {"complete": True, "environments": []}
    return Results(made, manifest, TRIANGULATIONS, asked, True)


def _layers(rows: pd.DataFrame, inside: pd.Series, edge: tuple[int, int, int]) -> pd.DataFrame:
    key = rows[["method", "distribution", "n_points", "replicate"]]
    fours = ((inside - 3) * _TRIANGLES).round().astype(int)
    layer, size, paths = edge
    parts = [
        (0, 1, 1000 + rows["replicate"]),
        (layer, size, paths + 0 * rows["replicate"]),
        (layer, 4, 2000 + rows["replicate"]),
        (INTERIOR_LAYER, 3, _TRIANGLES - fours),
        (INTERIOR_LAYER, 4, fours),
    ]
    return pd.concat(
        [key.assign(layer=k, lepp_size=s, count=count) for k, s, count in parts],
        ignore_index=True,
    )


@cache
def grown(whole: str, interior: str, **settings: object) -> PageText:
    """What the report of such results says."""
    return page_text(results(whole, interior, **settings))  # type: ignore[arg-type]
