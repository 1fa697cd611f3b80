import errno
import json
import os
import random
import subprocess
import sys
from pathlib import Path

import pandas as pd
import pytest
from filelock import FileLock

from lepp import InputError
from study.design.design import Design
from study.results import store as store_module
from study.results.store import Store, design_of, load
from study.run.kinds import Outcome
from study.run.measures import columns_of
from study.run.triangulations import TRIANGULATIONS, Measures

DESIGN = Design.from_settings(
    {"sizes": [10, 20], "repetitions": 3, "distributions": ["uniform", "normal"], "seed": 1}
)
TASKS = TRIANGULATIONS.tasks_of(DESIGN)
MEASURES = columns_of(Measures)
FILES = tuple(
    f"{name}.parquet" for name in ("results", "histograms", "layers", "regions", "point_sets")
)


def outcome(task, error=None, duration=0.25):
    """What a worker could send: numbers that depend on the task, floats with all their digits."""
    draw = random.Random(str(task))
    if error is not None:
        return TRIANGULATIONS.failed(task, DESIGN, error)
    measures = [
        draw.randrange(1000) if column.type is int else draw.random() for column in MEASURES
    ]
    method = DESIGN.methods[0]
    bars = [(method, size, draw.randrange(1, 99)) for size in range(1, draw.randrange(2, 9))]
    checks = [draw.random() for _ in range(3)]
    rows = {
        "results": [(method, *measures, None)],
        "histograms": bars,
        "layers": [(method, 0, *bar) for _, *bar in bars],
        "regions": bars[:1],
        "point_sets": [(float("nan") if task.replicate == 0 else draw.random(), *checks)],
        "timings": [("", "sample", duration), (method, "lepp", duration)],
    }
    return Outcome(task, rows, 2 * duration, worker="tcp://w")


def fill(directory, tasks=TASKS, **options):
    with Store(directory, TRIANGULATIONS, DESIGN) as store:
        store.add([outcome(task, **options) for task in tasks])
        store.finish()


def contents(directory):
    return {name: (directory / name).read_bytes() for name in (*FILES, "manifest.json")}


@pytest.fixture
def whole(tmp_path):
    fill(tmp_path / "whole")
    return tmp_path / "whole"


def test_what_was_added_is_loaded_in_the_order_of_the_design(tmp_path):
    fill(tmp_path, TASKS[::-1])
    loaded = load(tmp_path)
    assert loaded.complete
    assert loaded.design == DESIGN
    keys = ["distribution", "n_points", "replicate"]
    for name in ("results", "point_sets", "histograms", "timings"):
        frame = loaded[name].astype(object)
        groups = frame.groupby(keys, sort=False)[[c for c in frame if c not in (*keys, "worker")]]
        for (key, group), task in zip(groups, TASKS, strict=True):
            assert key == task
            rows = outcome(task).rows[name]
            for row, cells in zip(group.itertuples(index=False), rows, strict=True):
                assert all(
                    a == b or (pd.isna(a) and pd.isna(b)) for a, b in zip(row, cells, strict=True)
                )
    assert len(loaded["regions"]) == len(TASKS)
    assert (loaded["timings"]["worker"] == "tcp://w").all()
    with pytest.raises(KeyError):
        loaded["histogram"]


def test_the_bytes_depend_on_nothing_but_the_design(tmp_path, whole):
    shuffled = random.Random(3).sample(TASKS, len(TASKS))
    with Store(tmp_path / "other", TRIANGULATIONS, DESIGN) as store:
        for task in shuffled[:7]:
            store.add([outcome(task, duration=0.5)])
    with Store(tmp_path / "other", TRIANGULATIONS, DESIGN) as store:
        assert store.unfinished == [task for task in TASKS if task in shuffled[7:]]
        store.add([outcome(task, duration=0.75) for task in shuffled[5:]])  # two of them again
        store.finish()
    assert contents(tmp_path / "other") == contents(whole)
    assert not (tmp_path / "other" / "journal.jsonl").exists()


