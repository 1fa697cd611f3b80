"""How tables are built: a builder a family of tables, each with the tables that it needs."""

from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, field
from graphlib import TopologicalSorter

import pandas as pd

from study.analysis.measurements import Measurements
from study.analysis.table import (
    DISTRIBUTION,
    METHOD,
    Column,
    Declaration,
    Row,
    Table,
    Tables,
    UnknownNameError,
)
from study.statistics.groups import Groups, NotEnough


@dataclass(frozen=True)
class Missing:
    """A statistic that could not be computed, and why."""

    method: str
    distribution: str
    what: str
    why: str


MISSING = Declaration(
    "missing",
    "What could not be computed",
    (METHOD, DISTRIBUTION, Column("what", "Not computed"), Column("why", "Why")),
)


@dataclass(frozen=True)
class Study:
    """What a builder is given.

    Attributes
    ----------
    data : Measurements
    tables : Tables
        Those that the builder needs, and no others.
    missing : list of Missing
        What could not be computed; the builder adds to it.
    """

    data: Measurements
    tables: Tables = field(default_factory=Tables)
    missing: list[Missing] = field(default_factory=list)

    def lacks(self, method: str, distribution: str, what: str, why: str) -> None:
        """Say that a statistic could not be computed."""
        self.missing.append(Missing(method, distribution, what, why))


@dataclass(frozen=True)
class Population:
    """One method and distribution of a study, for a statistic of the name `what`."""

    study: Study
    method: str
    distribution: str
    what: str

    @property
    def data(self) -> Measurements:
        """All that the run has measured."""
        return self.study.data

    @property
    def key(self) -> Row:
        """The columns and values that pick its rows from a frame."""
        return {"method": self.method, "distribution": self.distribution}

    @property
    def triangulations(self) -> pd.DataFrame:
        """The triangulations that succeeded, a row each."""
        return self.data.triangulations(self.method, self.distribution)

    @property
    def groups(self) -> Groups:
        """Their mean LEPP sizes by number of points."""
        return self.data.groups(self.method, self.distribution)

    def by_size(self) -> Iterable[tuple[int, pd.DataFrame]]:
        """Give the triangulations of each number of points.

        Raises
        ------
        NotEnough
            If there is none at all.
        """
        if self.triangulations.empty:
            raise NotEnough("no triangulation has succeeded")
        for size, group in self.triangulations.groupby("n_points", sort=True):
            yield int(size), group

    def lacks(self, why: str) -> None:
        """Say that a row cannot be had; the others can. For all of them, raise NotEnough."""
        self.study.lacks(self.method, self.distribution, self.what, why)


@dataclass(frozen=True)
class Builder:
    """Makes a family of tables.

    Attributes
    ----------
    makes : tuple of Declaration
        The tables.
    needs : tuple of Declaration
        The tables that they are made from, beside what the run has measured.
    make : callable
        Takes a `Study`, yields the tables.
    """

    makes: tuple[Declaration, ...]
    needs: tuple[Declaration, ...]
    make: Callable[[Study], Iterable[Table]]


RowsOfStudy = Callable[[Study], Iterable[Row]]
RowsOfPopulation = Callable[[Population], Iterable[Row]]
Values = Callable[[Measurements], Mapping[str, object]]


def builds(
    *makes: Declaration, needs: tuple[Declaration, ...] = ()
) -> Callable[[Callable[[Study], Iterable[Table]]], Builder]:
    """Make a builder of a generator of tables."""
    return lambda make: Builder(makes, needs, make)


def rows_of(
    made: Declaration, needs: tuple[Declaration, ...] = ()
) -> Callable[[RowsOfStudy], Builder]:
    """Make a builder of a generator of one table's rows."""

    def decorate(rows: RowsOfStudy) -> Builder:
        return Builder((made,), needs, lambda study: [made.table(rows(study))])

    return decorate


def rows_by_population(
    made: Declaration, what: str, note: Values | None = None
) -> Callable[[RowsOfPopulation], Builder]:
    """Make a builder of a generator of one table's rows for a method and distribution.

    Parameters
    ----------
    made : Declaration
        With the columns method and distribution, which the generator leaves out.
    what : str
        Name of the statistic, for what is missing. The generator calls `Population.lacks` for a row
        that cannot be had, and raises NotEnough when none (or no more) can.
    note : callable, optional
        Takes the measurements and returns what fills the note's fields.
    """

    def decorate(rows: RowsOfPopulation) -> Builder:
        def make(study: Study) -> Iterable[Table]:
            made_rows: list[Row] = []
            for method, distribution in study.data.populations:
                population = Population(study, method, distribution, what)
                try:
                    for row in rows(population):
                        made_rows.append(population.key | row)
                except NotEnough as lack:
                    population.lacks(str(lack))
            yield made.table(made_rows, **(note(study.data) if note else {}))

        return Builder((made,), (), make)

    return decorate


class BuiltTables(Tables):
    """The tables of a study, each made when it is first asked for, after those that it needs.

    Parameters
    ----------
    builders : iterable of Builder
        In the order in which their tables come, and what is missing is told.
    data : Measurements

    Raises
    ------
    ValueError
        If two builders make a table of one name; later, if one does not make what it declares.
    UnknownNameError
        If a table that is needed is built by none.
    graphlib.CycleError
        If tables need one another.
    """

    def __init__(self, builders: Iterable[Builder], data: Measurements) -> None:
        super().__init__()
        self._builders = (*builders, Builder((MISSING,), (), self._make_missing))
        self._data = data
        self._lacks: dict[int, list[Missing]] = {}
        self._maker = _makers(self._builders)

    def __getitem__(self, name: str) -> Table:
        if name in self._maker and self._maker[name] not in self._lacks:
            self._make(self._maker[name])
        return super().__getitem__(name)

    def __iter__(self) -> Iterator[str]:
        return iter(self._maker)

    def __len__(self) -> int:
        return len(self._maker)

    def __reduce__(self) -> tuple[type[Tables], tuple[list[Table]]]:
        return Tables, (list(self.values()),)  # what is left to make cannot be pickled

    def _make(self, place: int) -> None:
        one = self._builders[place]
        study = Study(self._data, self.only(one.needs))
        made = list(one.make(study))
        if [table.name for table in made] != [declared.name for declared in one.makes]:
            raise ValueError(f"a builder of {[d.name for d in one.makes]} made others")
        self._tables.update((table.name, table) for table in made)
        self._lacks[place] = study.missing

    def _make_missing(self, _: Study) -> list[Table]:
        for place in range(len(self._builders) - 1):
            if place not in self._lacks:
                self._make(place)
        lacks = (lack for place in sorted(self._lacks) for lack in self._lacks[place])
        return [MISSING.table(map(asdict, lacks))]


def _makers(builders: Sequence[Builder]) -> dict[str, int]:
    """Return which builder makes each table, after a check of their needs."""
    names = Counter(made.name for one in builders for made in one.makes)
    if names.most_common(1)[0][1] > 1:
        raise ValueError(f"two builders make the table {names.most_common(1)[0][0]!r}")
    maker = {made.name: place for place, one in enumerate(builders) for made in one.makes}
    for need in (need for one in builders for need in one.needs):
        if need.name not in maker:
            raise UnknownNameError(f"no builder makes the table {need.name!r}")
    needed = {place: {maker[need.name] for need in one.needs} for place, one in enumerate(builders)}
    TopologicalSorter(needed).prepare()
    return maker
