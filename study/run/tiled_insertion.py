"""A plain insertion that is larger than memory: stages of jobs on its blocks and its tiles.

`lepp.tiles` says how; here it is said what is a job, and what is kept between jobs: each leaves a
file, so that a run that was cut short goes on where it was. The points are drawn twice, and lie on
the disk once, by tile: drawing them for each tile would take longer than reading them.
"""

import pickle
import shutil
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from time import perf_counter
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lepp import InputError
from lepp.tiles.coarse import CoarseMesh, coarse_mesh, hull_of, outside
from lepp.tiles.crossings import crossings
from lepp.tiles.fine import FineMesh, collect, fine_mesh
from lepp.tiles.joining import Outer, beyond, joined, region_sizes
from lepp.tiles.location import PLACED, locate
from lepp.tiles.measuring import TileCounts, tile_counts
from study.design.sampling import BLOCK, Points, sample_block
from study.results.files import replacing
from study.run.checks_of_blocks import Histogram, checks_of_blocks, extract, histogram, plan_checks
from study.run.counted import Counted
from study.run.kinds import Stage
from study.run.point_checks import PointChecks

#: Points that the first hull, and the choice of the tiles, are made from.
OPENING = 1 << 17
#: Most points that are worked on together.
_TOGETHER = 1 << 21
#: Bytes that a job takes for each of its points, the peak of all stages as measured.
_BYTES_PER_POINT = 330
#: Bytes that it takes besides: the opening is triangulated.
_BYTES_BESIDE = 50_000_000

#: The least memory that a job can do with.
LEAST_MEMORY = 80_000_000


