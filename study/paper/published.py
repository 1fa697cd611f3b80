"""The published numbers, each with the table that prints it and the precision it is printed to."""

import json
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from importlib import resources
from typing import Any

#: Triangulations in each published group.
REPETITIONS = 40
#: The distribution of which the paper shows all tables; Table 6 has all four.
SHOWN = "uniform"
#: The paper's method of triangulation, of `lepp.METHODS`; every other is compared with it.
REFERENCE_METHOD = "incremental"

#: What a published number is evidence of. Only the first counts as reproduced: the second follows
#: from the means and standard deviations that the paper itself prints; the third holds in any
#: faithful run of the design; the fourth is a draw that no other run can repeat; the fifth is a
#: second number of a test whose p-value stands beside it.
INDEPENDENT, IMPLIED, BY_CONSTRUCTION, RANDOM_DRAW, SAME_TEST = (
    "independent", "implied by Table 4", "by construction", "random draw", "same test",
)  # fmt: skip

#: The quantities of Table 4.
MEAN_TRIANGLES, LARGEST_LEPP = "mean triangles", "mean largest LEPP"
MEAN_LEPP, SD_BETWEEN = "mean LEPP", "standard deviation"
QUANTITIES_OF_TABLE_4 = (MEAN_LEPP, SD_BETWEEN, MEAN_TRIANGLES, LARGEST_LEPP)


@dataclass(frozen=True)
class Number:
    """One published number.

    Attributes
    ----------
    table : int
    quantity : str
    value : float
    places : int
        Decimal places, or, with `scientific`, decimals of the mantissa.
    distribution : str
    n_points : int or None
        The group that it belongs to.
    scientific : bool
    standing : str
        What it is evidence of, see `INDEPENDENT`.
    """

    table: int
    quantity: str
    value: float
    places: int
    distribution: str = SHOWN
    n_points: int | None = None
    scientific: bool = False
    standing: str = INDEPENDENT

    @property
    def printed(self) -> str:
        """As the paper prints it."""
        return f"{self.value:.{self.places}{'e' if self.scientific else 'f'}}"

    @property
    def unit(self) -> float:
        """One unit of the last printed digit."""
        exponent = int(f"{self.value:e}".split("e")[1]) if self.scientific else 0
        return float(10.0 ** (exponent - self.places))

    @property
    def rounded_from(self) -> tuple[float, float]:
        """Least and largest value that is printed so."""
        return self.value - self.unit / 2, self.value + self.unit / 2


@dataclass(frozen=True)
class Citation:
    """How the paper is cited.

    Attributes
    ----------
    authors : tuple of str
        Given name first.
    family_names : tuple of str
        Of each author, all of them.
    title, venue : str
    year : int
    doi : str
        Without a resolver's address.
    doi_confirmed : bool
        Whether the DOI has been looked up; else it is made from the publisher's paper number and
        pages.
    """

    authors: tuple[str, ...]
    family_names: tuple[str, ...]
    title: str
    venue: str
    year: int
    doi: str
    doi_confirmed: bool


def reference_method(methods: Sequence[str]) -> str:
    """Pick the method that all others are compared with: the paper's, or the first."""
    return REFERENCE_METHOD if REFERENCE_METHOD in methods else methods[0]


@cache
def _document() -> dict[str, Any]:
    text = resources.files("study.paper").joinpath("published.json").read_text("utf-8")
    return json.loads(text)


def _citation() -> Citation:
    printed = _document()["citation"]
    return Citation(
        tuple(printed["authors"]),
        tuple(printed["family_names"]),
        printed["title"],
        printed["venue"],
        printed["year"],
        printed["doi"],
        printed["doi_confirmed"],
    )


CITATION = _citation()


def sizes() -> tuple[int, ...]:
    """Numbers of points of the published groups."""
    return tuple(row[0] * 1000 for row in _document()["table_4_uniform"]["rows"])


def table_1() -> list[Number]:
    """p-values of the runs and Kolmogorov-Smirnov tests of point sets without a stated size."""
    numbers = []
    for no, *values in _document()["table_1_uniform_runs_and_ks"]["rows"]:
        names = ("runs test, x", "runs test, y", "Kolmogorov-Smirnov, x", "Kolmogorov-Smirnov, y")
        numbers += [
            Number(1, f"p of {name}, no. {no}", value, 4, standing=RANDOM_DRAW)
            for name, value in zip(names, values, strict=True)
        ]
    return numbers


