"""Mutation testing by a seeded sample: change one thing in the code, and see whether a test fails.

The changes are cosmic-ray's operators, made in a copy of the tree. The tests of each change run in
a fork of a process that has all libraries loaded, with numba's compiler off: a second a change, not
half a minute. From the root of the tree:

    python tests/mutation/sample.py                         # every target, 60 changes each
    python tests/mutation/sample.py judging --number 200 --seed 7

Which files belong to a target, and which tests, stands in targets.toml; which survivors are known
to be harmless, and why, in survivors.md. Exits with 1 if a target's tests fail as the code stands.
"""

import argparse
import ast
import difflib
import hashlib
import os
import pickle
import random
import resource
import shutil
import sys
import tempfile
import tomllib
from collections import defaultdict
from dataclasses import dataclass
from pathlib import Path

os.environ["NUMBA_DISABLE_JIT"] = "1"

ROOT = Path(__file__).parents[2]
TARGETS = Path(__file__).with_name("targets.toml")
LIBRARIES = (
    "numpy", "numba", "pytest", "hypothesis", "scipy.optimize", "scipy.stats", "scipy.interpolate",
    "pandas", "pydantic", "statsmodels.api", "statsmodels.stats.oneway",
)  # fmt: skip
#: cosmic-ray's operators that make a plausible slip of the pen. The others (an identity test of
#: numbers, a shift of floats, a kernel without its decorator) are noticed by any call, or by none;
#: of comparisons a bound and a negation, as PIT has them: `==` is nobody's slip for `<=`.
SLIPS = {
    "arithmetic": "Add_Sub Add_Mul Sub_Add Mul_Add Mul_Div Div_Mul FloorDiv_Mul Mod_FloorDiv "
    "Mod_Mul Pow_Mul RShift_LShift LShift_RShift BitOr_BitAnd BitOr_BitXor BitAnd_BitOr "
    "BitXor_BitOr",
    "comparison": "Eq_NotEq NotEq_Eq Lt_LtE Lt_GtE LtE_Lt LtE_Gt "
    "Gt_GtE Gt_LtE GtE_Gt GtE_Lt Is_IsNot IsNot_Is",
    "unary": "USub_UAdd Delete_USub Delete_Not",
    "other": "AddNot ReplaceTrueWithFalse ReplaceFalseWithTrue ReplaceAndWithOr ReplaceOrWithAnd "
    "ReplaceBreakWithContinue ReplaceContinueWithBreak ExceptionReplacer NumberReplacer "
    "ZeroIterationForLoop",
}
PREFIX = {"arithmetic": "ReplaceBinaryOperator_", "comparison": "ReplaceComparisonOperator_",
          "unary": "ReplaceUnaryOperator_", "other": ""}  # fmt: skip
PASSED = (0, 5)  # pytest's exit codes for no failure and for no test chosen
MEMORY = 6 << 30  # bytes: a change may make an array without end


@dataclass(frozen=True)
class Mutant:
    """One change of one file."""

    file: str
    line: int
    operator: str
    code: str
    diff: str


def operators():
    """Names and operators, in a fixed order."""
    from cosmic_ray.plugins import get_operator

    for kind, names in SLIPS.items():
        for name in names.split():
            yield name, get_operator(f"core/{PREFIX[kind]}{name}")()


def functions_of(source):
    """Names of the functions of a file."""
    return {n.name for n in ast.walk(ast.parse(source)) if isinstance(n, ast.FunctionDef)}


def left_alone(source, functions):
    """Ranges of annotations, decorators and `strict` of zip, and of the functions named."""
    notes = []
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.FunctionDef) and node.name in functions:
            notes.append(node)
        notes += [getattr(node, "annotation", None), getattr(node, "returns", None)]
        notes += getattr(node, "decorator_list", [])
        if isinstance(node, ast.keyword) and node.arg == "strict":
            notes.append(node.value)
    return [
        ((n.lineno, n.col_offset), (n.end_lineno, n.end_col_offset)) for n in notes if n is not None
    ]


