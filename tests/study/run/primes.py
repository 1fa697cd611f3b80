"""A kind of task of a few lines, to see that runs know nothing of triangulations."""

from dataclasses import dataclass
from typing import ClassVar, NamedTuple

import pyarrow as pa
from pydantic import BaseModel, ConfigDict

from study.run.kinds import ERROR, Kind, Memory, Outcome, ResultTable, Size
from study.run.measures import columns_of, fields_of, measure, measured, values_of


class PrimeDesign(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)

    ranges: int
    length: int

    @classmethod
    def from_settings(cls, settings, where="The design"):
        return cls(**settings)

    def difference(self, other):
        return None if self == other else f"{self} there and {other} here"


class Range(NamedTuple):
    first: int


@dataclass(frozen=True)
class PrimeMeasures:
    n_primes: int = measure("Primes", format="int", of=len)
    largest: int = measure("Largest", format="int", of=lambda primes: max(primes, default=0))


class Primes(Kind):
    name = "primes"
    design = PrimeDesign
    task = Range
    units = ("ranges", "numbers")
    preparing = "Thinking."
    tables: ClassVar = {
        "counts": ResultTable(
            pa.schema(
                [
                    *fields_of(Range),
                    *(column.field for column in columns_of(PrimeMeasures)),
                    (ERROR, pa.string()),
                ]
            )
        ),
        "numbers": ResultTable(pa.schema([*fields_of(Range), ("prime", pa.int64())])),
    }

    def tasks_of(self, design):
        return [Range(k * design.length) for k in range(design.ranges)]

    def perform(self, task, design):
        numbers = range(max(task.first, 2), task.first + design.length)
        primes = [n for n in numbers if all(n % d for d in range(2, n))]
        counts = [(*values_of(measured(PrimeMeasures, primes)), None)]
        return Outcome(task, {"counts": counts, "numbers": [(p,) for p in primes]}, seconds=0.001)

    def failed(self, task, design, error):
        return Outcome(task, {"counts": [(None, None, error)]}, error=error)

    def size_of(self, task, design):
        return Size(1, design.length)

    def memory_of(self, task, design):
        return Memory("A range", 8 * design.length)

    def prepare(self, design, memory):
        pass


PRIMES = Primes()
