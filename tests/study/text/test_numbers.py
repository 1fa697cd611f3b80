import numpy as np
import pandas as pd
import pytest

from study.text.numbers import (
    count,
    f_test,
    large,
    listed,
    p_is,
    p_of,
    p_value_from_log10,
    show,
    significant,
    thousands,
)


@pytest.mark.parametrize(
    ("value", "how", "text"),
    [
        (1234567, "int", "1,234,567"),
        (3.06657, "fixed4", "3.0666"),
        (-0.00001, "fixed4", "0.0000"),
        (-1.25, "fixed2", "−1.25"),
        (-4.4069e11, "fixed2", "−4.41\u00a0×\u00a010¹¹"),
        (0.4171, "percent1", "41.7\u00a0%"),
        (0.00006, "percent2", "0.01\u00a0%"),
        (0.00004, "percent2", "<\u00a00.01\u00a0%"),
        (0.0, "percent2", "0.00\u00a0%"),
        (-0.00001, "percent2", "0.00\u00a0%"),
        (7.535e-5, "g4", "7.535\u00a0×\u00a010⁻⁵"),
        (0.00123456, "g3", "0.00123"),
        (-518127.0, "g4", "−518,127"),
        (2.5e9, "g2", "2.5\u00a0×\u00a010⁹"),
        (0.0376, "p", "0.0376"),
        (6.08e-77, "p", "6.1\u00a0×\u00a010⁻⁷⁷"),
        (0.0, "p", "<\u00a010⁻³⁰⁷"),
        (-400.5, "log10p", "<\u00a010⁻³⁰⁷"),
        (-300.5, "log10p", "3.2\u00a0×\u00a010⁻³⁰¹"),
        (3e-310, "p", "<\u00a010⁻³⁰⁷"),
        (19999959.27, "fixed2", "19,999,959.27"),
        ("delaunay", "name", "Delaunay"),
        ("incremental", "name", "plain insertion"),
        (-1.0, "log10p", "0.1000"),
        (float("inf"), "fixed2", "∞"),
        (float("nan"), "fixed2", "–"),
        (None, "text", "–"),
        (pd.NA, "int", "–"),
        (780.0, "df", "780"),
        (287.1704, "df", "287.2"),
        ("agrees", "text", "agrees"),
        ("c - a x^(-b)", "text", "c − a x⁻ᵇ"),
        ("agrees", "verdict", "agrees"),
        ("c - a x^2", "verdict", "c - a x^2"),
        ("bivariate_normal", "name", "bivariate normal"),
        (float("-inf"), "g3", "−∞"),
        (np.int64(7), "int", "7"),
    ],
)
def test_show(value: object, how: str, text: str) -> None:
    assert show(value, how) == text


def test_p_changes_its_form_at_a_thousandth_and_at_the_least() -> None:
    assert p_value_from_log10(-2.5) == "0.0032"
    assert p_value_from_log10(-3.0) == "0.0010"
    assert p_value_from_log10(-3.1) == "7.9\u00a0×\u00a010⁻⁴"
    assert p_value_from_log10(-307.0) == "1.0\u00a0×\u00a010⁻³⁰⁷"
    assert p_value_from_log10(-307.1) == "<\u00a010⁻³⁰⁷"


def test_a_small_p_is_never_shown_as_zero() -> None:
    for exponent in range(1, 400):
        assert set(p_value_from_log10(-float(exponent))) - set("0. ")


def test_what_a_p_is() -> None:
    assert p_is(-1.0) == "p\u00a0=\u00a00.1000"
    assert p_is(-300.5) == "p\u00a0=\u00a03.2\u00a0×\u00a010⁻³⁰¹"
    assert p_of(0.0123) == "p\u00a0=\u00a00.0123"
    assert p_of(0.0) == p_is(-558986.0) == p_is(-float("inf")) == "p\u00a0<\u00a010⁻³⁰⁷"


def test_f_has_both_degrees_of_freedom() -> None:
    assert f_test(12.34567, 9, 390.0) == "F\u00a0=\u00a012.3 on 9 and 390 degrees of freedom"


def test_mantissa_is_below_ten() -> None:
    assert p_value_from_log10(-50 + 1e-12) == "1.0\u00a0×\u00a010⁻⁵⁰"
    assert p_value_from_log10(-50 - 1e-12) == "1.0\u00a0×\u00a010⁻⁵⁰"


def test_words() -> None:
    assert count(1, "task") == "1 task"
    assert count(3200, "triangulation") == "3,200 triangulations"
    assert listed(["a"]) == "a"
    assert listed(["a", "b", "c"]) == "a, b and c"
    assert large(336_000_000) == "336 million"
    assert large(1_000_000) == "1 million"
    assert large(10**9) == "1 billion"
    assert large(999_999) == "999,999"
    assert thousands(10_000) == "10k"
    assert thousands(500) == "500"
    assert thousands(700_000) == "700k"
    assert thousands(2_500_000) == "2.5M"
    assert thousands(10**9) == "1B"


@pytest.mark.parametrize(
    ("number", "text"),
    [
        (0, "0"),
        (0.00012, "0.00012"),
        (0.000012, "1.2 × 10⁻⁵"),
        (120_000, "120,000"),
        (1_200_000, "1.2 × 10⁶"),
    ],
)
def test_numbers_far_from_1_are_powers_of_ten(number, text):
    assert significant(number, 2).replace("\u00a0", " ") == text
