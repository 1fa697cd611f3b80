"""The limit of the edge model against the interior: by statsmodels, and by simulation."""

import numpy as np
import pytest
from scipy import stats
from statsmodels.regression.linear_model import WLS

from study.statistics.edge_limit import edge_limit
from study.statistics.groups import Groups, NotEnough
from study.statistics.homogeneity import homogeneity
from study.statistics.models import THICKENING_EDGE
from study.statistics.size_means import SizeMeans

SIZES = np.array([10, 20, 50, 100, 200, 500, 1000, 2000]) * 1000
COUNTS = [20, 20, 20, 20, 10, 10, 10, 10]


def made(seed, limit=3.4765, interior=3.4765, shared=0.8):
    """Whole meshes and interiors of the larger half, whose errors have a part in common."""
    rng = np.random.default_rng(seed)
    whole, inside = [], []
    for n, r in zip(SIZES, COUNTS, strict=True):
        x, spread = n / 1000, 1.2 * n**-0.5
        both = rng.normal(0, spread, r)
        curve = limit + (0.2 + 0.05 * np.log(x)) * x**-0.5
        whole.append(curve + shared * both + rng.normal(0, spread * (1 - shared), r))
        inside.append(interior + both)
    return Groups(SIZES, tuple(whole)), Groups(SIZES[4:], tuple(inside[4:]))


def test_the_numbers_are_statsmodels():
    whole, interior = made(1)
    found = edge_limit(THICKENING_EDGE, whole, interior)
    means, x = SizeMeans.of(whole), SIZES / 1000
    basis = np.column_stack([np.ones(8), x**-0.5, np.log(x) * x**-0.5])
    fit = WLS(means.means, basis, weights=1 / means.variances).fit()
    assert found.limit == pytest.approx(fit.params[0])
    inside = SizeMeans.of(interior)
    assert found.interior == pytest.approx(np.average(inside.means, weights=1 / inside.variances))
    assert found.difference == found.limit - found.interior
    assert found.t == pytest.approx(found.difference / found.standard_error)
    assert found.p == pytest.approx(2 * stats.t.sf(abs(found.t), found.df))
    assert 9 <= found.df <= sum(COUNTS) - 8


def test_the_standard_error_counts_what_both_share():
    found = [edge_limit(THICKENING_EDGE, *made(seed)) for seed in range(300)]
    differences = np.array([one.difference for one in found])
    errors = np.array([one.standard_error for one in found])
    assert np.std(differences) == pytest.approx(errors.mean(), rel=0.12)
    below = np.mean([one.p < 0.05 for one in found])
    assert 0.02 <= below <= 0.09


def test_a_limit_off_the_interior_is_seen():
    assert all(
        edge_limit(THICKENING_EDGE, *made(seed, limit=3.4865)).p < 0.01 for seed in range(10)
    )


def test_they_must_be_the_same_triangulations():
    whole, interior = made(1)
    fewer = Groups(interior.n_points, (interior.values[0][1:], *interior.values[1:]))
    with pytest.raises(NotEnough, match="no interior"):
        edge_limit(THICKENING_EDGE, whole, fewer)
    nothing = Groups(SIZES[:0], ())
    for pair in ((nothing, nothing), (whole, nothing)):
        with pytest.raises(NotEnough, match="no triangulation has an interior"):
            edge_limit(THICKENING_EDGE, *pair)
    two = Groups(SIZES[:2], whole.values[:2])
    with pytest.raises(NotEnough, match="needs 3 sizes, not 2"):
        edge_limit(THICKENING_EDGE, two, two)


def test_homogeneity_is_the_regression_on_one_mean():
    rng = np.random.default_rng(3)
    errors = np.array([0.1, 0.2, 0.05, 0.3])
    means = 3 + rng.normal(0, errors)
    found = homogeneity(means, errors**2, 40)
    fit = WLS(means, np.ones(4), weights=1 / errors**2).fit(cov_type="fixed scale")
    assert found.mean == pytest.approx(fit.params[0])
    assert found.high - found.mean == pytest.approx(stats.t.isf(0.025, 40) * fit.bse[0])
    squares = ((fit.resid / errors) ** 2).sum()
    assert found.score.p == pytest.approx(stats.f.sf(squares / 3, 3, 40))


def test_homogeneity_has_few_false_alarms_and_sees_a_difference():
    rng = np.random.default_rng(4)
    errors = np.array([0.1, 0.2, 0.05, 0.3])
    below = [
        homogeneity(rng.normal(3, errors), errors**2, 10_000).score.p < 0.05 for _ in range(600)
    ]
    assert 0.03 <= np.mean(below) <= 0.075
    assert homogeneity(np.array([3, 3, 3.4, 3]), errors**2, 40).score.p < 0.01
