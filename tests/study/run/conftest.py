import pytest
from distributed import Client, LocalCluster
from faults import DESIGN, TASKS, Heard

from study.results.store import Store
from study.run.local import LocalWorkers
from study.run.runner import compute
from study.run.triangulations import TRIANGULATIONS
from study.run.waiting import Waiting


@pytest.fixture(scope="session")
def whole(tmp_path_factory):
    """What an undisturbed run leaves, without any cluster."""
    directory = tmp_path_factory.mktemp("whole") / "results"
    with Store(directory, TRIANGULATIONS, DESIGN) as store:
        store.add(TRIANGULATIONS.perform(task, DESIGN) for task in TASKS)
        store.finish()
    return directory


@pytest.fixture(scope="module")
def threads():
    """Two threads of this process as workers."""
    with (
        LocalCluster(
            n_workers=1,
            threads_per_worker=2,
            processes=False,
            dashboard_address=None,
            scheduler_kwargs={"dashboard_address": "127.0.0.1:0"},
        ) as cluster,
        Client(cluster) as client,
    ):
        yield client, cluster


@pytest.fixture
def finish(threads):
    """Compute in this process what a directory lacks; give the tasks of that."""

    def run(directory, heard=None, memory=None):
        workers = LocalWorkers(*threads, 1, memory)
        heard = heard or Heard()
        with Store(directory, TRIANGULATIONS, DESIGN) as store:
            waiting = Waiting(60, "a test", heard.note)
            outcomes = list(compute(workers, waiting, store, heard))
            store.finish()
        return outcomes

    return run
