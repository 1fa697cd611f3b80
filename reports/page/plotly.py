"""Plotly's script, made quick to start.

The Python package brings the bundle of all kinds of traces, about fifty, maps and WebGL among them.
Each is set up when the script is run, which holds a browser up ten times as long as what the plots
of the page need. Two places of the script are changed; where a version of Plotly does not have
them, it is used as it is, which is slower and draws the same.
"""

import importlib.util
import re
from functools import cache
from pathlib import Path

from reports.page.data import compress

#: The kinds of traces that plots may use.
TRACES = ("scatter", "bar", "box", "heatmap")
#: Plotly has ``scatter`` in its core, and registers the other three first of all.
_REGISTERED = len(TRACES) - 1
_REGISTRATION = re.compile(
    rf"(\.register\(\[(?:[\w$]+\(\),){{{_REGISTERED - 1}}}[\w$]+\(\)),[\w$(),]{{100,}}\]\)"
)
#: The function that holds all of Plotly. A browser compiles a function in parentheses at once,
#: any other first for its syntax only, and then again.
_BODY = re.compile(r"(: this, )(\(\) => \{.*\})(\)\);?\s*)\Z", re.DOTALL)


def quick(source: str) -> str:
    """Change Plotly's script so that it registers no other traces than `TRACES`.

    Parameters
    ----------
    source : str
        ``plotly.min.js``.

    Returns
    -------
    str
        The same script where it has another form than expected.
    """
    registering = _REGISTRATION.sub(r"\1])", source, count=1)
    return _BODY.sub(r"\1(\2)\3", registering, count=1)


@cache
def script() -> str:
    """Read the script of the installed package, compressed."""
    # By its path: importing plotly costs more than all of the page.
    package = importlib.util.find_spec("plotly")
    assert package is not None, "plotly is a dependency"
    assert package.origin is not None, "plotly is a regular package"
    source = Path(package.origin).parent / "package_data" / "plotly.min.js"
    return compress(quick(source.read_text(encoding="utf-8")))
