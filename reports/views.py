"""The settings of the page's switch: a method and a distribution each."""

from dataclasses import dataclass

METHOD_NAMES = {"incremental": "Incremental", "delaunay": "Delaunay"}
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
    def distribution_name(self) -> str:
        """The distribution as a word in a sentence."""
        return distribution_name(self.distribution).lower()

    @property
    def method_name(self) -> str:
        """The method as a heading has it."""
        return METHOD_NAMES[self.method]


def distribution_name(distribution: str) -> str:
    """Name of a distribution as a heading has it."""
    return DISTRIBUTION_NAMES[distribution]
