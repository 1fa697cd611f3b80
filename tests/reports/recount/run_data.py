"""The Parquet files of a run, and plain statistics of them: nothing of `study` is imported."""

import json
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
import pandas as pd
from scipy import special, stats

WORDS = {
    "uniform": "uniform",
    "normal": "normal",
    "bivariate_normal": "bivariate normal",
    "exponential": "exponential",
}
METHODS = {"incremental": "plain insertion", "delaunay": "Delaunay"}
WHOLE, INTERIOR = "whole", "interior"
INTERIOR_LAYER = 30

Groups = dict[int, np.ndarray]
"""Mean LEPP sizes of the triangulations, by number of points."""


def t95(df: float) -> float:
    """Quantile of Student's t for a 95 % interval."""
    return float(stats.t.ppf(0.975, df))


def mean_interval(values: np.ndarray) -> tuple[float, float, float]:
    """Mean with its t interval."""
    values = np.asarray(values, dtype=float)
    mean = float(values.mean())
    half = t95(len(values) - 1) * float(stats.sem(values))
    return mean, mean - half, mean + half


def matrix(frame: pd.DataFrame, column: str = "lepp_size") -> np.ndarray:
    """Counts of sizes 0, 1, ... (columns) of each triangulation (rows)."""
    table = frame.groupby(["n_points", "replicate", column])["count"].sum().unstack(fill_value=0)
    return table.reindex(columns=range(int(table.columns.max()) + 1), fill_value=0).to_numpy()


def log10_f_tail(f: float, d1: float, d2: float) -> float:
    """Logarithm of the upper tail of F, however small: the series of the incomplete beta."""
    if f <= 0:
        return 0.0
    x, a, b = d2 / (d2 + d1 * f), d2 / 2, d1 / 2
    if (p := special.betainc(a, b, x)) > 1e-200:
        return float(np.log10(p))
    term = total = 1.0
    for k in range(100_000):
        term *= (a + b + k) / (a + 1 + k) * x
        total += term
        if term < 1e-17 * total:
            break
    log = a * np.log(x) + b * np.log1p(-x) - np.log(a) - special.betaln(a, b) + np.log(total)
    return float(log / np.log(10))


def log10_t_tail(t: float, df: float) -> float:
    """Logarithm of the upper tail of t, for t > 0."""
    return log10_f_tail(t * t, 1, df) - np.log10(2)


def log10_chi2_tail(x: float, df: float) -> float:
    """Logarithm of the upper tail of chi-squared: Legendre's continued fraction far out."""
    a, z = df / 2, x / 2
    if (p := special.gammaincc(a, z)) > 1e-200:
        return float(np.log10(p))
    fraction = 0.0
    for k in range(2000, 0, -1):
        fraction = k * (a - k) / (z + 2 * k + 1 - a + fraction)
    log = a * np.log(z) - z - special.gammaln(a) - np.log(z + 1 - a + fraction)
    return float(log / np.log(10))


def holm(p: np.ndarray) -> np.ndarray:
    """Holm's adjusted p-values."""
    order = np.argsort(p)
    adjusted = np.empty(len(p))
    adjusted[order] = np.maximum.accumulate(np.arange(len(p), 0, -1) * np.asarray(p)[order])
    return np.minimum(adjusted, 1.0)


def best_repeated(triangulations: dict[int, int]) -> int:
    """The largest size with 16 triangulations, else with two, else of all."""
    enough = [n for n, number in triangulations.items() if number >= 16]
    some = [n for n, number in triangulations.items() if number >= 2]
    return max(enough or some or triangulations)


