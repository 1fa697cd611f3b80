"""The parts of which pages are made: templates, style sheets and scripts."""

from importlib import resources

import jinja2
from markupsafe import Markup

#: The pages' sign: two triangles and the terminal edge between them.
ICON = (
    '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 32 32">'
    '<path d="M4 22 16 4 28 20Z" fill="#74b3f3"/><path d="M4 22 28 20 18 29Z" fill="#ffa35c"/>'
    '<path d="M4 22 28 20" stroke="#16191d" stroke-width="3" stroke-linecap="round"/></svg>'
)


def environment() -> jinja2.Environment:
    """Make the environment of all templates: what is put in is escaped, what is missing fails."""
    return jinja2.Environment(
        loader=jinja2.PackageLoader("reports"),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )


def static(*names: str) -> Markup:
    """Text of style sheets or scripts, safe to stand inside their element."""
    folder = resources.files("reports") / "static"
    text = "".join((folder / name).read_text(encoding="utf-8") for name in names)
    return Markup(text.replace("</", "<\\/"))
