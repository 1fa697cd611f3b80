"""Numbers as a reader sees them: the one place that decides their digits."""

import math
import re

from lepp import METHODS
from study.text.notation import MINUS, SPACE, TIMES, typeset
from study.text.notation import ten_to as ten_to  # part of how numbers are written

_DASH = "–"
_HUGE = 1e10  # from here on, decimals say nothing
_LEAST_POWER = -307  # of p-values: what is less is only said to be so


def show(value: object, how: str) -> str:
    """Write one value.

    Parameters
    ----------
    value : object
        A cell of a table.
    how : str
        A format of `study.analysis.table.Column`.

    Returns
    -------
    str
        A dash for what could not be computed.
    """
    if missing(value):
        return _DASH
    if how == "text":
        return typeset(str(value))
    if how == "verdict":
        return str(value)
    if how == "name":
        return METHODS[str(value)].word if value in METHODS else str(value).replace("_", " ")
    number = float(value)  # type: ignore[arg-type]  # a numeric format promises a number
    kind, digits = _split(how)
    if not math.isfinite(number):
        return f"{MINUS if number < 0 else ''}∞"
    if kind == "int":
        return _signed(f"{number:,.0f}")
    if kind == "df":
        return _signed(f"{number:,.{0 if number.is_integer() else 1}f}")
    if kind == "fixed" and abs(number) >= _HUGE:
        return significant(number, 3)
    if kind == "fixed":
        return _signed(f"{number:,.{digits}f}")
    if kind == "percent":
        return percent(number, digits)
    if kind == "p":
        return p_value(number)
    if kind == "log10p":
        return p_value_from_log10(number)
    return significant(number, digits)


def missing(value: object) -> bool:
    """Whether a cell holds nothing: None, NaN or pandas's NA."""
    if value is None or value.__class__.__name__ == "NAType":
        return True
    return isinstance(value, float) and math.isnan(value)


def significant(number: float, digits: int) -> str:
    """Write a number with so many significant digits, as a power of ten where it is far from 1."""
    if number == 0:
        return "0"
    mantissa, exponent = f"{number:.{digits - 1}e}".split("e")
    power = int(exponent)
    if -4 <= power < 6:
        return _signed(f"{number:,.{max(0, digits - 1 - power)}f}")
    return f"{_signed(mantissa)}{TIMES}{ten_to(power)}"


def percent(share: float, digits: int) -> str:
    """Write a share times 100, with so many decimals; as ``< 0.01 %`` where they would show 0."""
    least = 10.0**-digits
    if 0 < 100 * share < least / 2:
        return f"<{SPACE}{least:.{digits}f}{SPACE}%"
    return _signed(f"{100 * share:,.{digits}f}") + f"{SPACE}%"


def p_value(p: float) -> str:
    """Write a p-value: four decimals, and a power of ten where those would show only zeros."""
    return p_value_from_log10(math.log10(p) if p > 0 else -math.inf)


def p_value_from_log10(log10_p: float) -> str:
    """Write a p-value given by its decimal logarithm, which may be far below a double's range."""
    if log10_p < _LEAST_POWER:
        return f"<{SPACE}{ten_to(_LEAST_POWER)}"
    return f"{10**log10_p:.4f}" if log10_p >= -3 else significant_power(log10_p)


def p_is(log10_p: float) -> str:
    """Write what a p-value given by its decimal logarithm is: ``p = 0.0123``, ``p < 10⁻³⁰⁷``."""
    shown = p_value_from_log10(log10_p)
    return f"p{SPACE}{shown}" if shown.startswith("<") else f"p{SPACE}={SPACE}{shown}"


def p_of(p: float) -> str:
    """Write what a p-value is, as `p_is` does."""
    return p_is(math.log10(p) if p > 0 else -math.inf)


def f_test(f: float, df: float, df_residual: float) -> str:
    """Write an F statistic with its degrees of freedom."""
    return (
        f"F{SPACE}={SPACE}{significant(f, 3)} on {show(df, 'df')} and {show(df_residual, 'df')} "
        "degrees of freedom"
    )


def significant_power(log10_value: float) -> str:
    """Write ``10**log10_value`` with two significant digits as a power of ten."""
    power = math.floor(log10_value)
    mantissa = f"{10 ** (log10_value - power):.1f}"
    if mantissa == "10.0":
        mantissa, power = "1.0", power + 1
    return f"{mantissa}{TIMES}{ten_to(power)}"


def count(number: float, noun: str, plural: str = "") -> str:
    """Write a number of things: ``1 task``, ``3,200 tasks``."""
    return f"{number:,.0f} {noun if number == 1 else plural or noun + 's'}"


def none_or(number: int) -> str:
    """Write a number of things that may be none."""
    return "none" if number == 0 else f"{number:,}"


def listed(words: list[str], last: str = "and") -> str:
    """Join words as a sentence does: ``a, b and c``."""
    return words[0] if len(words) == 1 else f"{', '.join(words[:-1])} {last} {words[-1]}"


def large(number: float) -> str:
    """Write a large count in words: ``336 million``."""
    for size, word in ((10**9, "billion"), (10**6, "million")):
        if number >= size:
            return f"{number / size:.3g} {word}"
    return f"{number:,.0f}"


def thousands(number: int) -> str:
    """Write a number of points for a cramped axis: ``500``, ``10k``, ``2.5M``, ``1B``."""
    for size, letter in ((10**9, "B"), (10**6, "M"), (10**3, "k")):
        if number >= size:
            return f"{number / size:g}{letter}"
    return str(number)


def _split(how: str) -> tuple[str, int]:
    match = re.fullmatch(r"(log10p|[a-z]+)(\d*)", how)
    if match is None:
        raise ValueError(f"unknown number format {how!r}")
    return match[1], int(match[2] or 0)


def _signed(text: str) -> str:
    """Put a real minus sign, and none before a number that is rounded to zero."""
    if text.startswith("-"):
        digits = text[1:]
        return MINUS + digits if re.search(r"[1-9]", digits) else digits
    return text