@dataclass(frozen=True)
class TiledInsertion:
    """The plain insertion of one point set, in tiles.

    Attributes
    ----------
    distribution, n_points, replicate, seed, correlation
        As for `study.design.sampling.sample_points`.
    directory : Path
        For the files that jobs leave to each other; every worker must see it.
    memory : int
        Bytes that a job may take.
    """

    distribution: str
    n_points: int
    replicate: int
    seed: int
    correlation: float
    directory: Path
    memory: int

    def stages(self) -> Iterator[Stage]:
        """Yield what is done, stage by stage."""
        yield self._stage("hull", "Finding the hull of the first points", range(1))
        yield self._stage("outside", "Looking for points outside it", self._blocks, 0.07)
        yield self._stage("coarse", "Choosing tiles", range(1))
        yield self._stage("locate", "Sending the points to their tiles", self._blocks, 0.34)
        yield self._stage("groups", "Counting them", range(1))
        groups = range(self._load("groups", 0))
        yield self._stage("cross", "Triangulating tiles", groups, 0.25)
        yield self._stage("beyond", "Joining them", range(1))
        yield self._stage("count", "Triangulating and counting tiles", groups, 0.34)

    def check_disk(self) -> None:
        """Raise `InputError` if the disk has no room for the points that are still to be sent."""
        there = len(list(self.directory.glob("locate-*.pickle"))) * BLOCK
        needed = max(self.n_points - there, 0) * (PLACED.itemsize + 2)
        there_now = (self.directory, *self.directory.parents)
        free = shutil.disk_usage(next(path for path in there_now if path.exists())).free
        if needed > free:
            raise InputError(
                f"{self.n_points:,} points take {needed / 1e9:,.1f} GB of disk beside the results, "
                f"but {self.directory} has {free / 1e9:,.1f} GB free: give a directory elsewhere."
            )

    def result(self) -> tuple[PointChecks, Counted, dict[str, float]]:
        """Add up the counts, when all stages are done.

        Returns
        -------
        checks : PointChecks
        counted : Counted
        seconds : dict of str to float
            By what they were spent with, over all jobs.
        """
        coarse: CoarseMesh = self._load("coarse", 0)
        n_groups = self._load("groups", 0)
        parts: list[TileCounts] = [self._load("count", group) for group in range(n_groups)]
        meshes = [self._load("cross", group) for group in range(n_groups)]
        crossed = joined([crossing for crossing, *_ in meshes])
        shared = region_sizes(coarse, crossed, [part.ends for part in parts])
        located = [self._load("locate", block) for block in self._blocks]
        on_sides = np.unique(np.concatenate([on_sides for _, _, on_sides in meshes]))
        by_layer = _added([part.by_layer for part in parts])
        counted = Counted(
            n_triangles=int(by_layer.sum()),
            n_hull=sum(int(np.count_nonzero(~outer.exists)) for outer in self._load("beyond", 0)),
            n_repeated=coarse.n_repeated
            + sum(n_repeated for _, n_repeated, _ in located)
            + sum(n_repeated for _, n_repeated, _ in meshes)
            + len(on_sides),
            by_layer=by_layer,
            types=np.sum([part.types for part in parts], axis=0),
            n_equal=sum(part.n_equal for part in parts),
            n_nearly_equal=sum(part.n_nearly_equal for part in parts),
            regions=_added([*(part.regions for part in parts), np.bincount(shared)]),
        )
        checks = checks_of_blocks(self._load("plan", 0), [found for *_, found in located])
        return checks, counted, self._seconds()

    def _seconds(self) -> dict[str, float]:
        total: dict[str, float] = {}
        for path in sorted(self.directory.glob("*.pickle")):
            with path.open("rb") as file:
                for what, seconds in pickle.load(file).items():
                    total[what] = total.get(what, 0.0) + seconds
        return total

    def perform(self, name: str, job: int) -> None:
        """Do a job of a stage."""
        getattr(self, f"_{name}")(job)

    def _stage(self, name: str, words: str, jobs: range, share: float = 0.0) -> Stage:
        left = [job for job in jobs if not self._path(name, job).exists()]
        return Stage(name, words, left, share / len(jobs))

    def _hull(self, job: int) -> None:
        """Find the hull of the opening."""
        clock = _Clock()
        opening = self._block(0)[:OPENING]
        clock.end("sample")
        hull = hull_of(opening)
        clock.end("triangulate")
        self._save("hull", job, hull, clock)

    def _outside(self, block: int) -> None:
        """Pick the points of a block that may extend the hull; count its points for the checks."""
        clock = _Clock()
        points = self._block(block)
        clock.end("sample")
        bins = histogram(points, self.distribution, self.n_points)
        clock.end("check")
        begin = OPENING if block == 0 else 0
        picked = begin + np.flatnonzero(outside(self._load("hull", 0), points[begin:]))
        clock.end("triangulate")
        self._save("outside", block, (points[picked], block * BLOCK + picked, bins), clock)

    def _coarse(self, job: int) -> None:
        """Choose the coarse mesh: so fine that no tile has too many points."""
        clock = _Clock()
        opening = self._block(0)[:OPENING]
        clock.end("sample")
        points, indices = [opening], [np.arange(len(opening))]
        bins: Histogram | None = None
        for block in self._blocks:
            outer, numbers, of_block = self._load("outside", block)
            points.append(outer)
            indices.append(numbers)
            bins = of_block if bins is None else bins + of_block
        assert bins is not None, "a set has a block"
        plan = plan_checks(bins)
        clock.end("check")
        candidates = np.concatenate(points), np.concatenate(indices)
        n_first = 16
        while True:
            coarse = coarse_mesh(*candidates, n_first)
            most = locate(coarse, opening, 0).counts.max() * self.n_points / len(opening)
            if most <= self._together / 2 or 2 * n_first > len(opening):
                break
            n_first *= 2
        clock.end("triangulate")
        self._save("plan", job, plan)
        self._save("coarse", job, coarse, clock)

    def _locate(self, block: int) -> None:
        """Send the points of a block to their tiles, on the disk."""
        clock = _Clock()
        points = self._block(block)
        clock.end("sample")
        extracted = extract(points, block * BLOCK, self._load("plan", 0))
        clock.end("check")
        coarse: CoarseMesh = self._load("coarse", 0)
        counts, n_repeated = [], 0
        for begin in range(0, len(points), self._together):
            located = locate(coarse, points[begin : begin + self._together], block * BLOCK + begin)
            with replacing(self._points_of(block, begin)) as path, path.open("wb") as file:
                np.save(file, located.placed)
            counts.append(located.counts)
            n_repeated += located.n_repeated
        clock.end("triangulate")
        self._save("locate", block, (counts, n_repeated, extracted), clock)

    def _groups(self, job: int) -> None:
        """Put tiles together that are worked on together, and find their points on the disk."""
        clock = _Clock()
        counts = np.stack(
            [part for block in self._blocks for part in self._load("locate", block)[0]]
        )
        ends = counts.cumsum(axis=1)
        of_all = ends.sum(axis=0)
        bounds = [0]
        while bounds[-1] < len(of_all):
            before = of_all[bounds[-1] - 1] if bounds[-1] else 0
            stop = int(np.searchsorted(of_all, before + self._together, side="right"))
            bounds.append(max(stop, bounds[-1] + 1))
        for group, (first, stop) in enumerate(pairwise(bounds)):
            inside = counts[:, first:stop]
            starts = ends[:, stop - 1] - inside.sum(axis=1)
            self._save("slices", group, (first, starts, inside))
        clock.end("triangulate")
        self._save("groups", job, len(bounds) - 1, clock)

    def _cross(self, group: int) -> None:
        """Triangulate a group of tiles, and follow the paths that enter them."""
        clock = _Clock()
        mesh = self._mesh(group)
        clock.end("triangulate")
        found = crossings(mesh)
        clock.end("lepp")
        self._save("cross", group, (found, mesh.n_repeated, mesh.repeated_on_sides), clock)

    def _beyond(self, job: int) -> None:
        """Find what lies beyond the sides of the tiles, group by group."""
        clock = _Clock()
        parts = [self._load("cross", group)[0] for group in range(self._load("groups", 0))]
        outer = beyond(self._load("coarse", 0), joined(parts))
        stops = np.cumsum([len(part.sides) for part in parts])[:-1]
        columns = [np.split(column, stops) for column in outer]
        clock.end("lepp")
        self._save(
            "beyond", job, [Outer(*of_group) for of_group in zip(*columns, strict=True)], clock
        )

    def _count(self, group: int) -> None:
        """Triangulate a group of tiles once more, and count."""
        clock = _Clock()
        mesh = self._mesh(group)
        clock.end("triangulate")
        counts = tile_counts(mesh, self._load("beyond", 0)[group])
        clock.end("lepp")
        self._save("count", group, counts, clock)

    @property
    def _blocks(self) -> range:
        return range(-(-self.n_points // BLOCK))

    @property
    def _together(self) -> int:
        """Points that are worked on together."""
        return max(1, min(_TOGETHER, (self.memory - _BYTES_BESIDE) // _BYTES_PER_POINT))

    def _block(self, block: int) -> Points:
        return sample_block(
            self.distribution,
            self.n_points,
            self.replicate,
            block,
            seed=self.seed,
            correlation=self.correlation,
        )

    def _mesh(self, group: int) -> FineMesh:
        """Triangulate the tiles of a group."""
        first, starts, counts = self._load("slices", group)
        pieces = []
        for row, (block, begin) in enumerate(self._parts()):
            placed = np.load(self._points_of(block, begin), mmap_mode="r")
            stop = starts[row] + counts[row].sum()
            pieces.append((placed[starts[row] : stop], counts[row], block * BLOCK + begin))
        return fine_mesh(self._load("coarse", 0), first, collect(pieces))

    def _parts(self) -> Iterator[tuple[int, int]]:
        """Yield the parts of blocks that are sent to their tiles: a block, where one begins."""
        for block in self._blocks:
            for begin in range(0, min(BLOCK, self.n_points - block * BLOCK), self._together):
                yield block, begin

    def _points_of(self, block: int, begin: int) -> Path:
        return self.directory / f"points-{block}-{begin}.npy"

    def _path(self, name: str, job: int) -> Path:
        return self.directory / f"{name}-{job}.pickle"

    def _save(self, name: str, job: int, result: object, clock: "_Clock | None" = None) -> None:
        seconds = clock.seconds if clock else {}
        with replacing(self._path(name, job)) as path, path.open("wb") as file:
            pickle.dump(seconds, file, pickle.HIGHEST_PROTOCOL)
            pickle.dump(result, file, pickle.HIGHEST_PROTOCOL)

    def _load(self, name: str, job: int) -> Any:  # noqa: ANN401 - whatever the job has left
        with self._path(name, job).open("rb") as file:
            pickle.load(file)
            return pickle.load(file)


class _Clock:
    """Seconds by what they are spent with."""

    def __init__(self) -> None:
        self.seconds: dict[str, float] = {}
        self._last = perf_counter()

    def end(self, what: str) -> None:
        """Note what the time since the last end was spent with."""
        now = perf_counter()
        self.seconds[what] = self.seconds.get(what, 0.0) + now - self._last
        self._last = now


def _added(arrays: list[NDArray[np.int64]]) -> NDArray[np.int64]:
    """Add arrays of counts of different shapes, without zeros behind."""
    total = np.zeros(np.max([array.shape for array in arrays], axis=0), np.int64)
    for array in arrays:
        total[tuple(slice(length) for length in array.shape)] += array
    ends = [int(places.max(initial=-1)) + 1 for places in np.nonzero(total)]
    return total[tuple(slice(end) for end in ends)]
