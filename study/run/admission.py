"""Which workers of somebody's cluster are given tasks: those that were looked at, at any time.

A worker that joins is asked for its versions, has the kernels made ready, and is then given a
resource, in Dask's sense, that every task of a run asks for: bytes of its memory. So one that is
not fit gets no task, however early tasks are sent, and large tasks run alone where they have to.
"""

from collections.abc import Callable, Iterable, Sequence
from functools import partial
from hashlib import sha256
from threading import Event, Lock, Thread
from time import monotonic
from typing import Any

from distributed import Client, Worker

from lepp import InputError
from study.run.kinds import Kind
from study.run.memory import USABLE, check_memory, in_words
from study.run.waiting import duration
from study.run.workers import Workers

#: Packages that have to be the same to understand each other, and on the workers for the numbers.
WIRE = ("dask", "distributed", "cloudpickle", "msgpack")
SHARED = (*WIRE, "lepp-study", "numpy", "scipy", "numba")

#: Compiling all kernels takes a worker less than a minute; it may have work of others to do.
PREPARE_SECONDS = 600

#: A scheduler that is silent for longer is spoken of.
SILENT_SECONDS = 30.0

#: The bytes of a worker without a limit.
_UNLIMITED = 2.0**50

_LOOK_SECONDS = 0.5


class AdmittedWorkers(Workers):
    """The workers of a scheduler that were found fit for a run.

    A thread looks after them, so that a scheduler that does not answer holds nothing up.

    Parameters
    ----------
    client : distributed.Client
        Connected to the scheduler.
    scheduler : str
        Its address, for sentences.
    kind : Kind
        The kind of the tasks.
    design : kind.design
        Their design.
    note : callable
        Takes a sentence.
    """

    ahead = 12

    def __init__(
        self,
        client: Client,
        scheduler: str,
        kind: Kind,
        design: Any,  # noqa: ANN401 - of the kind's own type
        note: Callable[[str], None],
    ) -> None:
        self.client, self._scheduler, self._kind, self._design = client, scheduler, kind, design
        self._note = note
        self._here = versions_here(client)
        self._resource = f"lepp-study-bytes-{_digest(self._here)}"
        self.largest = 0.0
        #: Guards what the threads and the run share.
        self._lock = Lock()
        self._stranded_above: float | None = None
        #: The bytes of the workers that were fit when they were last counted, by their id.
        self._fit_before: dict[str, float] = {}
        self._present: dict[str, dict[str, Any]] = {}
        #: Workers by what Dask calls their id: why they get no tasks, empty while looked at.
        self._looked_at: dict[str, str] = {}
        self._told: set[str] = set()
        self._used = False
        self._answered = monotonic()
        self._closed = Event()
        Thread(target=self._watch, daemon=True).start()

    def close(self) -> None:
        """Look at no more workers."""
        self._closed.set()

    def look(self) -> str | None:
        """Tell of workers that are refused; refuse a design that none of the first can do."""
        self.most = max(self.most, self.now)
        silent = monotonic() - self._answered
        if silent >= SILENT_SECONDS:
            return f"the scheduler at {self._scheduler}, which does not answer"
        with self._lock:
            now, largest = self.now, self.largest
            present = {worker["id"]: address for address, worker in self._present.items()}
            refused = {key: why for key, why in self._looked_at.items() if why and key in present}
            fit = sum(self._resource in worker["resources"] for worker in self._present.values())
            paused = any(worker["status"] == "paused" for worker in self._present.values())
        looked_at = len(present) > len(refused) + fit
        if now and not looked_at and not self._used:
            check_memory(self._kind, self._design, largest, "the largest worker has")
            self._used = True
        if refused and len(refused) == len(present) and not self._used:
            key, why = next(iter(refused.items()))
            raise InputError(f"The worker {present[key]} {why}.")
        for key, why in refused.items():
            if why not in self._told:
                self._told.add(why)
                self._note(f"The worker {present[key]}, and any like it, gets no tasks: it {why}.")
        if now:
            return None
        if paused:
            return f"workers of {self._scheduler} that have paused, short of memory"
        if looked_at:
            return f"workers of {self._scheduler} to load the kernels, or to compile them"
        return f"workers at {self._scheduler}: start some with dask worker {self._scheduler}"

    def resources(self, memory: int) -> dict[str, float]:
        """Ask for bytes of a worker that is fit."""
        return {self._resource: memory}

    def stranded_above(self) -> float | None:
        """Tell how large tasks were that no worker was fit for."""
        with self._lock:
            above, self._stranded_above = self._stranded_above, None
        return above

    def _watch(self) -> None:
        while not self._closed.is_set():
            try:
                info: Any = self.client.scheduler_info(n_workers=-1)
                self._answered = monotonic()
                self._count(info["workers"])
            except Exception:  # the scheduler is lost, which the run notices by itself
                if self.client.status in ("closing", "closed"):
                    return
            self._closed.wait(_LOOK_SECONDS)

    def _count(self, present: dict[str, dict[str, Any]]) -> None:
        """Count the workers that are fit, and have the new ones looked at."""
        # One that is short of memory pauses: it takes no task until it has some again.
        fit = [
            worker
            for worker in present.values()
            if self._resource in worker["resources"] and worker["status"] == "running"
        ]
        new: dict[str, dict[str, dict[str, Any]]] = {}
        with self._lock:
            self._present = present
            rooms = {w["id"]: w["resources"][self._resource] for w in fit}
            if rooms.keys() - self._fit_before.keys():
                # What a worker had room for that was there all the time found one.
                stayed = (room for key, room in rooms.items() if key in self._fit_before)
                above = max(stayed, default=0.0)
                before = self._stranded_above
                self._stranded_above = above if before is None else min(before, above)
            self._fit_before = rooms
            self.largest = max(rooms.values(), default=0.0)
            self.now = sum(w["nthreads"] for w in fit)
            for address, worker in present.items():
                if (
                    self._resource not in worker["resources"]
                    and worker["id"] not in self._looked_at
                ):
                    self._looked_at[worker["id"]] = ""
                    new.setdefault(worker["host"], {})[address] = worker
        for workers in new.values():
            Thread(target=self._admit, args=(workers,), daemon=True).start()

    def _admit(self, workers: dict[str, dict[str, Any]]) -> None:
        """Look at workers of one host; give the resource to those that are fit."""
        try:
            rooms = self._fit(workers)
            if rooms:
                first = next(iter(rooms))
                if (why := self._prepared(first, max(rooms.values()))) is not None:
                    self._refuse([workers[address]["id"] for address in rooms], why)
                    return
                grant: Any = partial(_grant, name=self._resource, rooms=rooms)
                self.client.run(grant, workers=list(rooms), on_error="ignore")
        except Exception:  # the worker, or the scheduler, has gone
            pass
        finally:
            # Who is neither fit now nor refused is looked at again, if it is still there.
            with self._lock:
                for worker in workers.values():
                    if not self._looked_at.get(worker["id"]):
                        self._looked_at.pop(worker["id"], None)

    def _fit(self, workers: dict[str, dict[str, Any]]) -> dict[str, float]:
        """Return the bytes that each fit worker has for tasks, and refuse the others."""
        remote: Any = self.client
        reports = remote.sync(
            remote.scheduler.broadcast,
            msg={"op": "versions", "packages": list(SHARED)},
            workers=list(workers),
            on_error="ignore",
        )
        rooms = {}
        for address, report in reports.items():
            worker = workers[address]
            room = USABLE * worker["memory_limit"] - self._kind.base_memory
            if why := difference(versions(report), self._here, SHARED):
                self._refuse([worker["id"]], why)
            elif worker["memory_limit"] and room <= 0:
                self._refuse(
                    [worker["id"]],
                    f"may take {in_words(worker['memory_limit'])} of memory, and a process takes "
                    f"{in_words(self._kind.base_memory)} before its first task",
                )
            else:
                rooms[address] = room if worker["memory_limit"] else _UNLIMITED
        return rooms

    def _prepared(self, address: str, room: float) -> str | None:
        """Have a worker prepare what the others of its host then load; return why it could not."""
        prepare: Any = self.client.submit(
            self._kind.prepare, self._design, room, workers=[address], pure=False
        )
        end = monotonic() + PREPARE_SECONDS
        while monotonic() < end:
            try:
                prepare.result(timeout=1)
            except TimeoutError:
                if address not in self._present:
                    raise
            except Exception as error:  # whatever befalls a worker
                return f"could not compile the kernels ({error!r}): try lepp-study compile there"
            else:
                return None
        return f"did not load the kernels within {duration(PREPARE_SECONDS)}"

    def _refuse(self, keys: Iterable[str], why: str) -> None:
        with self._lock:
            self._looked_at.update(dict.fromkeys(keys, why))


