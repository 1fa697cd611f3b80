"""The growth models against their formulas as they are printed, and their derivatives."""

import re

import numpy as np
import pytest

from study.statistics import models

X = np.array([0.5, 1.0, 2.0, 10.0, 200.0])
LINEAR = [one for one in models.MODELS if isinstance(one, models.LinearModel)]


def test_the_four_models_of_the_paper():
    assert [model.name for model in models.LINEAR_MODELS] == [
        "linear",
        "quadratic",
        "logistic",
        "logarithmic",
    ]


def written(formula, terms):
    """The formula as Python has it."""
    for mark, meaning in (("log₂", "np.log2"), ("ln", "np.log"), ("exp", "np.exp"), ("^", "**")):
        formula = formula.replace(mark, meaning)
    formula = re.sub(r"(\d|\)) (x|\()", r"\1 * \2", formula)
    for term in terms:
        formula = re.sub(rf"\b{term} (x|np)", rf"{term} * \1", formula)
    return formula


@pytest.mark.parametrize("model", LINEAR, ids=lambda model: model.name)
def test_basis_and_inverse_are_the_formula(model):
    scale = {"logistic": 0.01, "quadratic": 0.001}.get(model.name, 0.2)
    coefficients = scale * np.arange(1, len(model.terms) + 1)
    values = model.inverse(model.basis(X) @ coefficients)
    named = dict(zip(model.terms, coefficients, strict=True))
    expected = eval(written(model.formula, model.terms), {"np": np, "x": X} | named)
    np.testing.assert_allclose(values, np.broadcast_to(expected, X.shape))
    assert model.basis(X).shape == (len(X), len(model.terms))
    np.testing.assert_allclose(model.transform(values), model.basis(X) @ coefficients)


@pytest.mark.parametrize("model", LINEAR, ids=lambda model: model.name)
def test_the_first_coefficient_is_the_limit(model):
    far = np.array([1e20, 1e40])
    coefficients = np.arange(1.0, len(model.terms) + 1)
    values = model.inverse(model.basis(far) @ coefficients)
    if model.has_limit:
        assert values == pytest.approx([1, 1], abs=1e-6)
    elif model.has_limit is False:
        # without bound, if only as ln ln n
        assert values[1] - values[0] > 1
    else:
        assert model in (models.QUADRATIC, models.LOGISTIC)


def test_logit_and_logistic():
    assert models.ASYMPTOTE == 4
    assert models.logit(np.array([2.0])) == 0
    assert models.logit(np.array([3.0])) == pytest.approx(np.log(3))  # 3 of 4 against 1 of 4
    assert models.logistic(np.array([np.log(3), 0.0, 800.0])).tolist() == pytest.approx([3, 2, 4])


def test_saturating_values_and_gradient():
    model = models.SATURATING
    assert (model.name, model.formula, model.terms) == (
        "saturating", "c - a x^(-b)", ("c", "a", "b"),
    )  # fmt: skip
    at = np.array([3.1, 0.2, 0.7])
    np.testing.assert_allclose(model.values(X, *at), [3.1 - 0.2 / x**0.7 for x in X])
    assert model.values(np.array([1e12]), *at) == pytest.approx(3.1)
    numeric = []
    for k in range(3):
        step = 1e-6 * (np.arange(3) == k)
        numeric.append((model.values(X, *(at + step)) - model.values(X, *(at - step))) / 2e-6)
    np.testing.assert_allclose(model.gradient(X, *at), np.transpose(numeric), atol=1e-8)
