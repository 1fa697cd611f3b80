import pytest

from study.text.notation import typeset


@pytest.mark.parametrize(
    ("plain", "shown"),
    [
        ("c - a x^(-b)", "c − a x⁻ᵇ"),
        ("a + b x + c x^2", "a + b x + c x²"),
        ("4 / (1 + exp(-a - b x))", "4 / (1 + exp(−a − b x))"),
        ("P(size = k) = (1 - p)^(k - 2) p", "P(size = k) = (1 − p)ᵏ⁻² p"),
        ("The standard deviation is sqrt(1 - p) / p", "The standard deviation is √(1 − p) / p"),
        ("at most sqrt 6", "at most √6"),
        ("(p^2 - 6 p + 6) / (1 - p)", "(p² − 6 p + 6) / (1 − p)"),
        ("c - a n^(-1/2)", "c − a n⁻¹ᐟ²"),
        (
            "printed 7.535e+05, meant 7.5e-5",
            "printed 7.535\u00a0×\u00a010⁵, meant 7.5\u00a0×\u00a010⁻⁵",
        ),
        ("(-10.0%)", "(−10.0\u00a0%)"),
        ("-10.0 %", "−10.0\u00a0%"),
        ("log10 p = -33.8", "p = 2\u00a0×\u00a010⁻³⁴"),
        ("log10 p at most -3.02", "p at most 1\u00a0×\u00a010⁻³"),
        ("log10 p = -4.3", "p = 5\u00a0×\u00a010⁻⁵"),
        ("log10 p", "log₁₀ p"),
        ("Spearman's rho -0.84", "Spearman's ρ −0.84"),
        ("to 10^9 points", "to 10⁹ points"),
        ("Measured / Theorem 1 - 1", "Measured / Theorem 1 − 1"),
    ],
)
def test_plain_texts_are_set(plain: str, shown: str) -> None:
    assert typeset(plain) == shown
    assert typeset(shown) == shown


@pytest.mark.parametrize(
    "text",
    [
        "Kolmogorov-Smirnov",
        "longest-edge neighbours",
        "2022-10-05",
        "numpy-2.1",
        "t-test of x-values",
        "95\u00a0%",
        "PCG64DXSM",
        "a file-name",
    ],
)
def test_words_are_left_alone(text: str) -> None:
    assert typeset(text) == text
