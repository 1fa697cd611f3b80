"""The settings of the page's switch: a method and a distribution each."""

from dataclasses import dataclass

from lepp import METHODS

DISTRIBUTION_NAMES = {
    "uniform": "Uniform",
    "normal": "Normal",
    "bivariate_normal": "Bivariate normal",
    "exponential": "Exponential",
}


@dataclass(frozen=True)
class View:
    """One setting of the switch."""

    method: str
    distribution: str

    @property
    def key(self) -> str:
        """Name of the view in the page's data and its elements."""
        return f"{self.method}/{self.distribution}"

    @property
    def where(self) -> dict[str, str]:
        """The columns and values that pick this view's rows from a table."""
        return {"method": self.method, "distribution": self.distribution}

    @property
    def distribution_word(self) -> str:
        """The distribution as a word in a sentence."""
        return distribution_word(self.distribution)

    @property
    def method_title(self) -> str:
        """The method as a heading has it."""
        return METHODS[self.method].title

    @property
    def method_word(self) -> str:
        """The method as a word in a sentence."""
        return METHODS[self.method].word


def distribution_name(distribution: str) -> str:
    """Name of a distribution as a heading has it."""
    return DISTRIBUTION_NAMES[distribution]


def distribution_word(distribution: str) -> str:
    """Name of a distribution as a word in a sentence."""
    return DISTRIBUTION_NAMES[distribution].lower()
