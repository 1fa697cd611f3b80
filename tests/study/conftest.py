from contextlib import contextmanager

import numpy as np
import pandas as pd
import pytest
from frames import design, frames
from scipy import stats

from study.analysis.analyse import analyse
from study.paper import published


@contextmanager
def short_worst_case():
    """No test of a statistic needs a strip of a million triangles."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("study.analysis.worst_case_strip._SIZES", (1, 2, 3))
        yield


@pytest.fixture(scope="module", autouse=True)
def _short_worst_case():
    with short_worst_case():
        yield


@pytest.fixture(scope="session")
def study():
    """A small study by two methods: design, frames and tables."""
    asked = design(methods=("incremental", "delaunay"))
    made = frames(asked)
    with short_worst_case():
        return asked, made, analyse(*made, asked)


@pytest.fixture(scope="session")
def paper_study():
    """Groups with exactly the published means and standard deviations of Table 4."""
    sizes = published.sizes()
    asked = design(distributions=("uniform",), sizes=sizes, repetitions=published.REPETITIONS)
    results, *others = frames(asked.model_copy(update={"sizes": (1000,)}))
    scores = stats.zscore(stats.norm.ppf((np.arange(40) + 0.5) / 40), ddof=1)
    rows = []
    for triangles, largest, mean, sd in published.table_4():
        group = results.assign(n_points=mean.n_points, mean_lepp=mean.value + sd.value * scores)
        least, more = divmod(round(triangles.value * len(group)), len(group))
        group["n_triangles"] = least + np.repeat([-3, 3], 20) + (np.arange(len(group)) < more)
        group["max_lepp"] = np.repeat([int(largest.value) - 1, int(largest.value) + 1], 20)
        rows.append(group)
    made = (pd.concat(rows, ignore_index=True), *others)
    with short_worst_case():
        return asked, made, analyse(*made, asked)
