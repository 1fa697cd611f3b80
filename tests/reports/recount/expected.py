"""A sentence as it should stand on the page, with its numbers open, and the page's held against it.

A recount writes a sentence with marks for its numbers. Between the marks the page must have the
same words; at a mark it must have the number, to the digits that it shows.
"""

import math
import re
from dataclasses import dataclass, field

_RAISED = str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹⁻", "0123456789-")
_TEN = r"10[⁰¹²³⁴⁵⁶⁷⁸⁹⁻]+"
_DIGITS = r"[−-]?\d[\d,]*(?:\.\d+)?"
_NUMBER = (
    rf"(?:< {_TEN}|[−-]?∞|{_DIGITS} × {_TEN}|{_TEN}|{_DIGITS}(?: (?:billion|million))?|none|–)"
)
_MARK = re.compile("⟦(\\d+)⟧")
_EITHER = re.compile("⟪(.*?)⟫")
#: Powers of ten below this are only said to be so.
_LEAST_POWER = -307
#: What a double's own rounding may add to half a unit of the last digit.
_ROUNDING = 1e-9


@dataclass(frozen=True)
class _Number:
    """A number of ours: its value, or the decimal logarithm of it, and how near it is known."""

    value: float
    slack: float
    logarithm: bool

    @property
    def described(self) -> str:
        """The number for a reader of the recount."""
        return f"10^{self.value:.4f}" if self.logarithm else f"{self.value:.8g}"

    def fits(self, text: str) -> bool:
        """Whether the page's number is this one, to the digits that it shows."""
        if self.logarithm:
            return self._fits_logarithm(text)
        if text == "none":
            return self.value == 0
        if text == "–":
            return math.isnan(self.value)
        if "∞" in text:
            return math.isinf(self.value) and (self.value < 0) == (text[0] in "−-")
        shown, half = value_and_half_unit(text)
        return abs(shown - self.value) <= half + self.slack + _ROUNDING * abs(self.value)

    def _fits_logarithm(self, text: str) -> bool:
        if text.startswith("<"):
            return self.value < int(text.split("10")[-1].translate(_RAISED)) + 0.01
        mantissa, half, power = _parted(text)
        if mantissa == 0:
            return 10**self.value <= half
        shown = math.log10(mantissa) + power
        return abs(shown - self.value) <= half / mantissa / math.log(10) * 1.05 + self.slack


def _parted(text: str) -> tuple[float, float, int]:
    """Mantissa, half a unit of its last digit, and the power of ten."""
    text = text.replace("−", "-").replace(",", "")
    power = 0
    for word, size in ((" million", 6), (" billion", 9)):
        if text.endswith(word):
            text, power = text.removesuffix(word), size
    if " × " in text:
        text, raised = text.split(" × 10")
        power = int(raised.translate(_RAISED))
    elif re.fullmatch(_TEN, text):
        return 1.0, 0.0, int(text[2:].translate(_RAISED))
    places = len(text.partition(".")[2])
    if text.lstrip("-").isdigit() and power in (6, 9):  # three digits, but for zeros at the end
        places = 3 - len(text)
    return float(text), 0.5 * 10.0**-places, power


def value_and_half_unit(text: str) -> tuple[float, float]:
    """Read a number of the page, and half a unit of the last digit that it shows."""
    mantissa, half, power = _parted(text)
    return mantissa * 10.0**power, half * 10.0**power


@dataclass
class Sheet:
    """Where a recount writes the numbers of one sentence."""

    numbers: list[_Number] = field(default_factory=list)

    def __call__(self, value: float, slack: float = 0.0) -> str:
        """Mark for a number, which may be off by `slack` where it is found by a rougher way."""
        self.numbers.append(_Number(float(value), slack, logarithm=False))
        return f"⟦{len(self.numbers) - 1}⟧"

    def percent(self, share: float, slack: float = 0.0) -> str:
        """Mark for a share, as a percentage."""
        return f"{self(100 * share, 100 * slack)} %"

    def percent2(self, share: float) -> str:
        """The same with two decimals, which have no 0 for a share that is more."""
        return f"< {self(0.01)} %" if 0 < share < 0.5e-4 else self.percent(share)

    def p(self, log10_p: float, slack: float = 0.0) -> str:
        """Mark for a p-value, by its decimal logarithm."""
        self.numbers.append(_Number(float(log10_p), slack, logarithm=True))
        return f"⟦{len(self.numbers) - 1}⟧"

    def p_is(self, log10_p: float, slack: float = 0.0) -> str:
        """What a p-value is: equal to a mark, or below the least that is shown."""
        return f"p {'' if log10_p < _LEAST_POWER else '= '}{self.p(log10_p, slack)}"

    def differences(self, expected: str, text: str) -> list[str] | None:
        """Hold a sentence of the page against ours.

        Returns
        -------
        list of str or None
            What differs; None if it has other words.
        """
        pieces = _MARK.split(expected)
        pattern = "".join(
            f"({_NUMBER})" if k % 2 else _words(piece) for k, piece in enumerate(pieces)
        )
        match = re.fullmatch(pattern, text)
        if match is None:
            return None
        order = [int(mark) for mark in pieces[1::2]]
        return [
            f"shows {shown}, recounted {self.numbers[mark].described}"
            for mark, shown in zip(order, match.groups(), strict=True)
            if not self.numbers[mark].fits(shown)
        ]

    def filled(self, expected: str) -> str:
        """Our sentence with our numbers in it."""
        return _MARK.sub(lambda mark: self.numbers[int(mark[1])].described, expected)


def either(words: list[str]) -> str:
    """Mark for a word that may be any of these."""
    return f"⟪{'|'.join(words)}⟫"


def _words(piece: str) -> str:
    """Pattern of the words between two numbers."""
    return "".join(
        f"(?:{'|'.join(map(re.escape, words.split('|')))})" if k % 2 else re.escape(words)
        for k, words in enumerate(_EITHER.split(piece))
    )


def listed(words: list[str], last: str = "and") -> str:
    """Join words as a sentence does."""
    return words[0] if len(words) == 1 else f"{', '.join(words[:-1])} {last} {words[-1]}"


def plural(n: int, one: str, more: str = "") -> str:
    """The word for so many."""
    return one if n == 1 else more or f"{one}s"
