"""What the report says of the regressions, against least squares done by hand."""

import numpy as np
import pytest
from made_runs import level, page, page_text, run
from scipy import optimize, special

from reports.text.numbers import significant

BASES = {
    "linear": lambda x: np.column_stack([np.ones_like(x), x]),
    "quadratic": lambda x: np.column_stack([np.ones_like(x), x, x * x]),
    "logistic": lambda x: np.column_stack([np.ones_like(x), x]),
    "logarithmic": lambda x: np.column_stack([np.ones_like(x), np.log2(x)]),
}


def observations(name, method="incremental"):
    results = run(name)["results"]
    results = results[results["method"] == method]
    return results["n_points"].to_numpy() / 1000, results["mean_lepp"].to_numpy()


def fit(model, x, y):
    """A function that predicts, by ordinary least squares."""
    if model == "saturating":

        def curve(x, c, a, b):
            return c - a * x**-b

        start = [y.max(), y.max() - y.min(), 0.5]
        found, _ = optimize.curve_fit(curve, x, y, p0=start, maxfev=100_000)
        return lambda at: curve(at, *found)
    z = np.log(y / (4 - y)) if model == "logistic" else y
    found = np.linalg.lstsq(BASES[model](x), z)[0]
    if model == "logistic":
        return lambda at: 4 * special.expit(BASES[model](at) @ found)
    return lambda at: BASES[model](at) @ found


def aic(model, x, y):
    parameters = {"quadratic": 4, "saturating": 4}.get(model, 3)
    squares = ((y - fit(model, x, y)(x)) ** 2).sum()
    return len(y) * (np.log(2 * np.pi * squares / len(y)) + 1) + 2 * parameters


def left_out(model, x, y):
    errors = []
    for size in np.unique(x):
        others = x != size
        at = np.array([size])
        errors.append(fit(model, x[others], y[others])(at)[0] - y[~others].mean())
    return np.sqrt(np.mean(np.square(errors)))


def adjusted_r2(model, x, y):
    z = np.log(y / (4 - y)) if model == "logistic" else y
    basis = BASES[model](x)
    residual = z - basis @ np.linalg.lstsq(basis, z)[0]
    n, k = len(z), basis.shape[1]
    return 1 - residual @ residual / (n - k) / (((z - z.mean()) ** 2).sum() / (n - 1))


@pytest.mark.parametrize(("name", "best"), [("growing", "logarithmic"), ("straight", "linear")])
def test_the_best_of_the_four_models(name, best):
    x, y = observations(name)
    r2 = {model: adjusted_r2(model, x, y) for model in BASES}
    top = max(r2, key=r2.get)
    assert top == best or r2[top] - r2[best] < 1e-3
    assert (
        page(name)
        .prose("fits")
        .startswith(
            f"Of the paper's four models the {top} one fits the uniform points best, with an "
            f"adjusted R² of {r2[top]:.3f}."
        )
    )


def bic(model, x, y):
    parameters = {"quadratic": 4, "saturating": 4}.get(model, 3)
    return aic(model, x, y) + (np.log(len(y)) - 2) * parameters


@pytest.mark.parametrize(("name", "agree"), [("growing", True), ("upwards", False)])
def test_criteria_choose_the_lowest(name, agree):
    x, y = observations(name)
    models = list(BASES)
    if "saturating" in page(name).finding("figure-projections"):
        models.append("saturating")
    chosen = {
        label: min(models, key=lambda m: of(m, x, y))
        for label, of in (
            ("AIC", aic),
            ("BIC", bic),
            ("the error of left-out groups", left_out),
        )
    }
    assert (len(set(chosen.values())) == 1) == agree
    words = [f"{label} chooses the {model} model" for label, model in chosen.items()]
    assert (
        f"AIC, BIC and the error of left-out groups all choose the {chosen['AIC']} model."
        if agree
        else f"The criteria do not agree: {words[0]}, {words[1]} and {words[2]}."
    ) in page(name).prose("fits")


def test_models_that_do_not_follow_the_means_are_named():
    said = page("bent").prose("fits")
    x, y = observations("bent")
    sizes = np.unique(x)
    lacking = []
    for model in BASES:
        z = np.log(y / (4 - y)) if model == "logistic" else y
        basis = BASES[model](x)
        residual = ((z - basis @ np.linalg.lstsq(basis, z)[0]) ** 2).sum()
        pure = sum(((z[x == s] - z[x == s].mean()) ** 2).sum() for s in sizes)
        k = basis.shape[1]
        f = (residual - pure) / (4 - k) / (pure / (len(z) - 4))
        if special.fdtrc(4 - k, len(z) - 4, f) < 0.05:
            lacking.append(model)
    assert len(lacking) >= 3
    named = said[said.index(". The ", said.index("R²")) :]
    for model in BASES:
        assert (model in named.split("do not follow")[0]) == (model in lacking)


def test_gap_between_the_models():
    x, y = observations("growing")
    at = np.unique(np.linspace(1000, 8000, 41).round()) / 1000
    said = page("growing").finding("figure-models")
    curves = np.array([fit(model, x, y)(at) for model in BASES])
    if "saturating" in page("growing").finding("figure-projections"):
        curves = np.vstack((curves, fit("saturating", x, y)(at)))
    assert said == (
        f"Inside the data the models lie within {np.ptp(curves, axis=0).max():.4f} of one another."
    )


@pytest.mark.parametrize("name", ["growing", "falling"])
def test_predictions_far_beyond_the_data(name):
    x, y = observations(name)
    at = np.array([1e6])
    said = page(name).prose("projections")
    for model in BASES:
        value = significant(float(fit(model, x, y)(at)[0]), 4).replace("\u00a0", " ")
        assert f"{value} ({model})" in said
    best = min(BASES, key=lambda m: aic(m, x, y))
    if f"The {best} model, which has the lowest AIC" in said:
        steps = [f"{fit(best, x, y)(np.array([10.0**k]))[0]:.4f}" for k in (3, 4, 5, 6)]
        for step in steps:
            assert step in said
    far = page(name).finding("figure-projections")
    word = {"growing": "grows", "falling": "falls"}[name]
    assert f"the logarithmic one {word} without bound" in far


def test_limits_are_undecided_where_nothing_changes():
    assert "the logarithmic one stays undecided" in page("level").finding("figure-projections")
    assert level(np.array([1.0])) == 3.05


def test_a_run_of_one_size_says_that_models_are_missing():
    from made_runs import DESIGN, drawn

    one = DESIGN.model_copy(update={"sizes": (2000,)})
    said = page_text(drawn(one))
    assert said.prose("fits") == ""
    assert said.finding("figure-models") == ""


def test_models_that_follow_the_means_are_not_named():
    assert "do not follow" not in page("level").prose("fits")
    assert "does not follow" not in page("level").prose("fits")
