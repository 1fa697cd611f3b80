import ast
import subprocess
import sys
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


def test_every_module_can_be_imported_first():
    """In a process of its own that forgets all of ours before each."""
    modules = [
        ".".join(path.relative_to(root.parent).with_suffix("").parts)
        for package in (study, reports)
        for root in [Path(package.__file__).parent]
        for path in sorted(root.rglob("*.py"))
        if path.name != "__init__.py"
    ]
    script = (
        "import importlib, sys\n"
        "for name in sys.argv[1:]:\n"
        "    for loaded in [m for m in sys.modules if m.split('.')[0] in ('study', 'reports')]:\n"
        "        del sys.modules[loaded]\n"
        "    importlib.import_module(name)\n"
    )
    subprocess.run([sys.executable, "-c", script, *modules], check=True)
