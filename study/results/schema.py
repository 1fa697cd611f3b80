"""The columns of the result files, and the tables that outcomes make."""

from collections.abc import Sequence

import numpy as np
import pyarrow as pa

from study.run.experiment import Histogram, Outcome

_TASK = [
    ("method", pa.string()),
    ("distribution", pa.string()),
    ("n_points", pa.int64()),
    ("replicate", pa.int64()),
]

#: Measured columns of the results: null where a task failed.
MEASURES = {
    "n_triangles": pa.int64(),
    "n_hull": pa.int64(),
    "n_repeated": pa.int64(),
    "mean_lepp": pa.float64(),
    "sd_lepp": pa.float64(),
    "skewness_lepp": pa.float64(),
    "kurtosis_lepp": pa.float64(),
    "max_lepp": pa.int64(),
    "n_interior_longest": pa.int64(),
    "n_type_a": pa.int64(),
    "n_type_b": pa.int64(),
    "n_type_c": pa.int64(),
    "n_regions": pa.int64(),
    "max_region": pa.int64(),
    "runs_p_x": pa.float64(),
    "runs_p_y": pa.float64(),
    "ks_p_x": pa.float64(),
    "ks_p_y": pa.float64(),
}

TIMINGS = ("sample_s", "check_s", "triangulate_s", "lepp_s")

SCHEMAS = {
    "results": pa.schema([*_TASK, *MEASURES.items(), ("error", pa.string())]),
    "histograms": pa.schema([*_TASK, ("lepp_size", pa.int64()), ("count", pa.int64())]),
    "regions": pa.schema([*_TASK, ("region_size", pa.int64()), ("count", pa.int64())]),
    "timings": pa.schema(
        [*_TASK, *((name, pa.float64()) for name in TIMINGS), ("worker", pa.string())]
    ),
}


def tables_of(outcomes: Sequence[Outcome]) -> dict[str, pa.Table]:
    """Arrange outcomes as the four tables of a results directory.

    Parameters
    ----------
    outcomes : sequence of Outcome
        In the order that the rows are to have.

    Returns
    -------
    tables : dict of str to pyarrow.Table
        By the names of `SCHEMAS`.
    """
    tasks = _task_columns(outcomes)
    measures = [[o.measures.get(name) for o in outcomes] for name in MEASURES]
    timings = [[o.timings.get(name) for o in outcomes] for name in TIMINGS]
    columns = {
        "results": [*tasks, *measures, [o.error for o in outcomes]],
        "histograms": _histogram_columns(tasks, [o.histogram for o in outcomes]),
        "regions": _histogram_columns(tasks, [o.regions for o in outcomes]),
        "timings": [*tasks, *timings, [o.worker for o in outcomes]],
    }
    return {
        name: pa.table(
            [pa.array(c, type=t) for c, t in zip(columns[name], schema.types, strict=True)],
            schema=schema,
        )
        for name, schema in SCHEMAS.items()
    }


def _task_columns(outcomes: Sequence[Outcome]) -> list[pa.Array]:
    return [
        pa.array([outcome.task[position] for outcome in outcomes], type=kind)
        for position, (_, kind) in enumerate(_TASK)
    ]


def _histogram_columns(tasks: list[pa.Array], histograms: list[Histogram]) -> list[pa.Array]:
    rows = np.repeat(np.arange(len(histograms)), [len(histogram) for histogram in histograms])
    bars = np.array([bar for histogram in histograms for bar in histogram], dtype=np.int64)
    bars = bars.reshape(-1, 2)
    return [*(column.take(pa.array(rows)) for column in tasks), bars[:, 0], bars[:, 1]]
