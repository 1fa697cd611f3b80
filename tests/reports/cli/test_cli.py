import errno
import os
import subprocess
import sys
from contextlib import contextmanager
from pathlib import Path
from time import sleep

import pytest
from click.testing import CliRunner
from distributed import Client, LocalCluster
from tiny_runs import store_run

from reports.cli.main import main
from reports.cli.parameters import Duration
from study.design.design import Design, preset_names
from study.results.store import Store, load
from study.run.local import LocalWorkers
from study.run.triangulations import TRIANGULATIONS, Triangulations

SETTINGS = """\
distributions = ["uniform", "normal"]
sizes = [200, 400, 800]
repetitions = 4
seed = 3
"""


@pytest.fixture
def config(tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text(SETTINGS)
    return path


@contextmanager
def in_process(n_threads):
    """A local cluster in threads of this process."""
    with (
        LocalCluster(
            n_workers=1,
            threads_per_worker=n_threads,
            processes=False,
            dashboard_address=None,
            scheduler_kwargs={"dashboard_address": "127.0.0.1:0"},
        ) as cluster,
        Client(cluster) as client,
    ):
        yield client, cluster


@pytest.fixture
def threads(monkeypatch):
    """The local cluster of a run, in threads of this process."""

    @contextmanager
    def connect(kind, design, options, note):
        with in_process(2) as (client, cluster):
            yield LocalWorkers(client, cluster, 1)

    monkeypatch.setattr("study.run.runner.connect", connect)


def lepp_study(*arguments):
    return CliRunner().invoke(main, [str(argument) for argument in arguments])


@pytest.mark.cluster
def test_a_run_from_the_shell_ends_with_a_report_and_a_second_computes_nothing(tmp_path, config):
    def shell(*arguments):
        script = Path(sys.executable).with_name("lepp-study")
        return subprocess.run(
            [script, *arguments], cwd=tmp_path, capture_output=True, text=True, check=False
        )

    first = shell("run", "--config", config, "--workers", "1")
    assert first.returncode == 0, first.stderr
    assert first.stderr == ""
    lines = first.stdout.splitlines()
    if lines[0] == Triangulations.preparing:  # on a slow machine, or where it had to compile
        del lines[0]
    assert lines[0] == "24 triangulations to compute, 11,200 points"
    assert lines[-2].startswith("24 triangulations, 11,200 points, in ")
    assert lines[-1] == f"Report: {Path('results/mine/report.html')}"
    results = tmp_path / "results" / "mine"
    assert load(results).complete
    page = (results / "report.html").read_bytes()
    assert list((results / "tables").glob("*.csv"))

    (results / "report.html").unlink()
    second = shell("run", results)
    assert second.returncode == 0, second.stderr
    assert second.stdout.splitlines()[0] == "Everything was computed already."
    assert (results / "report.html").read_bytes() == page


def test_failed_tasks_are_told_and_tried_again(tmp_path, config, threads, monkeypatch):
    perform = Triangulations.perform

    def failing(self, task, design):
        if task.distribution == "normal" and task.n_points < 800:
            raise MemoryError("no room")
        return perform(self, task, design)

    monkeypatch.setattr(Triangulations, "perform", failing)
    result = lepp_study("run", tmp_path / "out", "--config", config)
    assert result.exit_code == 3, result.output
    assert "8 tasks failed; the same command tries them again:" in result.output
    assert "  normal 200 0: MemoryError: no room" in result.output
    assert "and 3 more" in result.output
    assert (tmp_path / "out" / "report.html").exists()

    monkeypatch.setattr(Triangulations, "perform", perform)
    result = lepp_study("run", tmp_path / "out")
    assert result.exit_code == 0, result.output
    assert "8 triangulations to compute, 2,400 points, 16 of 24 are there" in result.output
    assert load(tmp_path / "out").manifest["failed"] == 0


def test_a_larger_design_goes_on_from_a_smaller_when_that_is_asked_for(tmp_path, config, threads):
    command = ["run", tmp_path / "out", "--config", config]
    assert lepp_study(*command).exit_code == 0
    config.write_text(SETTINGS.replace("repetitions = 4", "repetitions = 5"))
    result = lepp_study(*command)
    assert result.exit_code == 2
    assert "(repetitions is 4 there and 5 here): give another directory, or --ext" in result.output
    result = lepp_study(*command, "--extend")
    assert result.exit_code == 0, result.output
    assert "6 triangulations to compute, 2,800 points, 24 of 30 are there" in result.output
    assert load(tmp_path / "out").complete


def test_a_run_of_which_every_task_fails_ends_with_the_list(tmp_path, config, threads, monkeypatch):
    def fail(self, task, design):
        raise MemoryError("no room")

    monkeypatch.setattr(Triangulations, "perform", fail)
    for _ in range(2):  # the second tries them again
        result = lepp_study("run", tmp_path / "out", "--config", config)
        assert result.exit_code == 3, result.output
        assert "24 triangulations, 11,200 points, in" in result.output
        assert "24 tasks failed; the same command tries them again:" in result.output
        assert "and 19 more" in result.output
        assert "own time" not in result.output


def test_a_failure_that_stays_ends_with_the_list_again(tmp_path, config, threads, monkeypatch):
    perform = Triangulations.perform

    def failing(self, task, design):
        if task.replicate == 0 and task.n_points == 400:
            raise MemoryError("no room")
        return perform(self, task, design)

    monkeypatch.setattr(Triangulations, "perform", failing)
    for _ in range(2):
        result = lepp_study("run", tmp_path / "out", "--config", config)
        assert result.exit_code == 3, result.output
        assert "2 tasks failed" in result.output
    assert "22 of 24 are there" in result.output


def test_workers_that_leave_at_the_end_are_no_failure(tmp_path, config, monkeypatch):
    @contextmanager
    def connect(kind, design, options, note):
        with in_process(1) as (client, cluster):
            finish = Store.finish

            def leave(store):
                cluster.scale(0)
                while client.nthreads():
                    sleep(0.01)
                finish(store)

            monkeypatch.setattr(Store, "finish", leave)
            yield LocalWorkers(client, cluster, 1)

    monkeypatch.setattr("study.run.runner.connect", connect)
    result = lepp_study("run", tmp_path / "out", "--config", config)
    assert result.exit_code == 0, result.output
    assert "24 triangulations, 11,200 points, in" in result.output


@pytest.fixture
def results(tmp_path):
    design = Design.from_settings({"sizes": [50], "repetitions": 1, "distributions": ["uniform"]})
    return store_run(tmp_path / "results", design, TRIANGULATIONS.perform)


def test_a_report_that_cannot_be_written_is_one_sentence(results, monkeypatch):
    (results / "tables").touch()
    result = lepp_study("report", results)
    assert (result.exit_code, result.output.count("\n")) == (2, 1)
    assert "tables: a file has that name; give it another one." in result.output
    (results / "tables").unlink()

    def full(*_):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(os, "fsync", full)
    result = lepp_study("report", results)
    assert (result.exit_code, result.output.count("\n")) == (2, 1)
    assert result.output.endswith(": No space left on device.\n")
    assert not (results / "report.html").exists()


def test_a_design_that_does_not_fit_leaves_no_directory(tmp_path):
    config = tmp_path / "huge.toml"
    config.write_text('methods = ["delaunay"]\nsizes = [268_000_000]\nrepetitions = 1\n')
    result = lepp_study("run", tmp_path / "out", "--config", config, "--workers", "1000")
    assert result.exit_code == 2
    assert "A triangulation of 268,000,000 points takes about" in result.output
    assert not (tmp_path / "out").exists()


def test_a_reader_that_goes_away_gets_no_traceback(results):
    code = "from reports.cli.main import main; main()"
    read, write = os.pipe()
    os.close(read)
    done = subprocess.run(
        [sys.executable, "-c", code, "report", str(results)],
        stdout=write,
        stderr=subprocess.PIPE,
        text=True,
        check=False,
    )
    os.close(write)
    assert done.stderr == ""
    assert (results / "report.html").exists()


def test_an_interrupted_run_says_how_to_go_on(tmp_path, config, threads, monkeypatch):
    advance = "reports.cli.progress.PlainProgress.advance"

    def interrupt(self, outcome, size):
        raise KeyboardInterrupt

    monkeypatch.setattr(advance, interrupt)
    result = lepp_study("run", tmp_path / "out", "--config", config)
    assert result.exit_code == 130
    assert "is kept in" in result.output
    assert "the same command goes on from there" in result.output
    assert 0 < len(load(tmp_path / "out")["results"]) < 24


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["run", "--preset", "papers"], "no preset 'papers'; the presets are beyond, b"),
        (["run", "--preset", "smoke", "--config", "x.toml"], "--preset or --config, not both"),
        (["run", "--config", "none.toml"], "Cannot read the design none.toml: No such file"),
        (["run", "--config", "mine.toml", "--seed", "-1"], "seed = -1, which is not allowed"),
        (["run", "mine.toml"], "mine.toml is a file"),
        (["run", ".", "--preset", "smoke"], "is not empty and holds no results of lepp-study"),
        (["report", "."], "holds no results of lepp-study (manifest.json is missing)"),
        (["run", "new", "--workers", "2", "--scheduler", "tcp://127.0.0.1:1"], "one of --workers"),
    ],
)
def test_bad_input_is_one_sentence(arguments, words, config, monkeypatch):
    monkeypatch.chdir(config.parent)
    result = lepp_study(*arguments)
    assert result.exit_code == 2
    assert words in result.output
    assert result.output.startswith("Error: ")
    assert result.output.count("\n") == 1


