"""Runs of a kind that is no triangulation."""

import json

import pytest
from primes import PRIMES, PrimeDesign, Primes, Range

from lepp import InputError
from study.design.design import Design
from study.results.store import Store, load
from study.run.local import LocalWorkers
from study.run.registry import KINDS
from study.run.runner import compute
from study.run.triangulations import TRIANGULATIONS
from study.run.waiting import Waiting

DESIGN = PrimeDesign(ranges=6, length=10)


@pytest.fixture(autouse=True)
def known(monkeypatch):
    monkeypatch.setitem(KINDS, PRIMES.name, PRIMES)


class Deaf:
    def begin(self, units, unfinished, whole, n_threads):
        self.begun = units, unfinished, whole

    def note(self, sentence):
        raise AssertionError(sentence)


def run(threads, directory):
    deaf = Deaf()
    waiting = Waiting(60, "a test", deaf.note)
    with Store(directory, PRIMES, DESIGN) as store:
        outcomes = list(compute(LocalWorkers(*threads, 1), waiting, store, deaf))
        store.finish()
    return outcomes, deaf


def test_a_run_of_another_kind_is_resumed_stored_and_loaded(threads, tmp_path, monkeypatch):
    perform = Primes.perform

    def failing(self, task, design):
        if task.first == 20:
            raise MemoryError("no room")
        return perform(self, task, design)

    monkeypatch.setattr(Primes, "perform", failing)
    with Store(tmp_path, PRIMES, DESIGN) as store:
        store.add([perform(PRIMES, Range(0), DESIGN)])
    assert load(tmp_path)["counts"]["n_primes"].tolist() == [4]
    outcomes, deaf = run(threads, tmp_path)
    assert deaf.begun == (("ranges", "numbers"), (5, 50), (6, 60))
    assert len(outcomes) == 5
    loaded = load(tmp_path)
    assert loaded.complete
    assert (loaded.kind, loaded.design) == (PRIMES, DESIGN)
    assert json.loads((tmp_path / "manifest.json").read_text())["kind"] == "primes"
    assert loaded["counts"]["error"].tolist()[2] == "MemoryError: no room"

    monkeypatch.setattr(Primes, "perform", perform)
    outcomes, _ = run(threads, tmp_path)
    assert [outcome.task.first for outcome in outcomes] == [20]
    loaded = load(tmp_path)
    assert loaded["counts"]["n_primes"].tolist() == [4, 4, 2, 2, 3, 2]
    assert loaded["counts"]["largest"].tolist()[-1] == 59
    assert loaded["numbers"]["prime"].tolist()[:5] == [2, 3, 5, 7, 11]
    assert loaded["numbers"]["first"].tolist()[:5] == [0, 0, 0, 0, 10]


def test_kinds_do_not_share_a_directory(tmp_path, monkeypatch):
    with Store(tmp_path, PRIMES, DESIGN) as store:
        store.add([PRIMES.perform(Range(0), DESIGN)])
    other = Design.from_settings({"sizes": [10], "repetitions": 1})
    with pytest.raises(InputError, match="primes there and triangulations here"):
        Store(tmp_path, TRIANGULATIONS, other)
    monkeypatch.delitem(KINDS, "primes")
    with pytest.raises(InputError, match=r"of a study of primes, and this version .* knows tri"):
        load(tmp_path)