def left_out(files, patterns):
    """Names of the functions to leave alone, by file; a name that no file has is an error.

    `patterns` has lists of names by the names of files, or by `*` for all of the files.
    """
    there = {file: functions_of(file.read_text()) for file in files}
    chosen = {file: set() for file in files}
    for pattern, names in patterns.items():
        inside = [file for file in files if file.match(pattern)]
        for name in names:
            having = [file for file in inside if name in there[file]]
            if not having:
                sys.exit(f"not_in: no function {name} in {pattern}")
            for file in having:
                chosen[file].add(name)
    return {str(file.relative_to(ROOT)): names for file, names in chosen.items()}


def places(file, source, functions):
    """Changes that can be made, by the place where: (operator, its name, occurrence)."""
    from cosmic_ray.ast import ast_nodes, get_ast

    tree, notes = get_ast(source), left_alone(source, functions)
    found = defaultdict(list)
    for name, operator in operators():
        spots = (spot for node in ast_nodes(tree) for spot in operator.mutation_positions(node))
        for occurrence, (start, *_) in enumerate(spots):
            if not any(low <= start < high for low, high in notes):
                found[file, start].append((name, operator, occurrence))
    return found


def sample(files, number, rng, patterns):
    """Draw mutants: places without replacement, then one of the changes of each; again if few."""
    from cosmic_ray.mutating import mutate_code

    sources = {str(file.relative_to(ROOT)): file.read_text() for file in files}
    alone = left_out(files, patterns)
    by_place = {}
    for file, source in sources.items():
        by_place |= places(file, source, alone[file])
    for choices in by_place.values():
        rng.shuffle(choices)
    drawn, seen = [], set()
    while by_place and len(drawn) < number:
        order = list(by_place)
        rng.shuffle(order)
        for file, start in order:
            choices = by_place[file, start]
            name, operator, occurrence = choices.pop()
            if not choices:
                del by_place[file, start]
            code = mutate_code(sources[file], operator, occurrence)
            if code is None or code in seen:
                continue
            seen.add(code)
            lines = difflib.unified_diff(sources[file].split("\n"), code.split("\n"), n=0)
            diff = "\n".join(line for line in lines if line[:3] not in ("---", "+++", "@@ "))
            drawn.append(Mutant(file, start[0], name, code, diff))
            if len(drawn) == number:
                break
    return drawn


def tests_in(name):
    """Test modules of a directory, or the one named."""
    return sorted((ROOT / name).rglob("test_*.py")) if (ROOT / name).is_dir() else [ROOT / name]


def in_turn(file, modules, own_only):
    """Test modules in the order in which they are run: those of the file's name, then the others.

    The others are left out by `own_only`, if the file has a module of its own.
    """
    own = [module for module in modules if module.endswith(f"_{Path(file).stem}.py")]
    others = [module for module in modules if module not in own]
    return [some for some in (own, [] if own and own_only else others) if some]


class KeptEvidence:
    """A plugin of pytest: keep what runs give evidence of in files, for changes of words only.

    The evidence is named by a digest of what it is made from.
    """

    def __init__(self, folder):
        self.folder = Path(folder)

    def pytest_configure(self):
        """Put the files before the analysis."""
        from reports.study_page import gather

        made = gather.evidence_of
        self.folder.mkdir(exist_ok=True)

        def evidence_of(results):
            asked = pickle.dumps((results.frames, results.manifest, results.design))
            place = self.folder / hashlib.sha256(asked).hexdigest()
            if not place.exists():
                place.write_bytes(pickle.dumps(made(results)))
            return pickle.loads(place.read_bytes())

        gather.evidence_of = evidence_of