async def _grant(dask_worker: Worker, name: str, rooms: dict[str, float]) -> None:
    """On a worker: have its bytes of memory as a resource."""
    remote: Any = dask_worker
    await remote.set_resources(**{name: rooms[remote.address]})


def _digest(there: dict[str, str | None]) -> str:
    """Tell clients of different versions apart, whose workers are different ones."""
    return sha256(repr(sorted(there.items())).encode()).hexdigest()[:12]


def versions_here(client: Client) -> dict[str, str | None]:
    """Return this process's versions, or raise `InputError` if the scheduler's do not go with it.

    Parameters
    ----------
    client : distributed.Client
        Connected to the scheduler.
    """
    from distributed.versions import get_versions

    remote: Any = client
    get: Any = get_versions
    here = versions(get(packages=list(SHARED)))
    scheduler = versions(remote.sync(remote.scheduler.versions, packages=list(SHARED)))
    if why := difference(scheduler, here, WIRE):
        raise InputError(f"The scheduler {why}.")
    return here


def versions(report: dict[str, Any]) -> dict[str, str | None]:
    """Return the versions that matter of what `distributed.versions` tells of a process."""
    python = ".".join(report["host"]["python"].split(".")[:2])
    return {"Python": python} | {name: report["packages"].get(name) for name in SHARED}


def difference(
    there: dict[str, str | None], here: dict[str, str | None], names: Sequence[str]
) -> str | None:
    """Say how a part of a cluster differs from this computer; None if it does not.

    Parameters
    ----------
    there, here : dict
        Versions by name, of Python and of packages; None for a package that is not installed.
    names : sequence of str
        The packages that matter, beside Python.
    """
    for name in ("Python", *names):
        if there[name] != here[name]:
            has = f"has {name} {there[name]}" if there[name] else f"does not have {name}"
            return (
                f"{has}, and this computer has {name} {here[name]}: install the same version on "
                "both"
            )
    return None