def test_an_incomplete_run_is_loaded_from_its_journal(tmp_path):
    with Store(tmp_path, TRIANGULATIONS, DESIGN) as store:
        store.add([outcome(task) for task in TASKS[3:6]])
        during = load(tmp_path)
    for loaded in (during, load(tmp_path)):
        assert not loaded.complete
        assert len(loaded["results"]) == 3
        assert loaded.manifest["complete"] is False
    assert loaded["results"].dtypes.equals(load_complete_dtypes(tmp_path / "complete"))


def load_complete_dtypes(directory):
    fill(directory)
    return load(directory)["results"].dtypes


def test_a_run_without_any_result_has_empty_frames(tmp_path):
    Store(tmp_path, TRIANGULATIONS, DESIGN).close()
    loaded = load(tmp_path)
    assert not loaded.complete
    assert loaded["results"].empty
    assert loaded["histograms"].empty


def test_failures_are_rows_and_are_tried_again(tmp_path, whole):
    directory = tmp_path / "failing"
    with Store(directory, TRIANGULATIONS, DESIGN) as store:
        store.add([outcome(task) for task in TASKS[1:]])
        store.add([outcome(TASKS[0], error="InputError: no")])
        store.finish()
        assert [failure.task for failure in store.failures] == TASKS[:1]
    loaded = load(directory)
    assert loaded.complete
    assert loaded.manifest["failed"] == 1
    assert loaded["results"]["error"].iloc[0] == "InputError: no"
    assert loaded["results"]["error"].iloc[1:].isna().all()
    assert loaded["results"]["n_triangles"].dtype == pd.Int64Dtype()
    assert loaded["results"].loc[0, [column.name for column in MEASURES]].isna().all()

    with Store(directory, TRIANGULATIONS, DESIGN) as store:
        assert store.unfinished == TASKS[:1]
    assert not load(directory).complete  # it was cut short while trying again
    with Store(directory, TRIANGULATIONS, DESIGN) as store:
        store.add([outcome(TASKS[0])])
        store.finish()
    assert contents(directory) == contents(whole)
    assert not (directory / "journal.jsonl").exists()


def test_a_success_is_not_replaced(tmp_path):
    with Store(tmp_path, TRIANGULATIONS, DESIGN) as store:
        assert len(store.add([outcome(TASKS[0])])) == 1
        assert store.add([outcome(TASKS[0], error="late")]) == []
        assert store.unfinished == TASKS[1:]


def test_a_complete_directory_is_left_alone(whole):
    before = contents(whole), sorted(path.name for path in whole.iterdir())
    with Store(whole, TRIANGULATIONS, DESIGN) as store:
        assert store.unfinished == []
        assert store.failures == []
        store.finish()
    assert (contents(whole), sorted(path.name for path in whole.iterdir())) == before


class Killed(BaseException):
    pass


def kill_at_step(patch, step):
    """Let that many changes of the directory happen, and no more."""

    def counted(change):
        def call(*args, **kwargs):
            nonlocal step
            step -= 1
            if step < 0:
                raise Killed
            return change(*args, **kwargs)

        return call

    for place, name in ((os, "open"), (os, "fsync"), (os, "replace"), (Path, "unlink")):
        patch.setattr(place, name, counted(getattr(place, name)))


@pytest.mark.parametrize("failed", [False, True])
def test_a_death_at_any_moment_of_the_end_is_survived(tmp_path, whole, monkeypatch, failed):
    """Stop before every change that the end makes to the directory, then go on."""
    finished = False
    steps = 0
    while not finished:
        directory = tmp_path / f"{steps}"
        if failed:
            fill_with_failure(directory)
        store = Store(directory, TRIANGULATIONS, DESIGN)
        store.add([outcome(task) for task in TASKS])
        with monkeypatch.context() as patch:
            kill_at_step(patch, steps)
            try:
                store.finish()
                finished = True
            except Killed:
                steps += 1
        store._lock.release()  # as the death of the process does
        assert len(load(directory)["results"]) == len(TASKS)
        with Store(directory, TRIANGULATIONS, DESIGN) as store:
            assert store.unfinished == []
            store.finish()
        assert contents(directory) == contents(whole)
        assert not (directory / "journal.jsonl").exists()
    assert steps >= 20  # six files are made, flushed and renamed, the journal removed


