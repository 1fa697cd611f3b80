"""Writing the tables of a study of any size: in parts, with the memory of one part."""

import tempfile
from collections.abc import Iterable, Iterator
from contextlib import ExitStack
from itertools import islice, pairwise
from pathlib import Path
from typing import IO, Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from study.results.files import replacing
from study.results.schema import ranks_of, tables_of
from study.run.kinds import Kind, Outcome

#: Tasks whose rows are made at a time, and stand together in the files.
TASKS_AT_A_TIME = 5_000


class _Parts:
    """The parts of one table in a file without a name, which the system removes by itself."""

    def __init__(self, schema: pa.Schema, directory: Path, stack: ExitStack) -> None:
        self.schema = schema
        file = tempfile.TemporaryFile(dir=directory)  # noqa: SIM115 - the stack closes it
        self._file: IO[bytes] = stack.enter_context(file)
        self._writer = pa.ipc.new_file(self._file, schema)
        #: For each part the ranks of its rows that occur, and where they begin.
        self._begins: list[dict[int, tuple[int, int]]] = []

    def add(self, table: pa.Table, ranks: np.ndarray) -> None:
        """Add a part, whose rows are in the order of their ranks."""
        occurring, begins = np.unique(ranks, return_index=True)
        ends = pairwise([*begins.tolist(), len(table)])
        self._begins.append(dict(zip(occurring.tolist(), ends, strict=True)))
        batches = table.combine_chunks().to_batches() or [
            pa.RecordBatch.from_pylist([], self.schema)
        ]
        (batch,) = batches
        self._writer.write_batch(batch)

    def in_order(self) -> Iterator[pa.RecordBatch]:
        """Return the rows of all parts, those of the first rank first."""
        self._writer.close()
        self._file.flush()
        reader = pa.ipc.open_file(self._file)
        for rank in sorted({rank for begins in self._begins for rank in begins}):
            for number, begins in enumerate(self._begins):
                if rank in begins:
                    begin, end = begins[rank]
                    yield reader.get_batch(number).slice(begin, end - begin)


def write_tables(
    kind: Kind,
    design: Any,  # noqa: ANN401 - of the kind's own type
    outcomes: Iterable[Outcome],
    paths: dict[str, Path],
) -> None:
    """Write the tables of a results directory.

    Parameters
    ----------
    kind : Kind
        The kind of the tasks.
    design : kind.design
        Their design; orders the rows.
    outcomes : iterable of Outcome
        In the order of the tasks.
    paths : dict of str to Path
        A file for each of `kind.tables`.
    """
    outcomes = iter(outcomes)
    with ExitStack() as stack:
        parts = {
            name: _Parts(table.schema, paths[name].parent, stack)
            for name, table in kind.tables.items()
        }
        while some := list(islice(outcomes, TASKS_AT_A_TIME)):
            for name, table in tables_of(kind, design, some).items():
                parts[name].add(table, ranks_of(table, kind.order_of(design)))
        for name, of_table in parts.items():
            with (
                replacing(paths[name]) as path,
                pq.ParquetWriter(path, of_table.schema, compression="zstd") as writer,
            ):
                for batch in of_table.in_order():
                    writer.write_batch(batch)
