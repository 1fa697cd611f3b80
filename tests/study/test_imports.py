"""Imports run one way, between the packages and inside them."""

import ast
from collections.abc import Iterator
from graphlib import CycleError, TopologicalSorter
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


def modules_of(root: Path) -> dict[str, str]:
    """Sources of the modules of a package by their names; a folder stands for its __init__."""
    return {
        ".".join(path.relative_to(root.parent).with_suffix("").parts).removesuffix(
            ".__init__"
        ): path.read_text(encoding="utf-8")
        for path in root.rglob("*.py")
    }


def imports_when_imported(source: str, modules: dict[str, str]) -> Iterator[str]:
    """Modules that are imported with a module: not in functions, nor for type checkers alone."""
    waiting: list[ast.stmt] = list(ast.parse(source).body)
    while waiting:
        node = waiting.pop()
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            continue
        if isinstance(node, ast.If) and "TYPE_CHECKING" in ast.unparse(node.test):
            waiting += node.orelse
            continue
        names = [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
        if isinstance(node, ast.ImportFrom) and node.module:
            inside = (f"{node.module}.{alias.name}" for alias in node.names)
            names = [name if name in modules else node.module for name in inside]
        yield from (name for name in names if name in modules)
        waiting += [child for child in ast.iter_child_nodes(node) if isinstance(child, ast.stmt)]


def needs(modules: dict[str, str]) -> dict[str, set[str]]:
    """The modules that each needs before it: those that it imports, and the folders of those."""
    graph = {}
    for name, source in modules.items():
        asked = set(imports_when_imported(source, modules))
        folders = {one.rsplit(".", k)[0] for one in asked for k in range(1, one.count(".") + 1)}
        # The folders that it is in itself are being imported already.
        graph[name] = asked | {one for one in folders if not f"{name}.".startswith(f"{one}.")}
    return graph


def test_every_module_can_be_imported_first():
    modules = {}
    for package in LAYERS:
        modules |= modules_of(Path(package.__file__).parent)
    assert len(modules) > 150
    list(TopologicalSorter(needs(modules)).static_order())  # raises CycleError


@pytest.mark.parametrize(
    "sources",
    [
        {"p": "", "p.a": "from p.b import x", "p.b": "import p.a"},
        {"p": "from p.a import x", "p.a": "import p"},
        {"p": "", "p.q": "from p.b import x", "p.q.a": "", "p.b": "import p.q.a"},
        {"p": "", "p.a": "if True:\n    from p import b", "p.b": "class C:\n    import p.a"},
    ],
    ids=["two", "its own folder", "the folder of another", "in blocks"],
)
def test_modules_that_need_one_another_are_noticed(sources):
    with pytest.raises(CycleError):
        list(TopologicalSorter(needs(sources)).static_order())


def test_imports_of_functions_and_for_types_need_nothing_first():
    late = "def f():\n    import p.b\nif TYPE_CHECKING:\n    import p.b"
    assert needs({"p": "", "p.a": late, "p.b": "import p.a"})["p.a"] == set()
