"""Spreads between replications: the statistics by other libraries, the errors by simulation."""

import numpy as np
import pytest
from scipy import stats
from statsmodels.regression.linear_model import OLS

from study.paper.consistency import table_4_groups
from study.statistics.models import LINEAR_MODELS
from study.statistics.replications import (
    ADJUSTED_R2,
    ANOVA_F,
    LEVENE_F,
    F,
    Replications,
    statistics_of,
)

PRINTED = table_4_groups()
PAPER = Replications(PRINTED.x, PRINTED.means, PRINTED.sds, PRINTED.count)


def test_drawn_groups_have_their_means_and_spreads():
    values = PAPER.draw(np.random.default_rng(0), 500)
    assert values.shape == (500, 20, 40)
    error = PAPER.sds / np.sqrt(500 * 40)
    assert np.all(np.abs(values.mean(axis=(0, 2)) - PAPER.means) < 4 * error)
    assert values.std(axis=(0, 2), ddof=1) == pytest.approx(PAPER.sds, rel=0.03)
    assert (
        stats.kstest((values[:, 3] - PAPER.means[3]).ravel() / PAPER.sds[3], "norm").pvalue > 0.01
    )


def test_statistics_are_those_of_other_libraries():
    values = PAPER.draw(np.random.default_rng(1), 3)
    made = statistics_of(PAPER.x, values)
    x = np.repeat(PAPER.x, 40)
    for draw, groups in enumerate(values):
        of = {name: series[draw] for name, series in made.items()}
        assert of["", ANOVA_F] == pytest.approx(stats.f_oneway(*groups).statistic)
        assert of["", LEVENE_F] == pytest.approx(stats.levene(*groups, center="mean").statistic)
        for model in LINEAR_MODELS:
            fit = OLS(model.transform(groups.ravel()), model.basis(x)).fit()
            assert of[model.name, F] == pytest.approx(fit.fvalue)
            assert of[model.name, ADJUSTED_R2] == pytest.approx(fit.rsquared_adj)
            terms = [of[model.name, term] for term in model.terms]
            assert terms == pytest.approx(fit.params, rel=1e-6)


def test_errors_are_those_of_many_draws_and_their_seed():
    errors = PAPER.standard_errors(np.random.default_rng(2))
    assert errors == PAPER.standard_errors(np.random.default_rng(2))
    assert errors != PAPER.standard_errors(np.random.default_rng(3))
    many = statistics_of(PAPER.x, PAPER.draw(np.random.default_rng(4), 4000))
    assert errors["", ANOVA_F] == pytest.approx(np.log(many["", ANOVA_F]).std(ddof=1), rel=0.06)
    slope = many["linear", "b"].std(ddof=1)
    assert errors["linear", "b"] == pytest.approx(slope, rel=0.06)


def test_errors_of_coefficients_are_those_of_their_linear_form():
    errors = PAPER.standard_errors(np.random.default_rng(5))
    for model in LINEAR_MODELS:
        if model.name == "logistic":
            continue
        weights = np.linalg.pinv(model.basis(PAPER.x))
        exact = np.sqrt(weights**2 @ (PAPER.sds**2 / 40))
        for term, error in zip(model.terms, exact, strict=True):
            assert errors[model.name, term] == pytest.approx(error, rel=0.06)


def test_honest_replications_agree():
    """Pairs of replications whose spreads fall as measured: differences are unit normal."""
    pairs, draws = 250, 150
    rng = np.random.default_rng(6)
    made = PAPER.draw(rng, 2 * pairs)
    seen = statistics_of(PAPER.x, made)
    errors = {name: np.empty(2 * pairs) for name in seen}
    for place, values in enumerate(made):
        one = Replications(PAPER.x, values.mean(axis=1), values.std(axis=1, ddof=1), 40)
        drawn = statistics_of(PAPER.x, one.draw(rng, draws))
        for name, series in drawn.items():
            by_logarithm = name[1] in (ANOVA_F, LEVENE_F, F)
            errors[name][place] = (np.log(series) if by_logarithm else series).std(ddof=1)
    beyond = []
    for name, series in seen.items():
        values = np.log(series) if name[1] in (ANOVA_F, LEVENE_F, F) else series
        z = (values[:pairs] - values[pairs:]) / np.hypot(errors[name][:pairs], errors[name][pairs:])
        # 250 differences: the standard deviation is known to 0.045
        assert z.std() == pytest.approx(1, abs=0.14), name
        assert np.mean(np.abs(z) > 3) <= 0.016, name
        beyond.append(np.mean(np.abs(z) > 3))
    assert np.mean(beyond) <= 0.006


def test_errors_that_suppose_equal_variances_would_not_do():
    # what the test above would see: those of the noncentral F are two thirds of the true ones
    seen = statistics_of(PAPER.x, PAPER.draw(np.random.default_rng(7), 1000))["", ANOVA_F]
    supposed = stats.ncf.std(19, 780, 19 * (seen.mean() - 1))
    assert seen.std() / supposed > 1.3
