"""What a section of the page is made of: sentences, tiles, tables and figures.

A text or a figure that depends on the switch is a mapping from a view's key to its variant;
`ALWAYS` is the key of what every view shows alike.
"""

import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from markupsafe import Markup

from reports.page.style import Spec
from reports.page.views import View

if TYPE_CHECKING:
    from study.analysis.table import Declaration

ALWAYS = "*"
#: What a title must not bring along: the page numbers its figures, and the paper's numbers are
#: told apart from them.
_NUMBERED = re.compile(r"(Figure|Table) \d|Data( of |:)")
_SLUG = re.compile(r"figure-[a-z][a-z0-9-]*")
#: The columns that the page's switches pick rows by.
SWITCHES = ("method", "distribution")


def _check_title(title: str) -> None:
    if _NUMBERED.match(title):
        raise ValueError(
            f"a title is plain words, not {title!r}: the page numbers its figures and says whose "
            "data a table has; what the paper calls it is given as `paper`"
        )


def _check_figure(address: str, title: str) -> None:
    if not _SLUG.fullmatch(address):
        raise ValueError(f"a figure's id is a word like 'figure-models', not {address!r}")
    _check_title(title)


@dataclass(frozen=True)
class Prose:
    """Paragraphs; one list of them a view."""

    paragraphs: dict[str, list[str | Markup]]
    kind: str = "prose"


@dataclass(frozen=True)
class Tile:
    """One key figure: a number, what it is, and what to hold it against."""

    value: str
    label: str
    context: str = ""


@dataclass(frozen=True)
class Tiles:
    """Key figures in a row; one list of them a view."""

    tiles: dict[str, list[Tile]]
    kind: str = "tiles"


@dataclass(frozen=True)
class Facts:
    """Names and values that no view changes."""

    facts: tuple[tuple[str, str], ...]
    kind: str = "facts"


@dataclass(frozen=True)
class Quotation:
    """Text to be copied as it stands.

    Attributes
    ----------
    label : str
        What it is.
    text : str
    """

    label: str
    text: str
    kind: str = "quotation"


@dataclass(frozen=True)
class TableBlock:
    """A table of the data block.

    Attributes
    ----------
    table : Declaration
    caption : str
        Plain words. A table of a figure's data has the figure's number put before them.
    columns : tuple of str
        The columns to show, in this order; all when empty. The full download always has all.
    follows : tuple of str, optional
        The switches that pick the rows shown; those that the table has a column for, by default.
    folded : bool
        Whether the reader has to open it.
    where : dict
        Values of further columns that pick the rows shown.
    printed_whole : bool
        Whether a print-out has all rows, however many there are.
    paper : str
        What the paper calls this table: ``Table 7``.
    id : str
        Stable address of the element; made of the table's name when empty.

    Raises
    ------
    UnknownNameError
        If the table has no such column.
    ValueError
        If the caption brings a number of its own.
    """

    table: "Declaration"
    caption: str
    columns: tuple[str, ...] = ()
    follows: tuple[str, ...] | None = None
    folded: bool = False
    where: dict[str, object] = field(default_factory=dict)
    printed_whole: bool = False
    paper: str = ""
    id: str = ""
    kind: str = "table"

    def __post_init__(self) -> None:
        asked = (*self.columns, *self.followed, *self.where)
        self.table.check_columns(asked)
        if not self.id:  # the page, when it is put together, puts the figure before the caption
            _check_title(self.caption)

    @property
    def followed(self) -> tuple[str, ...]:
        """The switches that pick the rows."""
        if self.follows is not None:
            return self.follows
        return tuple(name for name in SWITCHES if name in self.table.column_names)

    @property
    def address(self) -> str:
        """Id of the element."""
        return self.id or f"table-{self.table.name.replace('_', '-')}"


@dataclass(frozen=True)
class FigureBlock:
    """A plot, the finding it shows, and its data.

    Attributes
    ----------
    id : str
        Stable id of the element, a word of what it shows: ``figure-models``.
    title : str
        Plain words; its number is given where the page is put together.
    specs : dict of str to Spec
        The plot for each view; a view without one is said to be missing.
    alternatives : dict of str to str
        What the plot shows, in words, for each view.
    reading : str
        How to read it, in a sentence.
    data : tuple of TableBlock
        The tables of its data, shown under a fold.
    paper : str
        What the paper calls this figure: ``Figure 6``.
    number : int
        Place among the figures of the page; 0 before the page is put together.

    Raises
    ------
    ValueError
        If the id is no such word, or the title brings a number of its own.
    """

    id: str
    title: str
    specs: dict[str, Spec]
    alternatives: dict[str, str]
    reading: str
    data: tuple[TableBlock, ...]
    paper: str = ""
    number: int = 0
    kind: str = "figure"

    def __post_init__(self) -> None:
        _check_figure(self.id, self.title)

    @property
    def height(self) -> int:
        """Height in CSS pixels, kept free before the plot is drawn."""
        return max((spec["layout"]["height"] for spec in self.specs.values()), default=0)


@dataclass(frozen=True)
class Drawing:
    """A drawing that is part of the page's markup, from a template of its own."""

    id: str
    template: str
    context: dict[str, object]
    title: str
    alternatives: dict[str, str]
    reading: str
    data: tuple[TableBlock, ...] = ()
    paper: str = ""
    number: int = 0
    kind: str = "drawing"

    def __post_init__(self) -> None:
        _check_figure(self.id, self.title)


Block = Prose | Tiles | Facts | Quotation | TableBlock | FigureBlock | Drawing


@dataclass(frozen=True)
class Subsection:
    """A heading and its blocks."""

    id: str
    title: str
    blocks: tuple[Block, ...]


@dataclass(frozen=True)
class Section:
    """A part of the page that answers one question."""

    id: str
    title: str
    question: str
    parts: tuple[Subsection, ...]


def per_view(views: Iterable[View], make: Callable[[View], object]) -> dict:
    """Make a variant for each view, leaving out those that cannot be made (None)."""
    made = {view.key: make(view) for view in views}
    return {key: value for key, value in made.items() if value is not None}


def common(*paragraphs: str | Markup) -> Prose:
    """Paragraphs that every view shows."""
    return Prose({ALWAYS: list(paragraphs)})
