"""The journal of a run: one checked line for each finished task, written as it finishes.

A line is ``{"crc32":"…","outcome":{…}}``, where the checksum is that of the text of the outcome.
A run that is killed while it writes leaves a last line without its end; reading drops it.
"""

import json
import os
from collections.abc import Iterable
from pathlib import Path
from time import monotonic
from typing import Any
from zlib import crc32

from lepp import InputError
from study.run.kinds import Kind, Outcome

#: A crash of the machine, unlike one of the run, loses what was written in this time.
SYNC_SECONDS = 1.0

_HEAD = '{{"crc32":"{:08x}","outcome":'


class Journal:
    """A journal open for writing.

    Parameters
    ----------
    path : Path
        The file; what it holds already is kept, up to the end of its last whole line.
    """

    def __init__(self, path: Path) -> None:
        # Unbuffered: after an error, nothing may be left over for a later write.
        self._file = path.open("ab", buffering=0)
        self._file.truncate(_whole_lines(path.read_bytes()))
        self._synced = monotonic()

    def append(self, outcomes: Iterable[Outcome]) -> None:
        """Write outcomes; they survive the death of this process when this returns."""
        lines = memoryview(journal_text(outcomes).encode())
        while lines:
            lines = lines[self._file.write(lines) :]
        if monotonic() - self._synced >= SYNC_SECONDS:
            os.fsync(self._file.fileno())
            self._synced = monotonic()

    def close(self) -> None:
        """Write everything to the disk and close the file."""
        os.fsync(self._file.fileno())
        self._file.close()


def journal_text(outcomes: Iterable[Outcome]) -> str:
    """Return the lines of outcomes."""
    return "".join(_line(outcome) for outcome in outcomes)


def read_journal(path: Path, kind: Kind) -> list[Outcome]:
    """Read the outcomes of a journal in the order of their writing.

    Parameters
    ----------
    path : Path
        The file.
    kind : Kind
        The kind of its tasks.

    Raises
    ------
    InputError
        If a whole line is damaged.
    """
    content = path.read_bytes()
    lines = content[: _whole_lines(content)].split(b"\n")[:-1]
    return [_outcome(line, kind, f"{path}, line {number},") for number, line in enumerate(lines, 1)]


def _whole_lines(content: bytes) -> int:
    return content.rfind(b"\n") + 1


def _line(outcome: Outcome) -> str:
    body = json.dumps(vars(outcome), separators=(",", ":"))
    return _HEAD.format(crc32(body.encode())) + body + "}\n"


def _outcome(line: bytes, kind: Kind, where: str) -> Outcome:
    head = len(_HEAD.format(0))
    body = line[head:-1]
    if line != _HEAD.format(crc32(body)).encode() + body + b"}":
        raise InputError(
            f"{where} is damaged: delete this line, and its task will be computed again."
        )
    fields: dict[str, Any] = json.loads(body)
    rows = {name: [tuple(cells) for cells in cells_of] for name, cells_of in fields["rows"].items()}
    return Outcome(**fields | {"task": kind.task(*fields["task"]), "rows": rows})