def fill_with_failure(directory):
    with Store(directory, TRIANGULATIONS, DESIGN) as store:
        store.add([outcome(task) for task in TASKS[1:]])
        store.add([outcome(TASKS[0], error="InputError: no")])
        store.finish()


def copied_without_its_journal(tmp_path, name):
    fill_with_failure(tmp_path / name)
    (tmp_path / name / "journal.jsonl").unlink()
    return tmp_path / name


def test_a_run_with_failures_needs_no_journal(tmp_path, whole):
    directory = copied_without_its_journal(tmp_path, "copied")
    before = load(directory)["results"]
    assert len(before) == len(TASKS)
    with Store(directory, TRIANGULATIONS, DESIGN) as store:
        assert store.unfinished == TASKS[:1]
        assert [failure.error for failure in store.failures] == ["InputError: no"]
    after = load(directory)  # stopped at once
    pd.testing.assert_frame_equal(after["results"], before)
    assert not after.complete
    with Store(directory, TRIANGULATIONS, DESIGN) as store:
        store.add([outcome(TASKS[0])])
        store.finish()
    assert contents(directory) == contents(whole)


def test_a_death_at_any_moment_of_taking_up_failures_is_survived(tmp_path, monkeypatch):
    finished = False
    steps = 0
    while not finished:
        directory = copied_without_its_journal(tmp_path, f"{steps}")
        rows = load(directory)["results"]
        with monkeypatch.context() as patch:
            kill_at_step(patch, steps)
            # The making of the lock is no step, and the death of a process releases it.
            patch.setattr(store_module, "locked", lambda *_: FileLock(tmp_path / "none"))
            try:
                Store(directory, TRIANGULATIONS, DESIGN)
                finished = True
            except Killed:
                steps += 1
        pd.testing.assert_frame_equal(load(directory)["results"], rows)
        with Store(directory, TRIANGULATIONS, DESIGN) as store:
            assert store.unfinished == TASKS[:1]
    assert steps >= 6


def test_a_run_that_ends_while_it_is_read_is_read_whole(tmp_path, monkeypatch):
    store = Store(tmp_path, TRIANGULATIONS, DESIGN)
    store.add([outcome(task) for task in TASKS])
    read_journal = store_module.read_journal

    def late(*arguments):
        store.finish()
        return read_journal(*arguments)

    monkeypatch.setattr(store_module, "read_journal", late)
    loaded = load(tmp_path)
    store.close()
    assert loaded.complete
    assert len(loaded["results"]) == len(TASKS)


def test_a_run_that_begins_again_while_it_is_read_is_read_whole(tmp_path, monkeypatch):
    fill_with_failure(tmp_path)
    check_files = store_module._check_files

    def late(*arguments):
        monkeypatch.setattr(store_module, "_check_files", check_files)
        fill(tmp_path, TASKS[:1])
        check_files(*arguments)

    monkeypatch.setattr(store_module, "_check_files", late)
    assert load(tmp_path)["results"]["error"].isna().all()


@pytest.mark.parametrize("number", [errno.ENOSYS, errno.ENOLCK, errno.ENOTSUP])
def test_a_file_system_without_locks_is_told(tmp_path, monkeypatch, number):
    fcntl = pytest.importorskip("fcntl", reason="locks of POSIX")

    def none(*_):
        raise OSError(number, os.strerror(number))

    monkeypatch.setattr(fcntl, "flock", none)
    notes = []
    with Store(tmp_path, TRIANGULATIONS, DESIGN, notes.append) as store:
        store.add([outcome(TASKS[0])])
    assert len(notes) == 1
    assert notes[0].startswith(f"The file system of {tmp_path} has no locks: see to it")
    assert len(load(tmp_path)["results"]) == 1