def f_test(table: int) -> tuple[int, int, Number, Number]:
    """Degrees of freedom, F and p of Levene's test (Table 2) or the ANOVA (Table 5)."""
    key = {2: "table_2_uniform_levene", 5: "table_5_uniform_anova"}[table]
    name = {2: "Levene", 5: "ANOVA"}[table]
    found = _document()[key]
    return (
        found["df_group"],
        found["df_residual"],
        Number(table, f"F, {name}", found["f"], 2, standing=IMPLIED if table == 5 else INDEPENDENT),
        Number(table, f"p, {name}", 0.0, 4, standing=BY_CONSTRUCTION),
    )


def table_3() -> list[tuple[Number, Number]]:
    """W and p of the Shapiro-Wilk test of some groups."""
    rows = _document()["table_3_uniform_shapiro_wilk"]["rows"]
    return [
        (
            Number(3, "W, Shapiro-Wilk", w, 2, n_points=_size(group), standing=SAME_TEST),
            Number(3, "p, Shapiro-Wilk", p, 2, n_points=_size(group), standing=RANDOM_DRAW),
        )
        for group, w, p in rows
    ]


def _size(group: str) -> int:
    return int(group[1:]) * 1000


def table_4() -> list[tuple[Number, Number, Number, Number]]:
    """Mean triangles, mean largest LEPP, mean LEPP and standard deviation of every group."""
    return [
        (
            Number(4, MEAN_TRIANGLES, triangles, 2, n_points=thousands * 1000),
            Number(4, LARGEST_LEPP, largest, 0, n_points=thousands * 1000),
            Number(4, MEAN_LEPP, mean, 4, n_points=thousands * 1000),
            Number(4, SD_BETWEEN, sd, 4, n_points=thousands * 1000),
        )
        for thousands, triangles, largest, mean, sd in _document()["table_4_uniform"]["rows"]
    ]


def table_6() -> list[Number]:
    """p-values of the t tests of mean < 4, for some groups of all distributions."""
    found = _document()["table_6_t_test_mean_below_4"]
    return [
        Number(
            6,
            "p, mean below 4",
            p,
            2,
            distribution,
            thousands * 1000,
            scientific=True,
            standing=IMPLIED if distribution == SHOWN else INDEPENDENT,
        )
        for thousands, *row in found["rows"]
        for distribution, p in zip(found["columns"][1:], row, strict=True)
    ]


#: Coefficients of Table 7: model, our term, the document's key, places, scientific notation.
_TERMS = (
    ("linear", "a", "intercept", 3, False),
    ("linear", "b", "x", 3, True),
    ("quadratic", "a", "intercept", 3, False),
    ("quadratic", "b", "x", 6, False),
    ("quadratic", "c", "x2", 2, True),
    ("logistic", "a", "a", 3, False),
    ("logistic", "b", "b", 6, False),
    ("logarithmic", "c", "c", 3, False),
    ("logarithmic", "d", "d", 4, False),
)


def _of_table_7(quantity: str, value: float, places: int, *, scientific: bool = False) -> Number:
    return Number(7, quantity, value, places, scientific=scientific, standing=IMPLIED)


def coefficients() -> list[tuple[str, str, Number]]:
    """Model, term and value of the coefficients of Table 7."""
    found = _document()["table_7_uniform_regressions"]
    return [
        (model, term, _of_table_7(f"{model}, {term}", found[model][key], places, scientific=e))
        for model, term, key, places, e in _TERMS
    ]


def linear_slope_as_printed() -> Number:
    """Give the slope of the linear model with the exponent that the paper prints."""
    value = _document()["table_7_uniform_regressions"]["linear"]["x_printed"]
    return _of_table_7("linear, b, as printed", value, 3, scientific=True)


def fits() -> list[tuple[str, Number, Number]]:
    """Model, adjusted R squared and p of Table 7."""
    found = _document()["table_7_uniform_regressions"]
    return [
        (
            model,
            _of_table_7(f"{model}, adjusted R²", found[model]["adj_r2"], 2),
            _of_table_7(f"{model}, p", found[model]["p"], 2, scientific=True),
        )
        for model in ("linear", "quadratic", "logistic", "logarithmic")
    ]