@pytest.mark.parametrize("words", ["soon", "-1s", "90 parsecs", "90", ""])
def test_a_wait_that_is_no_time_is_told(words):
    result = lepp_study("run", "new", "--wait", words)
    assert result.exit_code == 2
    assert f"{words!r} is no time: write it as 90s, 30min, 2h or 1d." in result.output


@pytest.mark.parametrize(
    ("words", "seconds"), [("90s", 90), ("30min", 1800), ("1.5h", 5400), ("2 d", 172800)]
)
def test_a_wait_is_a_time(words, seconds):
    assert Duration().convert(words, None, None) == seconds


def test_an_unknown_command_lists_the_known():
    result = lepp_study("rnu")
    assert result.exit_code == 2
    assert "no command 'rnu'; the commands are bench, " in result.output


def test_the_help_names_every_preset():
    said = " ".join(lepp_study("run", "--help").output.split())
    offered = said.partition("A design that comes with lepp-study:")[2].partition(" --config ")[0]
    words = offered.replace(",", " ").replace(".", " ").replace("- ", "-").split()
    assert set(preset_names()) <= set(words)


def test_help_and_version_import_nothing_heavy():
    code = (
        "import sys; from click.testing import CliRunner; from reports.cli.main import main\n"
        "for words in (['--help'], ['run', '--help'], ['--version']):\n"
        "    assert CliRunner().invoke(main, words).exit_code == 0\n"
        "print(*{'numpy', 'numba', 'pandas', 'distributed', 'pydantic', 'rich'} & {*sys.modules})"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True, env=os.environ
    )
    assert done.stdout == "\n"
