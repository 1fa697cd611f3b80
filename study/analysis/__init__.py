"""The statistics of a study: from its results to tidy tables."""

from study.analysis.analyse import analyse
from study.analysis.table import Column, Declaration, Table, Tables

__all__ = ["Column", "Declaration", "Table", "Tables", "analyse"]
