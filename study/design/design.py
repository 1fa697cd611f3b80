"""The design of a study: which triangulations it is made of."""

import tomllib
from collections.abc import Collection
from importlib import resources
from importlib.resources.abc import Traversable
from pathlib import Path
from typing import Annotated, Any, Self

from pydantic import (
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    StrictFloat,
    StrictInt,
    ValidationError,
    field_validator,
)
from pydantic_core import ErrorDetails

from lepp import METHODS, InputError
from study.design.sampling import DISTRIBUTIONS

MIN_POINTS = 3
#: A triangulation of n points makes up to 4 n edges, whose sides are numbered by 32-bit integers.
MAX_POINTS = (2**31 - 1) // 8
#: More rows than this do not belong into one directory (a row and its histograms take 1 to 2 kB).
MAX_TRIANGULATIONS = 1_000_000
#: The largest whole number that a TOML file can hold.
MAX_SEED = 2**63 - 1

DEFAULT_SEED = 2022

_ALLOWED = {
    "methods": f"a list with one or more of {', '.join(METHODS)}",
    "distributions": f"a list with one or more of {', '.join(DISTRIBUTIONS)}",
    "sizes": (
        f"a list of whole numbers of points from {MIN_POINTS} to {MAX_POINTS:,}, or a range "
        "such as { first = 10000, last = 200000, step = 10000 }"
    ),
    "repetitions": f"a whole number from 1 to {MAX_TRIANGULATIONS:,}",
    "seed": f"a whole number from 0 to {MAX_SEED}",
    "correlation": "a number between -1 and 1, both excluded",
}


def _known(names: Collection[str]) -> BeforeValidator:
    def check(name: object) -> object:
        if not isinstance(name, str) or name not in names:
            raise ValueError(name)
        return name

    return BeforeValidator(check)