@dataclass(frozen=True)
class Run:
    """The tables of one run.

    Attributes
    ----------
    directory : Path
    """

    directory: Path

    def _read(self, name: str) -> pd.DataFrame:
        return pd.read_parquet(self.directory / f"{name}.parquet")

    @cached_property
    def design(self) -> dict:
        """What was asked for."""
        return json.loads((self.directory / "manifest.json").read_text("utf-8"))["design"]

    @cached_property
    def manifest(self) -> dict:
        """What the run says of itself."""
        return json.loads((self.directory / "manifest.json").read_text("utf-8"))

    @cached_property
    def published(self) -> dict:
        """The paper's numbers, as printed."""
        for folder in Path(__file__).resolve().parents:
            path = folder / "study" / "paper" / "published.json"
            if path.exists():
                return json.loads(path.read_text("utf-8"))
        raise FileNotFoundError("study/paper/published.json")

    @cached_property
    def results(self) -> pd.DataFrame:
        """A row a triangulation that was made."""
        frame = self._read("results")
        return frame[frame["error"].isna()].sort_values(["n_points", "replicate"])

    @cached_property
    def point_sets(self) -> pd.DataFrame:
        """A row a point set."""
        return self._read("point_sets")

    @cached_property
    def _parted(self) -> dict[str, dict]:
        names = ("histograms", "layers", "regions")
        return {
            name: dict(list(self._read(name).groupby(["method", "distribution"]))) for name in names
        }

    @property
    def methods(self) -> list[str]:
        """In the order of the design."""
        return self.design["methods"]

    @property
    def distributions(self) -> list[str]:
        """In the order of the design."""
        return self.design["distributions"]

    @property
    def sizes(self) -> list[int]:
        """Numbers of points."""
        return self.design["sizes"]

    def sizes_of(self, method: str) -> list[int]:
        """Those that a method goes to."""
        last = self.design.get("largest", {}).get(method, self.sizes[-1])
        return [n for n in self.sizes if n <= last]

    def single_sizes(self, method: str) -> list[int]:
        """Those of which there is to be one triangulation, if there are to be more of others."""
        each = self.design["repetitions"]
        if not isinstance(each, list):
            return []
        return [
            n
            for n, r in zip(self.sizes, each, strict=True)
            if r == 1 and n in self.sizes_of(method)
        ]

    @property
    def sizes_of_all(self) -> list[int]:
        """Those that every method goes to."""
        return min((self.sizes_of(method) for method in self.methods), key=len)

    def rows(self, method: str, distribution: str, n: int | None = None) -> pd.DataFrame:
        """Triangulations of one view, of one size if it is given."""
        frame = self.results
        frame = frame[(frame["method"] == method) & (frame["distribution"] == distribution)]
        return frame if n is None else frame[frame["n_points"] == n]

    def counts(self, name: str, method: str, distribution: str) -> pd.DataFrame:
        """Rows of histograms, layers or regions of one view."""
        return self._parted[name][method, distribution]

    def groups(self, method: str, distribution: str, part: str = WHOLE) -> Groups:
        """Means by size, where there are two or more: one has no spread."""
        groups = self.all_groups(method, distribution, part)
        return {n: means for n, means in groups.items() if len(means) > 1}

    def all_groups(self, method: str, distribution: str, part: str = WHOLE) -> Groups:
        """Means by size, of whole meshes or of their interiors."""
        if part == WHOLE:
            frame = self.rows(method, distribution)
            return {int(n): g.to_numpy() for n, g in frame.groupby("n_points")["mean_lepp"]}
        frame = self.counts("layers", method, distribution)
        frame = frame[frame["layer"] == INTERIOR_LAYER]
        frame = frame.assign(total=frame["lepp_size"] * frame["count"])
        sums = frame.groupby(["n_points", "replicate"])[["total", "count"]].sum()
        means = sums["total"] / sums["count"]
        return {int(n): g.to_numpy() for n, g in means.groupby("n_points")}

    def layered_size(self, method: str, distribution: str) -> int:
        """The size that the layers are told of."""
        frame = self.counts("layers", method, distribution)
        return best_repeated(frame.groupby("n_points")["replicate"].nunique().to_dict())

    def histogram(self, method: str, distribution: str, part: str = WHOLE) -> pd.DataFrame:
        """Counts of LEPP sizes of each triangulation."""
        if part == WHOLE:
            return self.counts("histograms", method, distribution)
        frame = self.counts("layers", method, distribution)
        return frame[frame["layer"] == INTERIOR_LAYER]


def theorem_1(p: float) -> dict[str, float]:
    """Moments of the geometric law of sizes from 2 on."""
    q = 1 - p
    return {
        "mean": (p + 1) / p,
        "standard deviation": q**0.5 / p,
        "skewness": (2 - p) / q**0.5,
        "excess kurtosis": (p * p - 6 * p + 6) / q,
    }