def test_another_error_of_the_lock_is_not_told_as_another_run(tmp_path, monkeypatch):
    fcntl = pytest.importorskip("fcntl", reason="locks of POSIX")

    def fail(*_):
        raise OSError(errno.EIO, os.strerror(errno.EIO))

    monkeypatch.setattr(fcntl, "flock", fail)
    with pytest.raises(InputError, match=r"Cannot write into .*: Input/output error"):
        Store(tmp_path, TRIANGULATIONS, DESIGN)


WRITER = """
import sys
from pathlib import Path
from test_store import DESIGN, TRIANGULATIONS, Store, outcome
with Store(Path(sys.argv[1]), TRIANGULATIONS, DESIGN) as store:
    print("open", flush=True)
    for task in store.unfinished:
        store.add([outcome(task)])
        print(task, flush=True)
    sys.stdin.read()
"""


def start_writer(directory):
    process = subprocess.Popen(
        [sys.executable, "-c", WRITER, str(directory)],
        cwd=Path(__file__).parent,
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    )
    assert process.stdout.readline() == "open\n"
    return process


def test_two_runs_do_not_share_a_directory_and_a_dead_one_lets_go(tmp_path, whole):
    directory = tmp_path / "shared"
    process = start_writer(directory)
    try:
        with pytest.raises(InputError, match=r"Another run is writing into .*shared"):
            Store(directory, TRIANGULATIONS, DESIGN)
        for _ in range(4):
            process.stdout.readline()
    finally:
        process.kill()
        process.communicate()
    with Store(directory, TRIANGULATIONS, DESIGN) as store:
        assert len(store.unfinished) <= len(TASKS) - 4
        store.add([outcome(task) for task in store.unfinished])
        store.finish()
    assert contents(directory) == contents(whole)


def cut_short(directory):
    with Store(directory, TRIANGULATIONS, DESIGN) as store:
        store.add([outcome(task) for task in TASKS[:5]])
    return directory / "journal.jsonl"


@pytest.mark.parametrize("kept", [1, 40, -1])
def test_a_torn_last_line_is_dropped(tmp_path, whole, kept):
    journal = cut_short(tmp_path / "torn")
    lines = journal.read_bytes().splitlines(keepends=True)
    journal.write_bytes(b"".join(lines[:-1]) + lines[-1][:kept])
    assert len(load(tmp_path / "torn")["results"]) == 4
    with Store(tmp_path / "torn", TRIANGULATIONS, DESIGN) as store:
        assert store.unfinished == TASKS[4:]
        store.add([outcome(task) for task in TASKS[4:7]])
    with Store(
        tmp_path / "torn", TRIANGULATIONS, DESIGN
    ) as store:  # what followed the torn line is whole
        assert store.unfinished == TASKS[7:]
        store.add([outcome(task) for task in TASKS[7:]])
        store.finish()
    assert contents(tmp_path / "torn") == contents(whole)


def test_a_damaged_line_is_named_and_can_be_deleted(tmp_path):
    journal = cut_short(tmp_path)
    lines = journal.read_bytes().splitlines(keepends=True)
    for damaged in (lines[2].replace(b"0.", b"1.", 1), b"\n", b"{}\n", lines[2][:-9] + b"\n"):
        before = b"".join([*lines[:2], damaged, *lines[3:]])
        journal.write_bytes(before)
        for read in (load, lambda directory: Store(directory, TRIANGULATIONS, DESIGN)):
            with pytest.raises(InputError, match=r"journal\.jsonl, line 3, is damaged: delete"):
                read(tmp_path)
        assert journal.read_bytes() == before
    journal.write_bytes(b"".join([*lines[:2], *lines[3:]]))
    with Store(tmp_path, TRIANGULATIONS, DESIGN) as store:
        assert store.unfinished == [TASKS[2], *TASKS[5:]]


