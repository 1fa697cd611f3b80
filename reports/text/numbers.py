"""Numbers as a reader sees them, from where the formats of the tables are."""

from study.analysis.numbers import (
    count,
    large,
    listed,
    missing,
    none_or,
    p_value,
    p_value_from_log10,
    show,
    significant,
    significant_power,
    ten_to,
    thousands,
)

__all__ = [
    "count",
    "large",
    "listed",
    "missing",
    "none_or",
    "p_value",
    "p_value_from_log10",
    "show",
    "significant",
    "significant_power",
    "ten_to",
    "thousands",
]
