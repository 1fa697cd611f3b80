"""Formulas and numbers in words, in the notation of the page.

Texts of the analysis are plain: ``x^(-b)``, ``sqrt 6``, ``7.5e+05``, ``-10.0%``. Files keep them
so; a reader sees x⁻ᵇ, √6, 7.5 × 10⁵ and −10.0 %.
"""

import math
import re
from collections.abc import Callable

MINUS = "−"
SPACE = "\u00a0"  # no line ends inside a number
TIMES = f"{SPACE}×{SPACE}"

_RAISED = str.maketrans("0123456789+-=()/abcdkmnpstx", "⁰¹²³⁴⁵⁶⁷⁸⁹⁺⁻⁼⁽⁾ᐟᵃᵇᶜᵈᵏᵐⁿᵖˢᵗˣ")
_NUMBER = r"-?\d+(?:\.\d+)?"

Rule = tuple[re.Pattern[str], str | Callable[[re.Match[str]], str]]


def _power(match: re.Match[str]) -> str:
    exponent = (match["inner"] or match["plain"]).replace(" ", "")
    return exponent.translate(_RAISED)


def _scientific(match: re.Match[str]) -> str:
    return f"{match[1]}{TIMES}{ten_to(int(match[2]))}"


def _from_log10(match: re.Match[str]) -> str:
    """One significant digit: more are not in a logarithm with one decimal."""
    value = float(match["value"])
    power = math.floor(value)
    digit = round(10 ** (value - power))
    if digit == 10:
        digit, power = 1, power + 1
    return f"p {match['relation']} {digit}{TIMES}{ten_to(power)}"


_RULES: tuple[Rule, ...] = (
    (re.compile(rf"\blog10 p (?P<relation>=|at most|of) (?P<value>{_NUMBER})"), _from_log10),
    (re.compile(r"\blog10 p\b"), "log₁₀ p"),
    (re.compile(r"\blog10\b"), "log₁₀"),
    (re.compile(r"(?<![\w.])(-?\d+(?:\.\d+)?)e([+-]?\d+)\b"), _scientific),
    (re.compile(r"\^(?:\((?P<inner>[\w +\-/]+)\)|(?P<plain>-?\w))"), _power),
    (re.compile(r"\bsqrt ?(?=[\w(])"), "√"),
    (re.compile(r"\brho\b"), "ρ"),
    (re.compile(r"(?<![\w.)\]\u00a0-])-(?=[\d(a-z∞](?![a-z]))"), MINUS),
    (re.compile(r"(?<=[\w)\]²³ᵇ] )-(?= [\w(√])"), MINUS),
    (re.compile(r"(?<=\d) ?%"), f"{SPACE}%"),
)


def ten_to(power: int) -> str:
    """Write a power of ten."""
    return "10" + str(power).translate(_RAISED)


def typeset(text: str) -> str:
    """Write a plain text of the analysis as a reader sees it.

    Parameters
    ----------
    text : str
        For instance ``c - a x^(-b)``.

    Returns
    -------
    str
        ``c − a x⁻ᵇ``. A text in the page's notation is left as it is.
    """
    for pattern, replacement in _RULES:
        text = pattern.sub(replacement, text)
    return text
