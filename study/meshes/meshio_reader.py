"""Reads one mesh file through meshio, in a process of its own.

Some of meshio's readers never end on a file that is cut short, and some print or exit: a process
can be stopped, and what it prints stays apart. ``python -m study.meshes.meshio_reader FILE
SECONDS`` writes a pickled pair to its standard output: the mesh or None, and why there is none.
The processor time that reading takes is limited to SECONDS, where the system can do so.
"""

import math
import os
import pickle
import sys
import time
from typing import Any

try:
    import resource
except ImportError:  # Windows: the process that waits has to watch the clock
    resource = None  # type: ignore[assignment] # mypy knows a module only as a module

LIMITS_PROCESSOR_TIME = resource is not None


def read(path: str) -> tuple[Any, str]:
    """Read a mesh file, whatever its reader raises.

    Parameters
    ----------
    path : str

    Returns
    -------
    mesh : meshio.Mesh or None
    reason : str
        Why there is no mesh, in a few words; empty where there is one, or meshio has printed why.
    """
    import meshio

    _mend(meshio)
    try:
        return meshio.read(path), ""
    except ModuleNotFoundError as error:
        return None, f"this format needs the package {error.name} (pip install it)"
    except SystemExit:  # meshio has printed why
        return None, ""
    except MemoryError:
        return None, "it asks for more memory than there is"
    except meshio.ReadError as error:
        return None, str(error)
    except Exception as error:
        return None, f"{type(error).__name__}: {error}"


def _mend(meshio: Any) -> None:  # noqa: ANN401 - a module
    """Let the reader of Gmsh's format 2.2 split data of cells by blocks.

    In meshio 5.3.5 it hands over pairs of a type and cells, and what splits takes the length of
    the pair for that of the cells.
    """
    split = meshio._common.cell_data_from_raw
    meshio.gmsh._gmsh22.cell_data_from_raw = lambda cells, data: split(
        [block[1] if isinstance(block, tuple) else block for block in cells], data
    )


def limit_processor_time(seconds: float) -> None:
    """Let the system end this process by SIGXCPU once it has used much processor time.

    Parameters
    ----------
    seconds : float
        More than it has used by now. Without effect on Windows.
    """
    if resource is None:
        return
    limit = math.ceil(time.process_time() + seconds)
    hard = resource.getrlimit(resource.RLIMIT_CPU)[1]
    if hard == resource.RLIM_INFINITY or limit < hard:
        resource.setrlimit(resource.RLIMIT_CPU, (limit, hard))
    resource.setrlimit(resource.RLIMIT_CORE, (0, resource.getrlimit(resource.RLIMIT_CORE)[1]))


def main() -> None:
    """Read the file that the command line names."""
    import meshio  # noqa: F401 - what importing takes is not reading

    path, seconds = sys.argv[1:]
    with os.fdopen(os.dup(1), "wb") as result:
        os.dup2(2, 1)  # what a reader prints must not stand in the result
        limit_processor_time(float(seconds))
        pickle.dump(read(path), result, protocol=5)


if __name__ == "__main__":
    main()
