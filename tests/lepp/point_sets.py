"""The point sets of the reference data, and nasty ones for hypothesis."""

import numpy as np
from hypothesis import strategies as st


def reference_points(kind, n, seed):
    g = np.random.Generator(np.random.PCG64DXSM(seed))
    match kind:
        case "uniform":
            return g.random((n, 2))
        case "normal":
            return g.standard_normal((n, 2))
        case "exponential":
            return g.standard_exponential((n, 2))
        case "thin":
            return g.random((n, 2)) * [1, 1e-9]
        case "offset":
            return g.random((n, 2)) + 1e6
        case "clusters":
            return g.random((n, 2)) * 1e-7 + g.integers(0, 10, (n, 2))
        case "circle":
            a = g.random(n) * 2 * np.pi
            return np.column_stack((np.cos(a), np.sin(a)))
        case "parabola":
            x = g.random(n)
            return np.column_stack((x, x * x))
    raise ValueError(kind)


@st.composite
def nasty_points(draw, max_size=24):
    """Grids, repeated and collinear points, huge and tiny scales, almost collinear points."""
    n = draw(st.integers(3, max_size))
    width = draw(st.integers(1, 6))
    numbers = st.integers(0, width)
    points = np.array(draw(st.lists(st.tuples(numbers, numbers), min_size=n, max_size=n)), float)
    kind = draw(st.sampled_from(["grid", "sheared", "ulps", "continuous"]))
    if kind == "sheared":  # collinear, but not in floating point
        points = points @ np.array([[0.1, 0.3], [0.7, 0.2]])
    elif kind == "ulps":
        points = 1.0 + points * 2.0**-52
    elif kind == "continuous":
        seed = draw(st.integers(0, 2**32 - 1))
        points = np.random.default_rng(seed).random((n, 2))
    scale = draw(st.sampled_from([1.0, 2.0**-1060, 2.0**-700, 1e-9, 1e9, 2.0**700, 2.0**1020]))
    return points * scale
