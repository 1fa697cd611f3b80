"""What the report speaks from: the tables of a run, and the rows that a view picks from them."""

from collections.abc import Mapping
from dataclasses import dataclass, field

import pandas as pd

from reports.page.data import select
from reports.page.views import View
from study.analysis.table import Table
from study.design.design import Design


@dataclass(frozen=True)
class Evidence:
    """The tables of a run, and what was asked of them.

    Attributes
    ----------
    tables : dict of str to Table
        The analysis's tables and the report's own, by name.
    design : Design
    manifest : mapping
        What the results directory says of itself.
    selections : list of (str, dict)
        Every selection of rows asked for so far: figures refer to these columns instead of
        repeating their numbers.
    """

    tables: dict[str, Table]
    design: Design
    manifest: Mapping
    selections: list[tuple[str, dict[str, object]]] = field(default_factory=list)

    @property
    def views(self) -> list[View]:
        """All settings of the switch, the design's first method and distribution first."""
        return [View(m, d) for m in self.design.methods for d in self.design.distributions]

    def rows(self, table: str, view: View | None = None, /, **where: object) -> pd.DataFrame:
        """Rows of a table, empty if there is none of that name.

        Parameters
        ----------
        table : str
        view : View, optional
            Picks method and distribution.
        **where
            Values that further columns must have.
        """
        if table not in self.tables:
            return pd.DataFrame()
        frame = self.tables[table].frame
        wanted: dict[str, object] = {**(view.where if view else {}), **where}
        wanted = {name: value for name, value in wanted.items() if name in frame.columns}
        if (table, wanted) not in self.selections:
            self.selections.append((table, wanted))
        return select(frame, wanted)

    def has(self, table: str) -> bool:
        """Whether there is such a table, and a row in it."""
        return table in self.tables and len(self.tables[table].frame) > 0

    def one(self, table: str, view: View | None = None, /, **where: object) -> pd.Series | None:
        """Return the first row of a selection; None if there is none."""
        rows = self.rows(table, view, **where)
        return None if rows.empty else rows.iloc[0]
