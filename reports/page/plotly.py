"""Plotly's script, made small and quick to start.

The Python package brings the bundle of all kinds of traces, about fifty, maps and WebGL among them.
Each is set up when the script is run, which holds a browser up ten times as long as what the plots
of the page need, and makes three quarters of the script's size. So it registers no others, and the
modules that nothing asks for any more are left out. A version of Plotly that has not been seen to
work so is used as it is, which is larger and slower and draws the same.
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


#: The version whose modules may be left out: tests draw every kind of plot with what is left.
_SEEN = "plotly.js v4.1.1"
#: The bundler's function that makes a module of a function, run when it is first asked for; and
#: those that make modules of another kind, which share variables with what stands around them.
_MAKES_MODULE = re.compile(r"[ ,;]([\w$]+)=\(e,t\)=>\(\)=>\{try\{return t\|\|e\(\(t=\{exports:")
_SHARES = (
    re.compile(r"[ ,;]([\w$]+)=\(e,t,r\)=>\(\)=>\{if\(r\)throw"),
    re.compile(r"[ ,;]([\w$]+)=\(e,t\)=>\{for\(var r in t\)"),
)
#: A module is asked for by calling it.
_ASKS = re.compile(r"(?<![\w$.])([\w$]+)\(\)")


def only_used(source: str) -> str:
    """Leave out the modules that nothing asks for.

    Parameters
    ----------
    source : str
        The script, of the bundler esbuild.

    Returns
    -------
    str
        The same script where it is of another version, or has another form than expected.

    Notes
    -----
    Whatever is called by the name of a module counts as asking for it, be it a local function of
    that name: so too much is kept, not too little.
    """
    makes = _MAKES_MODULE.search(source)
    shares = [pattern.search(source) for pattern in _SHARES]
    if _SEEN not in source[:200] or makes is None or None in shares:
        return source
    name = r"[\w$]+"
    head = re.compile(rf"var ({name})={re.escape(makes[1])}\((?:\([\w$,]*\)|{name})=>\{{")
    shared = "|".join(re.escape(found[1]) for found in shares if found)
    shared_call = re.compile(rf"(?<![\w$])(?:{shared})\(")
    starts = list(head.finditer(source))
    ends = [start.start() for start in starts[1:]] + [len(source)]
    modules: dict[str, str] = {}
    pieces: list[tuple[str, str]] = [("", source[: starts[0].start()])]
    for start, end in zip(starts, ends, strict=True):
        piece = source[start.start() : end]
        alone = piece.endswith("});") and not shared_call.search(piece)
        pieces.append((start[1] if alone else "", piece))
        if alone:
            modules[start[1]] = piece
    used: set[str] = set()
    asking = [piece for module, piece in pieces if not module]
    while asking:
        asked = {one for one in _ASKS.findall(asking.pop()) if one in modules} - used
        used |= asked
        asking += [modules[one] for one in asked]
    return "".join(piece for module, piece in pieces if not module or module in used)


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
    return compress(only_used(quick(source.read_text(encoding="utf-8"))))
