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
    model_validator,
)
from pydantic_core import ErrorDetails, PydanticCustomError

from lepp import METHODS, InputError
from lepp.mesh.triangulation import MAX_POINTS as MESH_MAX_POINTS
from study.design.sampling import DISTRIBUTIONS

MIN_POINTS = 3
#: Plain insertion in tiles has no limit of its own; this is some days of work.
MAX_POINTS = 10**10
#: More rows than this do not belong into one directory (a row and its histograms take 1 to 2 kB).
MAX_TRIANGULATIONS = 1_000_000
#: The largest whole number that a TOML file can hold.
MAX_SEED = 2**63 - 1

DEFAULT_SEED = 2022

#: The error of a list of repetitions that is longer or shorter than that of the sizes.
_ONE_A_SIZE = "one_a_size"
#: The error of a size that a method cannot do, as it has the whole mesh in memory.
_IN_MEMORY = "in_memory"
#: The error of a method that stops at no size, or when none goes to the last.
_STOPS = "stops"
#: The methods that can do without.
IN_TILES = ("incremental",)

_ALLOWED = {
    "methods": f"a list with one or more of {', '.join(METHODS)}",
    "distributions": f"a list with one or more of {', '.join(DISTRIBUTIONS)}",
    "sizes": (
        f"a list of whole numbers of points from {MIN_POINTS} to {MAX_POINTS:,}, or a range "
        "such as { first = 10000, last = 200000, step = 10000 }"
    ),
    "repetitions": (
        f"a whole number from 1 to {MAX_TRIANGULATIONS:,}, or a list with one for each of the "
        "sizes, none of which is there twice"
    ),
    "largest": (
        "a table with the size at which a method stops before the others, such as "
        "{ delaunay = 10000000 }; one method has to go to the last"
    ),
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
    repetitions : int or tuple of int
        Point sets for each distribution and size: the same number for all sizes, or one a size.
    largest : dict of str to int
        The size at which a method stops; those that are not there do all sizes.
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
    repetitions: int | tuple[int, ...]
    largest: dict[Annotated[str, _known(METHODS)], StrictInt] = Field(default_factory=dict)
    seed: StrictInt = Field(DEFAULT_SEED, ge=0, le=MAX_SEED)
    correlation: StrictFloat = Field(0.5, gt=-1, lt=1, allow_inf_nan=False)

    @model_validator(mode="before")
    @classmethod
    def _order_repetitions(cls, settings: dict[str, Any]) -> dict[str, Any]:
        """Bring repetitions, where there is one a size, into the order of the sizes."""
        repetitions = settings.get("repetitions")
        if not isinstance(repetitions, list | tuple):
            return settings
        try:
            sizes = _expanded(settings.get("sizes"))
            pairs = sorted(zip(sizes, repetitions, strict=True))
            if len(dict(pairs)) < len(pairs):
                raise ValueError(sizes)
        except (TypeError, ValueError):
            return settings  # what is wrong with it, the fields' own checks say
        each = tuple(one for _, one in pairs)
        alike = all(type(one) is int for one in each) and len(set(each)) == 1
        return settings | {"repetitions": each[0] if alike else list(each)}

    @field_validator("repetitions", mode="before")
    @classmethod
    def _check_repetitions(cls, repetitions: object) -> object:
        each = repetitions if isinstance(repetitions, list | tuple) else (repetitions,)
        if not each or any(type(n) is not int or not 1 <= n <= MAX_TRIANGULATIONS for n in each):
            raise ValueError(repetitions)
        return repetitions

    @model_validator(mode="after")
    def _check_one_a_size(self) -> Self:
        if isinstance(self.repetitions, tuple) and len(self.repetitions) != len(self.sizes):
            raise PydanticCustomError(_ONE_A_SIZE, "repetitions")
        return self

    @model_validator(mode="after")
    def _check_largest(self) -> Self:
        stops_before_the_last = set(self.largest.values()) <= set(self.sizes[:-1])
        if not (stops_before_the_last and set(self.largest) < set(self.methods)):
            raise PydanticCustomError(_STOPS, "largest")
        return self

    @model_validator(mode="after")
    def _check_in_memory(self) -> Self:
        in_memory = [method for method in self.methods if method not in IN_TILES]
        largest = max((self.sizes_of(method)[-1] for method in in_memory), default=0)
        if largest > MESH_MAX_POINTS:
            raise PydanticCustomError(_IN_MEMORY, "sizes", {"size": largest})
        return self

    @field_validator("sizes", mode="before")
    @classmethod
    def _expand_range(cls, sizes: object) -> object:
        return _expanded(sizes)

    # One order for every way of writing a design: equal designs have equal results, byte for byte.
    @field_validator("methods")
    @classmethod
    def _order_methods(cls, methods: tuple[str, ...]) -> tuple[str, ...]:
        return tuple(name for name in METHODS if name in methods)

    @field_validator("largest")
    @classmethod
    def _order_largest(cls, largest: dict[str, int]) -> dict[str, int]:
        return {name: largest[name] for name in METHODS if name in largest}

    @field_validator("distributions")
    @classmethod
    def _order_distributions(cls, distributions: tuple[str, ...]) -> tuple[str, ...]:
        return tuple(name for name in DISTRIBUTIONS if name in distributions)

    @field_validator("sizes")
    @classmethod
    def _order_sizes(cls, sizes: tuple[int, ...]) -> tuple[int, ...]:
        return tuple(sorted(set(sizes)))

    @property
    def repetitions_by_size(self) -> dict[int, int]:
        """Point sets of each distribution, by size."""
        if isinstance(self.repetitions, tuple):
            return dict(zip(self.sizes, self.repetitions, strict=True))
        return dict.fromkeys(self.sizes, self.repetitions)

    def methods_of(self, n_points: int) -> tuple[str, ...]:
        """Return the methods that triangulate point sets of a size."""
        return tuple(m for m in self.methods if n_points <= self.largest.get(m, n_points))

    def sizes_of(self, method: str) -> tuple[int, ...]:
        """Return the numbers of points that a method triangulates, ascending."""
        return tuple(size for size in self.sizes if method in self.methods_of(size))

    def single_sizes_of(self, method: str) -> tuple[int, ...]:
        """Return the sizes with one triangulation, where it has more of others: no spread is had.

        A design with one of each size is not meant so, and has none.
        """
        sizes = self.sizes_of(method)
        single = tuple(size for size in sizes if self.repetitions_by_size[size] == 1)
        return single if len(single) < len(sizes) else ()

    @property
    def largest_of_all(self) -> int:
        """The largest number of points that every method triangulates."""
        return min(self.sizes_of(method)[-1] for method in self.methods)

    @property
    def _triangulations_by_size(self) -> dict[int, int]:
        sets = self.repetitions_by_size.items()
        return {n: len(self.distributions) * len(self.methods_of(n)) * each for n, each in sets}

    @property
    def n_triangulations(self) -> int:
        """Number of triangulations."""
        return sum(self._triangulations_by_size.values())

    @property
    def n_points(self) -> int:
        """Number of points of all triangulations together."""
        return sum(size * number for size, number in self._triangulations_by_size.items())

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

    def contains(self, other: "Design") -> bool:
        """Tell whether every point set of another design is here, by the same methods."""
        sets = self.repetitions_by_size
        return (
            (self.seed, self.correlation) == (other.seed, other.correlation)
            and set(other.distributions) <= set(self.distributions)
            and all(
                number <= sets.get(size, 0) and self.methods_of(size) == other.methods_of(size)
                for size, number in other.repetitions_by_size.items()
            )
        )

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


def _expanded(sizes: object) -> Any:  # noqa: ANN401 - whatever a file has in its place
    """Return the sizes that a table ``{first, last, step}`` stands for; else what is given."""
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


def _in_words(value: object) -> str:
    if isinstance(value, tuple):
        if len(value) > 8:
            return f"{', '.join(map(str, value[:3]))}, ..., {value[-1]} ({len(value)} values)"
        return ", ".join(map(str, value))
    if isinstance(value, dict):
        return ", ".join(f"{name} {one}" for name, one in value.items()) or "not set"
    return str(value)


def _sentence(where: str, error: ErrorDetails) -> str:
    """Say what pydantic found wrong: the setting, its value, and what is allowed."""
    if error["type"] == _ONE_A_SIZE:
        return (
            f"{where} does not have one number among its repetitions for each of its sizes: give "
            "one for all sizes, or a list as long as theirs, with no size twice."
        )
    if error["type"] == _IN_MEMORY:
        return (
            f"{where} has {error['ctx']['size']:,} points among its sizes, but a mesh in memory "
            f"has at most {MESH_MAX_POINTS:,}: only {', '.join(IN_TILES)} goes without. Let the "
            "others stop before, as in largest = { delaunay = 10000000 }."
        )
    if error["type"] == _STOPS:
        return (
            f"{where} has among its largest a method that stops at none of its sizes but the last, "
            f"or is none of its methods, or all stop: give {_ALLOWED['largest']}."
        )
    name = str(error["loc"][0])
    if error["type"] == "extra_forbidden":
        return f"{where} has an unknown setting {name!r}; the settings are {', '.join(_ALLOWED)}."
    if error["type"] == "missing":
        return f"{where} does not set {name}: give {_ALLOWED[name]}."
    value = error["input"]
    found = f"{name} = {value!r}" if len(error["loc"]) == 1 else f"{value!r} among its {name}"
    return f"{where} has {found}, which is not allowed: give {_ALLOWED[name]}."
