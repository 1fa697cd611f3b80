"""A mesh file through meshio's reader, which runs in a process that can be stopped."""

import os
import pickle
import re
import signal
import subprocess
import sys
from pathlib import Path
from typing import Any

import lepp
from study.meshes.meshio_reader import LIMITS_PROCESSOR_TIME

# Of processor time: the slowest of meshio's readers takes a second for about a megabyte.
_SECONDS = 15.0
_BYTES_A_SECOND = 100_000
# Of the clock: a busy machine may give a reader a small part of its time.
_WAIT_TIMES = 20.0
_START_SECONDS = 60.0


def read_file(path: Path, seconds: float | None = None) -> Any:  # noqa: ANN401 - meshio has no types
    """Read a mesh file.

    Parameters
    ----------
    path : Path
        Of a format that meshio knows by its extension.
    seconds : float, optional
        Processor time that the reader may take; 15 s and 10 s a megabyte if not given. By the
        clock it may take 20 times as long, and a minute; where the system cannot limit processor
        time, no longer than this and a minute.

    Returns
    -------
    meshio.Mesh

    Raises
    ------
    lepp.InputError
        No such file, a format that is not known, a file that cannot be read, or not in that time.
    """
    _check_file(path)
    if seconds is None:
        seconds = _SECONDS + path.stat().st_size / _BYTES_A_SECOND
    wait = _START_SECONDS + seconds * (_WAIT_TIMES if LIMITS_PROCESSOR_TIME else 1.0)
    # Without the current directory on the path (-P), in which a file might be called numpy.py.
    command = [sys.executable, "-P", "-m", "study.meshes.meshio_reader", str(path), str(seconds)]
    try:
        done = subprocess.run(
            command,
            capture_output=True,
            timeout=wait,
            check=False,
            env=os.environ | {"COLUMNS": "1000"},  # what is printed is not to be wrapped
        )
    except subprocess.TimeoutExpired:
        raise _too_slow(path, f"was not done after {wait:,.0f} s") from None
    if LIMITS_PROCESSOR_TIME and done.returncode == -signal.SIGXCPU:
        raise _too_slow(path, f"was not done after {seconds:,.0f} s of processor time")
    mesh, reason = pickle.loads(done.stdout) if done.returncode == 0 else (None, "")
    if mesh is None:
        raise lepp.InputError(_unreadable(path, reason or _printed(done.stderr)))
    return mesh


def _check_file(path: Path) -> None:
    if not path.exists():
        raise lepp.InputError(f"There is no file {path}.")
    if not path.is_file():
        raise lepp.InputError(f"{path} is not a file: give a mesh file.")
    if path.stat().st_size == 0:
        raise lepp.InputError(f"{path} is empty: give a mesh file.")
    try:
        with path.open("rb"):
            pass
    except OSError as error:
        raise lepp.InputError(f"{path} cannot be read: {error.strerror}.") from None


def _too_slow(path: Path, what: str) -> lepp.InputError:
    return lepp.InputError(
        f"{path} could not be read: meshio's reader {what}, which happens on files that are cut "
        "short or of another format than their name says; --read-limit SECONDS gives it longer."
    )


def _unreadable(path: Path, reason: str) -> str:
    if "deduce file format" in reason:
        from meshio import extension_to_filetypes

        return (
            f"{path} does not say by its name which format it has: the extensions known are "
            f"{', '.join(sorted(extension_to_filetypes))}."
        )
    reason = " ".join(reason.split())
    because = f" ({reason[:200].rstrip('.')})" if reason else ""
    return (
        f"{path} could not be read as a {path.suffix} file{because}: it may be cut short, damaged, "
        "or of a variant that meshio does not read; save it again, or in another format."
    )


def _printed(stderr: bytes) -> str:
    """Return what a reader printed before it gave up, in a few words."""
    text = re.sub(r"\x1b\[[0-9;]*m", "", stderr.decode(errors="replace"))
    lines = [line for line in text.splitlines() if line.strip() and "Couldn't read" not in line]
    return lines[-1] if lines else ""