def run_tests(tree, arguments, limit, plugins=(), output=os.devnull):
    """Run pytest in a fork that has `limit` seconds of a processor: exit code, seconds used.

    Seconds of a clock would let a busy machine kill what no test notices.
    """
    child = os.fork()
    if child == 0:
        os.setsid()
        resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        resource.setrlimit(resource.RLIMIT_CPU, (int(limit), int(limit)))
        sink = os.open(output, os.O_WRONLY | os.O_CREAT | os.O_TRUNC)
        os.dup2(sink, 1)
        os.dup2(sink, 2)
        code = 99
        try:
            import pytest

            os.chdir(tree)
            sys.path.insert(0, str(tree))
            code = int(pytest.main(arguments, plugins=list(plugins)))
        finally:
            os._exit(code)
    _, status, used = os.wait4(child, 0)
    return os.waitstatus_to_exitcode(status), used.ru_utime + used.ru_stime


def examine(name, target, number, seed, tree):
    """Run the tests of a sample of mutants; print the survivors; return (killed, tried)."""
    modules = [str(path.relative_to(ROOT)) for name in target["tests"] for path in tests_in(name)]
    options = [
        *target.get("options", ()), "-n0", "-x", "-q", "--tb=short", "-W", "ignore",
        "-p", "no:cacheprovider", "--hypothesis-profile=mutation",
    ]  # fmt: skip
    plugins = [KeptEvidence(str(tree / "evidence"))] if target.get("keep_evidence") else []
    log = str(tree / "tests.log")
    code, seconds = run_tests(tree, [*modules, *options], 1800, plugins, log)
    if code != 0:
        print(Path(log).read_text())
        sys.exit(f"{name}: the tests fail as the code stands")
    files = sorted(file for pattern in target["files"] for file in ROOT.glob(pattern))
    mutants = sample(files, number, random.Random(f"{seed} {name}"), target.get("not_in", {}))
    killed = defaultdict(lambda: [0, 0])
    for mutant in mutants:
        place = tree / mutant.file
        before = place.read_text()
        place.write_text(mutant.code)
        survived = all(
            run_tests(tree, [*some, *options], 5 + 2 * seconds, plugins)[0] in PASSED
            for some in in_turn(mutant.file, modules, target.get("own_tests", False))
        )
        place.write_text(before)
        print("." if not survived else "s", end="", flush=True)
        killed[mutant.file][0] += not survived
        killed[mutant.file][1] += 1
        if survived:
            print(f"\nsurvived: {mutant.file}:{mutant.line} {mutant.operator}\n{mutant.diff}")
            sys.stdout.flush()
    for file, (dead, tried) in sorted(killed.items()):
        print(f"{name}: {file}: {dead} of {tried} killed")
    sys.stdout.flush()
    return sum(dead for dead, _ in killed.values()), len(mutants)


def main():
    """Examine the targets named, or all."""
    targets = tomllib.loads(TARGETS.read_text())
    parser = argparse.ArgumentParser(description="Mutation testing by a seeded sample.")
    parser.add_argument("targets", nargs="*", help=f"of {', '.join(targets)}; all if none is named")
    parser.add_argument("--number", type=int, default=60, help="changes a target")
    parser.add_argument("--seed", type=int, default=1)
    chosen = parser.parse_args()
    unknown = set(chosen.targets) - set(targets)
    if unknown:
        parser.error(f"no target {', '.join(sorted(unknown))}; there are {', '.join(targets)}")
    sys.dont_write_bytecode = True  # a stale one would stand for a change
    for library in LIBRARIES:
        __import__(library)
    total = total_killed = 0
    with tempfile.TemporaryDirectory() as folder:
        tree = Path(folder)
        skipped = shutil.ignore_patterns("__pycache__", "*.png", ".*")
        for part in ("lepp", "study", "reports", "tests"):
            shutil.copytree(ROOT / part, tree / part, ignore=skipped)
        shutil.copy(ROOT / "pyproject.toml", tree)
        for name in chosen.targets or targets:
            killed, tried = examine(name, targets[name], chosen.number, chosen.seed, tree)
            total, total_killed = total + tried, total_killed + killed
    print(f"{total_killed} of {total} killed ({total_killed / max(total, 1):.0%})")


if __name__ == "__main__":
    main()
