"""Figure 2 and equation 1: the strip whose first path covers all of it."""

import lepp
from study.analysis.table import Column, Table

_SIZES = (1, 2, 3, 10, 100, 1000, 10_000, 100_000, 1_000_000)

_WORST_CASE = (
    Column("n_triangles", "Triangles", "triangles", "int"),
    Column("mean_lepp", "Mean LEPP", "triangles", "fixed1"),
    Column("equation_1", "(n + 1) / 2", "triangles", "fixed1"),
    Column("max_lepp", "Largest LEPP", "triangles", "int"),
    Column("equal", "Equal"),
)


def worst_case() -> Table:
    """Measure the worst-case strip, up to a million triangles, by the kernels of the study."""
    rows = []
    for n in _SIZES:
        sizes = lepp.lepp_sizes(lepp.worst_case_strip(n))
        total, longest = int(sizes.sum(dtype="int64")), int(sizes.max())
        rows.append(
            {
                "n_triangles": n,
                "mean_lepp": total / n,
                "equation_1": (n + 1) / 2,
                "max_lepp": longest,
                "equal": "yes" if 2 * total == n * (n + 1) and longest == n else "no",
            }
        )
    note = "The mean grows with n here: no bound holds for all triangulations."
    return Table.from_rows("worst_case", "The worst case (equation 1)", _WORST_CASE, rows, note)
