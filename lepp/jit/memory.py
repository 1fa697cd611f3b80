"""Memory for kernels to work in, and arrays as they are compiled for."""

from itertools import accumulate, pairwise

import numpy as np


def in_one_block(*arrays: tuple[int, type]) -> list[np.ndarray]:
    """Return empty arrays of some lengths and types, one behind the other in memory.

    NumPy asks for large pages for arrays of a few megabytes or more, kernels do not, and nobody
    does for many small arrays: a tenth of the time of a triangulation went into small pages.

    Parameters
    ----------
    arrays : (length, type)
        Of each array; those with the larger items first, so that all are aligned.
    """
    # Without NumPy's own split, which takes as long as a small triangulation's kernels.
    ends = list(accumulate((n * np.dtype(dtype).itemsize for n, dtype in arrays), initial=0))
    block = np.empty(ends[-1], np.uint8)
    parts = (block[start:end] for start, end in pairwise(ends))
    return [part.view(dtype) for part, (_, dtype) in zip(parts, arrays, strict=True)]


def for_kernels(array: np.ndarray, dtype: type) -> np.ndarray:
    """Return an array that kernels are compiled for: of a dtype, C-contiguous, aligned, writable.

    To numba a read-only or misaligned array is of another type, for which a kernel would be
    compiled anew, without a word. Kernels do not write to what they are given to read.

    Returns
    -------
    ndarray
        The array itself, another view of its memory, or else a copy.
    """
    array = np.require(array, dtype, ["C_CONTIGUOUS", "ALIGNED"])
    if array.flags.writeable and type(array) is np.ndarray:
        return array
    base = array.base
    if type(base) is np.ndarray and base.flags.writeable and base.flags.c_contiguous:
        offset = array.ctypes.data - base.ctypes.data
        return np.ndarray(array.shape, array.dtype, buffer=base, offset=offset)
    return np.array(array, dtype, order="C", subok=False)


def read_only(array: np.ndarray, dtype: type) -> np.ndarray:
    """Return a view that cannot be written through.

    Parameters
    ----------
    array : ndarray
    dtype : type
        Of the view.

    Returns
    -------
    ndarray
        C-contiguous and aligned; a copy where the array is not, or has another dtype.
    """
    view = np.require(array, dtype, ["C_CONTIGUOUS", "ALIGNED"]).view(np.ndarray)
    view.setflags(write=False)
    return view
