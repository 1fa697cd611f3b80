"""The parts of which pages are made: templates, style sheets and scripts."""

from importlib import resources

import jinja2
from markupsafe import Markup


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