class Design(BaseModel):
    """Which triangulations a study is made of.

    Attributes
    ----------
    methods : tuple of str
        Methods of triangulation, of `lepp.METHODS`; kept in that order.
    distributions : tuple of str
        Distributions of the points, of `study.design.sampling.DISTRIBUTIONS`; kept in that order.
    sizes : tuple of int
        Numbers of points, ascending. A table ``{first, last, step}`` stands for a range.
    repetitions : int
        Point sets for each distribution and size.
    seed : int
        Seed of all point sets.
    correlation : float
        Correlation of x and y of the bivariate normal distribution.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)

    methods: tuple[Annotated[str, _known(METHODS)], ...] = Field(("incremental",), min_length=1)
    distributions: tuple[Annotated[str, _known(DISTRIBUTIONS)], ...] = Field(
        DISTRIBUTIONS, min_length=1
    )
    sizes: tuple[Annotated[StrictInt, Field(ge=MIN_POINTS, le=MAX_POINTS)], ...] = Field(
        min_length=1
    )
    repetitions: StrictInt = Field(ge=1, le=MAX_TRIANGULATIONS)
    seed: StrictInt = Field(DEFAULT_SEED, ge=0, le=MAX_SEED)
    correlation: StrictFloat = Field(0.5, gt=-1, lt=1, allow_inf_nan=False)

    @field_validator("sizes", mode="before")
    @classmethod
    def _expand_range(cls, sizes: object) -> object:
        if not isinstance(sizes, dict):
            return sizes
        numbers = list(sizes.values())
        if set(sizes) != {"first", "last", "step"} or any(type(n) is not int for n in numbers):
            raise ValueError(sizes)
        first, last, step = sizes["first"], sizes["last"], sizes["step"]
        if not (MIN_POINTS <= first <= last <= MAX_POINTS and step > 0):
            raise ValueError(sizes)
        if (last - first) // step >= MAX_TRIANGULATIONS:
            raise ValueError(sizes)
        return list(range(first, last + 1, step))

    # One order for every way of writing a design: equal designs have equal results, byte for byte.
    @field_validator("methods")
    @classmethod
    def _order_methods(cls, methods: tuple[str, ...]) -> tuple[str, ...]:
        return tuple(name for name in METHODS if name in methods)

    @field_validator("distributions")
    @classmethod
    def _order_distributions(cls, distributions: tuple[str, ...]) -> tuple[str, ...]:
        return tuple(name for name in DISTRIBUTIONS if name in distributions)

    @field_validator("sizes")
    @classmethod
    def _order_sizes(cls, sizes: tuple[int, ...]) -> tuple[int, ...]:
        return tuple(sorted(set(sizes)))

    @property
    def n_triangulations(self) -> int:
        """Number of triangulations."""
        groups = len(self.methods) * len(self.distributions) * len(self.sizes)
        return groups * self.repetitions

    @property
    def n_points(self) -> int:
        """Number of points of all triangulations together."""
        groups = len(self.methods) * len(self.distributions)
        return groups * self.repetitions * sum(self.sizes)

    @classmethod
    def from_settings(cls, settings: dict[str, Any], where: str = "The design") -> Self:
        """Check settings and make a design of them.

        Parameters
        ----------
        settings : dict
            The settings by name.
        where : str
            What the settings come from; begins the sentence of an error.

        Raises
        ------
        InputError
            If a setting is unknown, missing or not allowed, or if the design is too large.
        """
        try:
            design = cls(**settings)
        except ValidationError as error:
            raise InputError(_sentence(where, error.errors()[0])) from None
        if design.n_triangulations > MAX_TRIANGULATIONS:
            raise InputError(
                f"{where} has {design.n_triangulations:,} triangulations, more than the "
                f"{MAX_TRIANGULATIONS:,} that one results directory holds: divide it into several "
                "designs."
            )
        return design

    @classmethod
    def from_toml(cls, path: Path) -> Self:
        """Read a design from a TOML file; raise `InputError` if it cannot be read or is wrong."""
        return cls._from_text(path, path.name)

    @classmethod
    def from_preset(cls, name: str) -> Self:
        """Return a design that comes with the package, by its name."""
        if name not in preset_names():
            raise InputError(
                f"There is no preset {name!r}; the presets are {', '.join(preset_names())}."
            )
        with resources.as_file(_presets() / f"{name}.toml") as path:
            return cls._from_text(path, f"The preset {name}")

    @classmethod
    def _from_text(cls, path: Path, where: str) -> Self:
        try:
            settings = tomllib.loads(path.read_text(encoding="utf-8"))
        except OSError as error:
            raise InputError(f"Cannot read the design {path}: {error.strerror}.") from None
        except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
            raise InputError(f"{path} is not a TOML file: {error}.") from None
        return cls.from_settings(settings, where)

    def with_seed(self, seed: int) -> Self:
        """Return the same design with another seed."""
        return type(self).from_settings(self.model_dump() | {"seed": seed})

    def difference(self, other: "Design") -> str | None:
        """Say how another design differs from this one.

        Returns
        -------
        difference : str or None
            The first setting that differs, with its value in this and in the other design; None
            if the designs are equal.
        """
        for name in type(self).model_fields:
            mine, others = getattr(self, name), getattr(other, name)
            if mine != others:
                return f"{name} is {_in_words(mine)} there and {_in_words(others)} here"
        return None


def _presets() -> Traversable:
    return resources.files("study.design") / "presets"


def preset_names() -> list[str]:
    """Return the names of the designs that come with the package."""
    return sorted(
        entry.name.removesuffix(".toml")
        for entry in _presets().iterdir()
        if entry.name.endswith(".toml")
    )


def _in_words(value: object) -> str:
    if isinstance(value, tuple):
        if len(value) > 8:
            return f"{', '.join(map(str, value[:3]))}, ..., {value[-1]} ({len(value)} values)"
        return ", ".join(map(str, value))
    return str(value)


def _sentence(where: str, error: ErrorDetails) -> str:
    """Say what pydantic found wrong: the setting, its value, and what is allowed."""
    name = str(error["loc"][0])
    if error["type"] == "extra_forbidden":
        return f"{where} has an unknown setting {name!r}; the settings are {', '.join(_ALLOWED)}."
    if error["type"] == "missing":
        return f"{where} does not set {name}: give {_ALLOWED[name]}."
    value = error["input"]
    found = f"{name} = {value!r}" if len(error["loc"]) == 1 else f"{value!r} among its {name}"
    return f"{where} has {found}, which is not allowed: give {_ALLOWED[name]}."