def test_another_design_is_refused_with_the_setting_that_differs(whole):
    before = contents(whole)
    for settings, words in (
        ({"seed": 2}, "seed is 1 there and 2 here"),
        ({"sizes": [10, 30]}, "sizes is 10, 20 there and 10, 30 here"),
        ({"correlation": 0.4}, "correlation is 0.5 there and 0.4 here"),
    ):
        other = Design.from_settings(DESIGN.model_dump() | settings)
        with pytest.raises(InputError) as caught:
            Store(whole, TRIANGULATIONS, other)
        assert words in str(caught.value)
    assert contents(whole) == before
    with Store(whole, TRIANGULATIONS, DESIGN) as store:  # nothing was left locked
        assert store.unfinished == []


def test_a_run_that_never_had_a_result_keeps_no_other_design_out(tmp_path):
    Store(tmp_path, TRIANGULATIONS, Design.from_settings(DESIGN.model_dump() | {"seed": 2})).close()
    fill(tmp_path)
    assert load(tmp_path).design == DESIGN


def test_a_foreign_directory_is_refused_untouched(tmp_path):
    (tmp_path / "thesis.tex").write_text("mine")
    with pytest.raises(InputError, match="is not empty and holds no results of lepp-study"):
        Store(tmp_path, TRIANGULATIONS, DESIGN)
    assert [path.name for path in tmp_path.iterdir()] == ["thesis.tex"]
    with pytest.raises(InputError, match=r"thesis\.tex is a file: give a directory"):
        Store(tmp_path / "thesis.tex", TRIANGULATIONS, DESIGN)
    with pytest.raises(InputError, match="holds no results of lepp-study"):
        load(tmp_path)
    assert design_of(tmp_path) is None


def test_a_death_before_the_first_manifest_is_survived(tmp_path):
    (tmp_path / ".lock").touch()
    (tmp_path / ".manifest.json.0a1b.tmp").write_text("{")
    (tmp_path / ".DS_Store").touch()
    Store(tmp_path, TRIANGULATIONS, DESIGN).close()
    assert design_of(tmp_path) == (TRIANGULATIONS, DESIGN)


# /proc refuses new directories to everybody, root included, whom permissions do not stop.
@pytest.mark.skipif(not Path("/proc/self").exists(), reason="needs a file system without writing")
def test_a_directory_that_cannot_be_written_is_named():
    with pytest.raises(InputError, match="Cannot write into /proc/results: "):
        Store(Path("/proc/results"), TRIANGULATIONS, DESIGN)


def test_a_disk_that_is_full_in_the_middle_of_a_line_is_named(tmp_path):
    resource = pytest.importorskip("resource", reason="limits of file sizes are POSIX")
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    with Store(tmp_path, TRIANGULATIONS, DESIGN) as store:
        store.add([outcome(TASKS[0])])
        size = (tmp_path / "journal.jsonl").stat().st_size
        resource.setrlimit(resource.RLIMIT_FSIZE, (size + 50, hard))
        try:
            with pytest.raises(InputError, match=r"Cannot write into .*: File too large"):
                store.add([outcome(TASKS[1])])
        finally:
            resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))
    with Store(tmp_path, TRIANGULATIONS, DESIGN) as store:
        assert store.unfinished == TASKS[1:]


