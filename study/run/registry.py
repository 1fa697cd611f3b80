"""The kinds of task that a results directory can be of."""

from typing import Any

from study.run.kinds import Kind
from study.run.triangulations import TRIANGULATIONS

KINDS: dict[str, Kind[Any, Any]] = {kind.name: kind for kind in (TRIANGULATIONS,)}
"""By the name that manifests have."""
