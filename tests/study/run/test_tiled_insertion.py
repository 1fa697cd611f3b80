"""A plain insertion in stages gives the rows of one that is done at once."""

import shutil
from dataclasses import replace
from types import SimpleNamespace

import pytest

import study.run.tiled_insertion as tiled
from lepp import InputError
from study.design import sampling
from study.design.design import Design
from study.design.sampling import DISTRIBUTIONS
from study.results.store import Store
from study.run.cluster import ClusterOptions
from study.run.kinds import Stage
from study.run.runner import STAGES, compute, run
from study.run.triangulations import TRIANGULATIONS, Task

from faults import Heard, contents  # isort: skip

DESIGN = Design.from_settings({"methods": ["incremental"], "sizes": [20_500], "repetitions": 2})


@pytest.fixture
def small(monkeypatch):
    """Blocks and tiles so small that there are many."""
    for module in (sampling, tiled):
        monkeypatch.setattr(module, "BLOCK", 4000)
    monkeypatch.setattr(tiled, "OPENING", 1500)
    monkeypatch.setattr(tiled, "_TOGETHER", 2500)


def staged(directory, distribution="uniform", replicate=0):
    task = Task(distribution, 20_500, replicate)
    return TRIANGULATIONS.in_stages(task, DESIGN, directory / STAGES / "one", 10**9)


def finish(parts):
    """Do all jobs that are left, the last of each stage first; return their stages and numbers."""
    done = []
    for stage in parts.stages():
        for job in reversed(stage.jobs):
            parts.perform(stage.name, job)
            done.append((stage.name, job))
    return done


@pytest.mark.parametrize("distribution", DISTRIBUTIONS)
def test_rows_are_those_of_the_whole(tmp_path, small, distribution):
    parts = staged(tmp_path, distribution, replicate=1)
    done = finish(parts)
    assert len([job for name, job in done if name == "locate"]) == 6
    assert len([job for name, job in done if name == "count"]) > 6
    outcome = parts.outcome()
    whole = TRIANGULATIONS.perform(outcome.task, DESIGN)
    for table in TRIANGULATIONS.tables:
        if table != "timings":
            assert outcome.rows[table] == whole.rows[table], table
    stages = {(method, stage) for method, stage, _ in outcome.rows["timings"]}
    assert stages == {(method, stage) for method, stage, _ in whole.rows["timings"]}
    assert outcome.seconds == pytest.approx(sum(row[-1] for row in outcome.rows["timings"]))
    parts.close()
    assert list(tmp_path.iterdir()) == []