def edit(path):
    content = bytearray(path.read_bytes())
    content[len(content) // 2] ^= 1
    path.write_bytes(content)


@pytest.mark.parametrize("name", FILES)
def test_edited_and_missing_files_are_named(whole, name):
    edit(whole / name)
    with pytest.raises(InputError, match=f"{name} was cut short or edited since its run"):
        load(whole)
    with pytest.raises(InputError, match=f"{name} was cut short or edited since its run"):
        Store(whole, TRIANGULATIONS, DESIGN)
    (whole / name).unlink()
    with pytest.raises(InputError, match=f"{name} is missing"):
        load(whole)


@pytest.mark.parametrize("harm", [Path.unlink, lambda path: path.write_bytes(b"PAR1")])
def test_timings_may_be_lost(whole, harm):
    harm(whole / "timings.parquet")
    loaded = load(whole)
    assert loaded.complete
    assert loaded["timings"].empty
    assert len(loaded["results"]) == len(TASKS)
    with Store(whole, TRIANGULATIONS, DESIGN) as store:
        assert store.unfinished == []


@pytest.mark.parametrize("harm", [edit, Path.unlink])
def test_what_is_damaged_is_computed_again_on_request(whole, harm):
    before = contents(whole)
    harm(whole / "layers.parquet")
    notes = []
    with Store(whole, TRIANGULATIONS, DESIGN, notes.append, repair=True) as store:
        assert store.unfinished == TASKS
        store.add([outcome(task) for task in TASKS])
        store.finish()
    assert contents(whole) == before
    (note,) = notes
    assert "layers.parquet" in note
    assert note.endswith("run with --repair. Its study is computed again.")


def test_damaged_lines_are_left_out_on_request(tmp_path, whole):
    journal = cut_short(tmp_path / "cut")
    lines = journal.read_bytes().splitlines(keepends=True)
    journal.write_bytes(b"".join([lines[0], b"{}\n", *lines[2:4], b"\n", *lines[4:]]))
    notes = []
    with Store(tmp_path / "cut", TRIANGULATIONS, DESIGN, notes.append, repair=True) as store:
        assert store.unfinished == [TASKS[1], *TASKS[5:]]
        assert journal.read_bytes() == b"".join([lines[0], *lines[2:]])
        store.add([outcome(task) for task in store.unfinished])
        store.finish()
    assert contents(tmp_path / "cut") == contents(whole)
    assert notes == [f"2 damaged lines of {journal} are left out and computed again."]


LARGER = Design.from_settings(
    {"sizes": [10, 15, 20], "repetitions": [4, 1, 3], "seed": 1}
    | {"distributions": ["uniform", "normal", "exponential"]}
)


def fresh(directory, design):
    """Fill a directory with a larger design at once."""
    with Store(directory, TRIANGULATIONS, design) as store:
        store.add([outcome(task) for task in store.tasks])
        store.finish()
    return contents(directory)


@pytest.mark.parametrize("begun", ["finished", "with failures", "cut short"])
def test_a_smaller_design_is_gone_on_from(tmp_path, begun):
    directory = tmp_path / "run"
    failed = {TASKS[2]} if begun == "with failures" else set()
    with Store(directory, TRIANGULATIONS, DESIGN) as store:
        some = TASKS[:5] if begun == "cut short" else TASKS
        store.add([outcome(task, error="no" if task in failed else None) for task in some])
        if begun != "cut short":
            store.finish()
    with pytest.raises(InputError, match=r"another directory, or --extend to go on from them\."):
        Store(directory, TRIANGULATIONS, LARGER)
    for _ in range(2):  # the first leaves before anything is computed
        with Store(directory, TRIANGULATIONS, LARGER, extend=True) as store:
            left = [task for task in store.tasks if task not in set(some) - failed]
            assert store.unfinished == left
            assert len(load(directory)["results"]) == len(some)
    with Store(directory, TRIANGULATIONS, LARGER) as store:  # from now on it is the design
        store.add([outcome(task) for task in left])
        store.finish()
    assert contents(directory) == fresh(tmp_path / "fresh", LARGER)
    assert load(directory).complete
    with Store(directory, TRIANGULATIONS, LARGER, extend=True) as store:
        assert store.unfinished == []


@pytest.mark.parametrize(
    "change",
    [
        {"seed": 2},
        {"correlation": 0.25},
        {"methods": ["incremental", "delaunay"]},
        {"repetitions": [4, 1, 2]},
        {"sizes": [10, 15, 25]},
        {"distributions": ["uniform", "exponential"]},
    ],
    ids=lambda change: next(iter(change)),
)
def test_only_a_design_that_is_contained_is_gone_on_from(whole, change):
    before = contents(whole)
    other = Design.from_settings(LARGER.model_dump() | change)
    for extend in (False, True):
        with pytest.raises(InputError, match=r"\): give another directory\.$"):
            Store(whole, TRIANGULATIONS, other, extend=extend)
    assert contents(whole) == before


def test_a_design_that_stops_later_is_another(whole):
    both = {"methods": ["incremental", "delaunay"]}
    stops, goes_on = (
        Design.from_settings(LARGER.model_dump() | both | {"largest": largest})
        for largest in ({"delaunay": 10}, {})
    )
    assert not goes_on.contains(stops)
    assert not goes_on.contains(DESIGN)
    assert stops.contains(stops)


def test_a_death_while_it_is_extended_loses_nothing(whole, monkeypatch):
    before = load(whole)

    def killed(*_):
        raise KeyboardInterrupt

    with monkeypatch.context() as patch:
        patch.setattr(store_module, "write_manifest", killed)
        with pytest.raises(KeyboardInterrupt):
            Store(whole, TRIANGULATIONS, LARGER, extend=True)
    assert load(whole).complete
    pd.testing.assert_frame_equal(load(whole)["results"], before["results"])
    with Store(whole, TRIANGULATIONS, LARGER, extend=True) as store:
        assert len(store.unfinished) == len(store.tasks) - len(TASKS)


def test_the_parts_of_large_tables_are_put_in_order(tmp_path, monkeypatch):
    """Files that are made in many parts hold the rows of those made in one, in the same order."""
    design = Design.from_settings(DESIGN.model_dump() | {"methods": ["incremental", "delaunay"]})

    def both(task):
        one = outcome(task)
        twice = {
            name: [*cells, *((design.methods[1], *rest) for first, *rest in cells if first)]
            for name, cells in one.rows.items()
        }
        return Outcome(task, twice | {"point_sets": one.rows["point_sets"]}, worker="tcp://w")

    def made(name):
        with Store(tmp_path / name, TRIANGULATIONS, design) as store:
            store.add([both(task) for task in TASKS])
            store.finish()
        return load(tmp_path / name)

    in_one = made("one")
    monkeypatch.setattr("study.results.tables.TASKS_AT_A_TIME", 5)
    in_parts = made("parts")
    for name, frame in in_one.frames.items():
        pd.testing.assert_frame_equal(frame, in_parts[name])
    methods = in_parts["results"]["method"].tolist()
    assert methods == sorted(methods, key=design.methods.index)
    assert len(methods) == 2 * len(TASKS)
    assert sorted(path.name for path in (tmp_path / "parts").iterdir()) == sorted(
        path.name for path in (tmp_path / "one").iterdir()
    )


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda text: text[: len(text) // 2], "was cut short or edited"),
        (lambda text: "[]", "was cut short or edited"),
        (lambda text: text.replace('"tasks"', '"task"'), "was cut short or edited"),
        (lambda text: text.replace('"sha256"', '"sha"'), "was cut short or edited"),
        (lambda text: text.replace('"format": 4', '"format": 99'), "is of format 99, and this"),
        (lambda text: text.replace('"seed": 1', '"seed": 2'), "was cut short or edited"),
        (lambda text: text.replace('"failed": 0', '"failed": 1'), "was cut short or edited"),
    ],
)
def test_a_wrong_manifest_is_named(whole, change, words):
    path = whole / "manifest.json"
    path.write_text(change(path.read_text()))
    for read in (load, design_of, lambda directory: Store(directory, TRIANGULATIONS, DESIGN)):
        with pytest.raises(InputError) as caught:
            read(whole)
        assert words in str(caught.value)
        assert "manifest.json" in str(caught.value)


def test_the_manifest_tells_of_every_environment_of_a_run(tmp_path, monkeypatch):
    cut_short(tmp_path)
    newer = store_module.environment()
    newer["packages"] = newer["packages"] | {"numpy": "99.0"}
    monkeypatch.setattr(store_module, "environment", lambda: newer)
    fill(tmp_path, TASKS[5:])
    environments = json.loads((tmp_path / "manifest.json").read_text())["environments"]
    assert [e["packages"]["numpy"] == "99.0" for e in environments] == [True, False]
