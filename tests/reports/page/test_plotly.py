import importlib.util
import zlib
from base64 import b64decode
from pathlib import Path

from reports.page import plotly

#: As the bundle is built: a wrapper, the registration of everything, and the end.
TRACES = ",".join(f"t{k}$()" for k in range(40))
BUNDLE = (
    '(function(root, factory) { factory(); } (typeof self !== "u" ? self : this, () => {\n'
    f"var Plotly=(()=>{{R.register([{TRACES}])}})();\nreturn Plotly;\n}}));"
)


def test_only_the_first_traces_are_registered_and_the_body_is_compiled_at_once() -> None:
    quick = plotly.quick(BUNDLE)
    assert "register([t0$(),t1$(),t2$()])}" in quick
    assert ": this, (() => {\n" in quick
    assert quick.endswith("return Plotly;\n})));")


def test_a_script_of_another_form_is_left_as_it_is() -> None:
    other = "var Plotly = make(); Plotly.register([bar()]);"
    assert plotly.quick(other) == other


def test_the_installed_script_has_the_expected_form() -> None:
    package = importlib.util.find_spec("plotly")
    assert package is not None
    assert package.origin is not None
    path = Path(package.origin).parent / "package_data" / "plotly.min.js"
    source = path.read_text(encoding="utf-8")
    quick = plotly.quick(source)
    removed, added = len(source) - len(quick), 2
    assert 150 + added < removed + 2 * added < 600
    assert zlib.decompress(b64decode(plotly.script())).decode() == quick
