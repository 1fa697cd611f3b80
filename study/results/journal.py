"""The journal of a run: one checked line for each finished task, written as it finishes.

A line is ``{"crc32":"…","outcome":{…}}``, where the checksum is that of the text of the outcome.
A run that is killed while it writes leaves a last line without its end; reading drops it.
"""

import json
import os
from collections.abc import Callable, Iterable, Iterator
from itertools import accumulate
from pathlib import Path
from time import monotonic
from typing import Any
from zlib import crc32

from lepp import InputError
from study.results.files import replacing
from study.run.kinds import Kind, Outcome

#: A crash of the machine, unlike one of the run, loses what was written in this time.
SYNC_SECONDS = 1.0

_CHUNK = 1 << 16

_HEAD = '{{"crc32":"{:08x}","outcome":'


class Journal:
    """A journal open for writing.

    Parameters
    ----------
    path : Path
        The file; what it holds already is kept, up to the end of its last whole line.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        # Unbuffered: after an error, nothing may be left over for a later write.
        self._file = path.open("ab", buffering=0)
        self._end = _whole_lines(path)
        self._file.truncate(self._end)
        self._synced = monotonic()

    def append(self, outcomes: Iterable[Outcome]) -> list[int]:
        """Write outcomes; they survive the death of this process when this returns.

        Returns
        -------
        list of int
            The place of each, for `outcomes_at`.
        """
        lines = [_line(outcome) for outcome in outcomes]
        content = memoryview(b"".join(lines))
        while content:
            content = content[self._file.write(content) :]
        places = list(accumulate(map(len, lines), initial=self._end))
        self._end = places.pop()
        if monotonic() - self._synced >= SYNC_SECONDS:
            os.fsync(self._file.fileno())
            self._synced = monotonic()
        return places

    def close(self) -> None:
        """Write everything to the disk and close the file."""
        os.fsync(self._file.fileno())
        self._file.close()


def write_journal(path: Path, outcomes: Iterable[Outcome]) -> None:
    """Write a whole journal anew."""
    with replacing(path) as temporary, temporary.open("wb") as file:
        file.writelines(_line(outcome) for outcome in outcomes)


def read_journal(
    path: Path, kind: Kind, damaged: Callable[[str], None] | None = None
) -> Iterator[tuple[int, Outcome]]:
    """Read the outcomes of a journal in the order of their writing.

    Parameters
    ----------
    path : Path
        The file.
    kind : Kind
        The kind of its tasks.
    damaged : callable, optional
        Hears of a damaged line, which is then left out.

    Yields
    ------
    place, outcome : int, Outcome
        The place is for `outcomes_at`.

    Raises
    ------
    InputError
        If a whole line is damaged and nobody hears of it.
    """
    place = 0
    with path.open("rb") as file:
        for number, line in enumerate(file, 1):
            if not line.endswith(b"\n"):
                return
            try:
                yield place, _outcome(line[:-1], kind, f"{path}, line {number},")
            except InputError as error:
                if damaged is None:
                    raise
                damaged(str(error))
            place += len(line)


def outcomes_at(path: Path, kind: Kind, places: Iterable[int]) -> Iterator[Outcome]:
    """Read the outcomes of a journal that begin at some places."""
    with path.open("rb") as file:
        for place in places:
            file.seek(place)
            yield _outcome(file.readline()[:-1], kind, f"{path}, byte {place},")


def _whole_lines(path: Path) -> int:
    """Return the length of a file up to the end of its last whole line."""
    with path.open("rb") as file:
        end = file.seek(0, os.SEEK_END)
        while end:
            begin = max(end - _CHUNK, 0)
            file.seek(begin)
            if (last := file.read(end - begin).rfind(b"\n")) >= 0:
                return begin + last + 1
            end = begin
    return 0


def _line(outcome: Outcome) -> bytes:
    body = json.dumps(vars(outcome), separators=(",", ":")).encode()
    return _HEAD.format(crc32(body)).encode() + body + b"}\n"


def _outcome(line: bytes, kind: Kind, where: str) -> Outcome:
    head = len(_HEAD.format(0))
    body = line[head:-1]
    if line != _HEAD.format(crc32(body)).encode() + body + b"}":
        raise InputError(
            f"{where} is damaged: delete this line, or run with --repair, and its task will be "
            "computed again."
        )
    fields: dict[str, Any] = json.loads(body)
    rows = {name: [tuple(cells) for cells in cells_of] for name, cells_of in fields["rows"].items()}
    return Outcome(**fields | {"task": kind.task(*fields["task"]), "rows": rows})
