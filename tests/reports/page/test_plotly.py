import importlib.util
import zlib
from base64 import b64decode
from pathlib import Path

from reports.page import plotly, style

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
    used = plotly.only_used(quick)
    assert len(used) < 0.65 * len(quick)
    assert zlib.decompress(b64decode(plotly.script())).decode() == used


HELPERS = (
    "var M=(e,t)=>()=>{try{return t||e((t={exports:{}}).exports,t),t.exports}catch(r){throw t=0,r}}"
    ",S=(e,t,r)=>()=>{if(r)throw r[0]},X=(e,t)=>{for(var r in t)d(e,r,t[r])};"
)
MODULES = {
    "a": "var a=M((e,t)=>{var x=b();t.exports=x});",
    "b": "var b=M(e=>{e.$c=$d()});",
    "unused": "var unused=M((e,t)=>{t.exports=only()});",
    "only": "var only=M((e,t)=>{t.exports=3});",
    "$d": "var $d=M((e,t)=>{t.exports=o.only()});",
    "mixed": "var mixed=M((e,t)=>{t.exports=1});function f(){}var g=S(()=>{});",
    "end": "var end=M((e,t)=>{t.exports=a()});return end()",
}


def bundle(version: str = "4.1.1", helpers: str = HELPERS) -> str:
    return f"/**\n* plotly.js v{version}\n*/\n{helpers}{''.join(MODULES.values())}"


def test_modules_that_nothing_asks_for_are_left_out() -> None:
    used = plotly.only_used(bundle())
    assert used == bundle().replace(MODULES["unused"], "").replace(MODULES["only"], "")


def test_modules_of_another_version_or_bundler_are_all_kept() -> None:
    for other in (bundle("4.2.0"), bundle(helpers=HELPERS.replace("exports", "module"))):
        assert plotly.only_used(other) == other
    without = bundle(helpers=HELPERS.replace("if(r)throw", "if(t)throw"))
    assert plotly.only_used(without) == without


def test_the_axis_of_points_is_logarithmic_where_sizes_span_much() -> None:
    assert style.number_of_points((10, 500)).get("type") is None
    assert style.number_of_points((10, 501))["type"] == "log"
    assert style.number_of_points(()).get("type") is None
