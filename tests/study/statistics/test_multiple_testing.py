import numpy as np
from statsmodels.stats.multitest import multipletests

from study.statistics.multiple_testing import holm


def test_holm_is_statsmodels():
    p = np.random.default_rng(5).random(30) ** 3
    np.testing.assert_allclose(holm(p), multipletests(p, method="holm")[1], rtol=1e-14)
    assert holm(np.array([])).tolist() == []
