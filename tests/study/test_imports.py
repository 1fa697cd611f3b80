import ast
from pathlib import Path

import pytest

import lepp
import reports
import study

LAYERS = {lepp: set(), study: {"lepp"}, reports: {"lepp", "study"}}
OUTSIDE_LEPP = {"dask", "distributed", "pandas", "plotly", "meshio", "statsmodels", "click", "rich"}


def imported(source: str) -> set[str]:
    names = set()
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            names |= {alias.name.partition(".")[0] for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module:
            names.add(node.module.partition(".")[0])
    return names


@pytest.mark.parametrize("package", LAYERS, ids=lambda p: p.__name__)
def test_imports_run_one_way(package):
    ours = {layer.__name__ for layer in LAYERS}
    forbidden = ours - LAYERS[package] - {package.__name__}
    if package is lepp:
        forbidden |= OUTSIDE_LEPP
    sources = sorted(Path(package.__file__).parent.rglob("*.py"))
    assert sources
    for path in sources:
        assert not imported(path.read_text(encoding="utf-8")) & forbidden, path
