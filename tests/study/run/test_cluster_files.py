"""The files of docs/clusters run, with a small cluster in the place of a large one."""

import os
import runpy
import shutil
import subprocess
import sys
from pathlib import Path
from time import sleep
from types import ModuleType

import pytest
from distributed import LocalCluster
from faults import DESIGN, contents

from reports.cli.main import main

FILES = Path(__file__).parents[3] / "docs" / "clusters"

SETTINGS = "\n".join(
    f"{name} = {list(value) if isinstance(value, tuple) else value}".replace("'", '"')
    for name, value in DESIGN.model_dump().items()
)


@pytest.fixture
def asked(tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text(SETTINGS)
    return path


def in_this_process(**options):
    """A cluster that has no workers before there is work."""
    return LocalCluster(
        n_workers=0,
        threads_per_worker=1,
        processes=False,
        protocol="tcp",
        dashboard_address=None,
        scheduler_kwargs={"dashboard_address": "127.0.0.1:0"},
    )


@pytest.mark.parametrize(
    ("script", "module", "name"),
    [
        ("slurm.py", "dask_jobqueue", "SLURMCluster"),
        ("kubernetes.py", "dask_kubernetes.operator", "KubeCluster"),
    ],
)
def test_a_script_runs_a_design_on_its_cluster(
    script, module, name, asked, tmp_path, whole, monkeypatch
):
    stand_in = ModuleType(module)
    setattr(stand_in, name, in_this_process)
    monkeypatch.setitem(sys.modules, module, stand_in)
    if "." in module:
        monkeypatch.setitem(sys.modules, module.split(".")[0], ModuleType(module.split(".")[0]))
    monkeypatch.setattr(sys, "argv", [script, str(asked), str(tmp_path / "out")])
    monkeypatch.setattr("reports.cli.main._write_report", lambda directory: directory)
    with pytest.raises(SystemExit) as ended:
        runpy.run_path(str(FILES / script), run_name="__main__")
    assert ended.value.code == 0
    assert contents(tmp_path / "out") == contents(whole)


@pytest.mark.skipif(shutil.which("sh") is None, reason="needs a shell")
@pytest.mark.parametrize("script", ["laptop.sh", "server.sh", "job.sh"])
def test_the_commands_of_a_shell_script_are_understood(script, asked, tmp_path):
    programs = tmp_path / "programs"
    programs.mkdir()
    for name in ("lepp-study", "dask", "srun"):
        program = programs / name
        program.write_text(f'#!/bin/sh\necho {name} "$@" >>"{tmp_path}/called"\n')
        program.chmod(0o755)
    arguments = [] if script == "laptop.sh" else [str(asked), str(tmp_path / "out")]
    subprocess.run(
        ["sh", str(FILES / script), *arguments],
        cwd=tmp_path,
        env=os.environ | {"PATH": f"{programs}{os.pathsep}{os.environ['PATH']}"},
        stdout=subprocess.PIPE,
        stdin=subprocess.DEVNULL,
        check=True,
    )
    ours = []
    while not any(name == "run" for name, *_ in ours):  # it may go on by itself
        called = (tmp_path / "called").read_text().splitlines()
        ours = [line.split()[1:] for line in called if line.startswith("lepp-study ")]
        sleep(0.01)
    for name, *words in ours:
        main.get_command(None, name).make_context(name, words)
