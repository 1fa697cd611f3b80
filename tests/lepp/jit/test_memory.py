"""Arrays of any kind reach kernels as those that they were compiled for."""

import numpy as np
import pytest
from point_sets import reference_points

import lepp
from lepp.geometry import lengths, predicates
from lepp.jit.memory import for_kernels, in_one_block, read_only
from lepp.mesh import adjacency
from lepp.paths import successors
from lepp.triangulate.delaunay import delaunay
from lepp.triangulate.plain import subdivision

KERNELS = [
    lengths._rank_edges,
    predicates.orientations,
    adjacency.link_triangles,
    successors.follow,
    successors.step_over,
    delaunay._insert_all,
    subdivision.subdivide,
]


def misaligned(array):
    memory = np.empty(array.nbytes + 1, np.uint8)
    copy = memory[1:].view(array.dtype).reshape(array.shape)
    copy[...] = array
    return copy


def locked(array):
    array = array.copy()
    array.setflags(write=False)
    return array


OTHERS = {
    "read-only": locked,
    "misaligned": misaligned,
    "Fortran": np.asfortranarray,
    "swapped bytes": lambda array: array.astype(array.dtype.newbyteorder()),
    "strided": lambda array: np.repeat(array, 2, axis=0)[::2],
    "of bytes": lambda array: np.frombuffer(array.tobytes(), array.dtype).reshape(array.shape),
}


@pytest.mark.parametrize("kind", OTHERS)
def test_no_kernel_is_compiled_anew(kind):
    other = OTHERS[kind]
    points = reference_points("uniform", 50, 1)
    mesh = lepp.triangulate(points)
    arrays = lepp.Triangulation.from_arrays(points, mesh.triangles)
    lepp.lepp_sizes(arrays), lepp.lepp_sizes(lepp.triangulate(points, "delaunay"))
    before = [len(kernel.signatures) for kernel in KERNELS]
    for method in lepp.METHODS:
        again = lepp.triangulate(other(points), method)
        assert np.array_equal(again.triangles, lepp.triangulate(points, method).triangles)
        lepp.lepp_paths(again)
    given = lepp.Triangulation.from_arrays(other(points), other(np.array(mesh.triangles)))
    assert np.array_equal(lepp.lepp_sizes(given), lepp.lepp_sizes(arrays))
    made = lepp.Triangulation(
        other(points), other(np.array(mesh.triangles)), other(np.array(mesh.neighbors))
    )
    assert np.array_equal(lepp.lepp_sizes(made), lepp.lepp_sizes(arrays))
    assert [len(kernel.signatures) for kernel in KERNELS] == before


def test_a_read_only_view_of_writable_memory_is_not_copied():
    block = np.arange(12, dtype=np.int32).reshape(6, 2)
    view = read_only(block[2:5], np.int32)
    with pytest.raises(ValueError, match="read-only"):
        view[0, 0] = 1
    again = for_kernels(view, np.int32)
    assert again.flags.writeable
    assert again.tolist() == block[2:5].tolist()
    assert np.shares_memory(again, block)


def test_blocks_stand_one_behind_the_other():
    x, y, k = in_one_block((3, np.float64), (2, np.float64), (4, np.int32))
    assert [len(x), len(y), len(k)] == [3, 2, 4]
    assert y.ctypes.data == x.ctypes.data + 24
    assert k.ctypes.data == y.ctypes.data + 16
    for array in (x, y, k):
        array[:] = 7
    assert (x == 7).all()
    assert (y == 7).all()