def test_no_job_is_done_twice(tmp_path, small):
    shares = {}
    for stage in staged(tmp_path).stages():
        shares[stage.name] = stage.share * len(stage.jobs)
        half = stage.jobs[: len(stage.jobs) // 2]
        for job in half:
            staged(tmp_path).perform(stage.name, job)
        again = next(s for s in staged(tmp_path).stages() if s.jobs)  # as after a kill
        assert again == Stage(stage.name, stage.words, stage.jobs[len(half) :], stage.share)
        for job in again.jobs:
            staged(tmp_path).perform(stage.name, job)
    assert finish(staged(tmp_path)) == []
    assert sum(shares.values()) == pytest.approx(1)
    whole = TRIANGULATIONS.perform(Task("uniform", 20_500, 0), DESIGN)
    assert staged(tmp_path).outcome().rows["layers"] == whole.rows["layers"]


def have_free(monkeypatch, n_bytes):
    monkeypatch.setattr(shutil, "disk_usage", lambda path: SimpleNamespace(free=n_bytes))


def test_points_have_to_fit_on_the_disk(tmp_path, small, monkeypatch):
    needed = 20_500 * 22
    have_free(monkeypatch, needed - 1)
    with pytest.raises(InputError, match=r"20,500 points take 0\.0 GB of disk"):
        staged(tmp_path).check_disk()
    assert list(tmp_path.iterdir()) == []
    have_free(monkeypatch, needed)
    staged(tmp_path).check_disk()
    finish(staged(tmp_path))
    # What is there already is not asked for again.
    have_free(monkeypatch, 0)
    staged(tmp_path).check_disk()


def test_a_run_that_lacks_disk_for_its_last_task_does_not_begin(tmp_path, small, monkeypatch):
    have_free(monkeypatch, 20_500 * 22 - 1)
    settings = {"methods": ["incremental"], "distributions": ["uniform"], "sizes": [100, 20_500]}
    design = Design.from_settings(settings | {"repetitions": 1})
    workers = SimpleNamespace(look=lambda: None, now=1, largest=1_000_000, memory=None)
    with Store(tmp_path, TRIANGULATIONS, design) as store:
        outcomes = compute(workers, waiting=None, store=store, listener=None)
        with pytest.raises(InputError, match="of disk beside the results"):
            next(outcomes)


def test_only_plain_insertion_by_itself_is_staged(tmp_path):
    task = Task("uniform", 10**9, 0)
    settings = {"methods": ["incremental", "delaunay"], "sizes": [2 * 10**8], "repetitions": 1}
    both = Design.from_settings(settings)
    assert TRIANGULATIONS.in_stages(task, both, tmp_path, 10**9) is None
    assert TRIANGULATIONS.least_memory_of(task, both).n_bytes > 100e9
    assert not TRIANGULATIONS.is_at_once(task, DESIGN, memory=1e15)  # no mesh has so many points
    assert TRIANGULATIONS.least_memory_of(task, DESIGN).n_bytes == tiled.LEAST_MEMORY
    stops = both.model_copy(update={"largest": {"delaunay": 1000}})
    assert TRIANGULATIONS.in_stages(task, stops, tmp_path, 10**9) is not None
    assert TRIANGULATIONS.in_stages(Task("uniform", 1000, 0), stops, tmp_path, 10**9) is None
    assert TRIANGULATIONS.least_memory_of(task, stops).n_bytes == tiled.LEAST_MEMORY


@pytest.mark.cluster
def test_workers_with_little_memory_give_the_same_bytes(tmp_path):
    design = Design.from_settings(
        {"methods": ["incremental"], "distributions": ["exponential"], "sizes": [1000, 600_000]}
        | {"repetitions": 1}
    )
    much = ClusterOptions(workers=2)
    run(tmp_path / "much", TRIANGULATIONS, design, options=much, listener=Heard())

    class StopError(Exception):
        pass

    class Stopping(Heard):
        def note(self, sentence):
            super().note(sentence)
            if sentence.startswith("Triangulating tiles"):
                raise StopError

    little = replace(much, worker_memory=400_000_000)
    with pytest.raises(StopError):
        run(tmp_path / "little", TRIANGULATIONS, design, options=little, listener=Stopping())
    (parts,) = (tmp_path / "little" / STAGES).iterdir()
    assert parts.name == "exponential-600000-0"
    heard = Heard()
    run(tmp_path / "little", TRIANGULATIONS, design, options=little, listener=heard)
    assert not [note for note in heard.notes if note.startswith("Sending")]  # done before
    assert 0.5 * 600_000 < heard.parts <= 0.6 * 600_000
    assert contents(tmp_path / "little") == contents(tmp_path / "much")
    assert not (tmp_path / "little" / STAGES).exists()


@pytest.mark.cluster
def test_a_job_that_fails_fails_its_task_alone(tmp_path, monkeypatch):
    design = Design.from_settings(
        {"methods": ["incremental"], "distributions": ["uniform"], "sizes": [1000, 600_000]}
        | {"repetitions": 1}
    )
    # A directory in the place of a job's file.
    options = ClusterOptions(workers=1, worker_memory=400_000_000)
    directory = tmp_path / STAGES / "uniform-600000-0"
    with Store(tmp_path, TRIANGULATIONS, design):
        (directory / "hull-0.pickle" / "x").mkdir(parents=True)
    summary = run(tmp_path, TRIANGULATIONS, design, options=options, listener=Heard())
    (failed,) = summary.failures
    assert failed.task == Task("uniform", 600_000, 0)
    assert "hull-0" in failed.error
    assert not (tmp_path / STAGES).exists()
