"""A Python process that imports what this one does."""

import os
import sys


def command(code: str, *arguments: str) -> list[str]:
    """Return the command that runs code, with arguments in its `sys.argv`.

    It does not look into the working directory, which may hold the sources of what is installed.
    """
    return [sys.executable, "-P", "-c", code, *arguments]


def environment(**more: str) -> dict[str, str]:
    """Return the environment in which modules are looked for where they are here."""
    path = os.pathsep.join(filter(None, sys.path))
    return os.environ | {"PYTHONPATH": path} | more
