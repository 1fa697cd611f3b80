"""What the report speaks from: the tables of a run, and the rows that a view picks from them."""

from collections.abc import Mapping
from dataclasses import dataclass

import pandas as pd

from reports.page.views import View
from study.analysis.table import Declaration, Rows, Tables
from study.design.design import Design


@dataclass(frozen=True)
class Evidence:
    """The tables of a run.

    Attributes
    ----------
    tables : Tables
        The analysis's tables and the report's own, by name.
    design : Design
    manifest : mapping
        What the results directory says of itself.
    """

    tables: Tables
    design: Design
    manifest: Mapping

    @property
    def views(self) -> list[View]:
        """All settings of the switch, the design's first method and distribution first."""
        return [View(m, d) for m in self.design.methods for d in self.design.distributions]

    def rows(self, declared: Declaration, view: View | None = None, /, **where: object) -> Rows:
        """Rows of a table.

        Parameters
        ----------
        declared : Declaration
            Which table.
        view : View, optional
            Picks method and distribution, or the one of them that the table has.
        **where
            Values that further columns must have.

        Raises
        ------
        UnknownNameError
            If there is no such table, or no such column in it.
        """
        seen = {k: v for k, v in view.where.items() if k in declared.column_names} if view else {}
        return self.tables.rows(declared, **seen, **where)

    def one(
        self, declared: Declaration, view: View | None = None, /, **where: object
    ) -> pd.Series | None:
        """Return the first row of a selection; None if there is none."""
        rows = self.rows(declared, view, **where)
        return None if rows.empty else rows.first
