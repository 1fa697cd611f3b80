"""The manifest of a results directory: its design, its environment, and whether it is complete."""

import hashlib
import json
import platform
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path
from typing import Any

from lepp import InputError
from study.results.files import write_text
from study.run.kinds import Kind
from study.run.registry import KINDS

FORMAT = 4
MANIFEST = "manifest.json"

#: Packages whose versions can change a number, or a byte, of the results or the report.
_PACKAGES = (
    "lepp-study",
    "numpy",
    "scipy",
    "numba",
    "llvmlite",
    "pandas",
    "pyarrow",
    "statsmodels",
    "dask",
    "distributed",
)


@dataclass(frozen=True)
class Manifest:
    """What a manifest says.

    Attributes
    ----------
    content : dict
        As in the file.
    kind : Kind
        The kind of the tasks.
    design : kind.design
        The design.
    text : str
        The file, as it was read.
    """

    content: dict[str, Any]
    kind: Kind
    design: Any
    text: str

    @property
    def complete(self) -> bool:
        """Whether the result files are the truth, failures and all."""
        return bool(self.content["complete"])


def environment() -> dict[str, Any]:
    """Describe what the numbers are computed with."""
    return {
        "python": platform.python_version(),
        "implementation": platform.python_implementation(),
        "system": platform.system(),
        "machine": platform.machine(),
        "packages": {name: version(name) for name in _PACKAGES},
    }


def checksum(content: dict[str, Any]) -> str:
    """Return the checksum of what a manifest says, the design among it."""
    rest = {name: value for name, value in content.items() if name != "checksum"}
    return hashlib.sha256(json.dumps(rest, sort_keys=True).encode()).hexdigest()


def write_manifest(directory: Path, content: dict[str, Any]) -> None:
    """Write the manifest of a results directory, with its checksum."""
    content = content | {"checksum": checksum(content)}
    write_text(directory / MANIFEST, json.dumps(content, indent=2) + "\n")


def read_manifest(directory: Path) -> Manifest:
    """Read the manifest of a results directory.

    Raises
    ------
    InputError
        If there is none, or it is not one that this version can read.
    """
    path = directory / MANIFEST
    try:
        text = path.read_text(encoding="utf-8")
        content = json.loads(text)
        form = content["format"]
        if form == FORMAT:
            if content["checksum"] != checksum(content):
                raise ValueError(content["checksum"])
            kind = _kind(path, content["kind"])
            design = kind.design.from_settings(content["design"], f"{path}: the design")
            return Manifest(content, kind, design, text)
    except FileNotFoundError:
        raise InputError(
            f"{directory} holds no results of lepp-study ({MANIFEST} is missing)."
        ) from None
    except OSError as error:
        raise InputError(f"Cannot read {path}: {error.strerror}.") from None
    except (ValueError, KeyError, TypeError) as error:
        if isinstance(error, InputError):
            raise
        raise InputError(
            f"{path} was cut short or edited: restore it, or run the study in a new directory."
        ) from None
    raise InputError(
        f"{path} is of format {form}, and this version of lepp-study reads format {FORMAT}: use "
        "the version that wrote it."
    )


def _kind(path: Path, name: str) -> Kind:
    if name not in KINDS:
        raise InputError(
            f"{path} is of a study of {name}, and this version of lepp-study knows "
            f"{', '.join(KINDS)}: use the version that wrote it."
        )
    return KINDS[name]
