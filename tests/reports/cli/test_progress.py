import pytest

from reports.cli.progress import Pace, Prospect


class Clock:
    now = 0.0

    def __call__(self):
        return self.now


def told(minutes_in_all, steps=100, threads=2):
    """Every sentence of a run that takes a time, with its time of the run in seconds."""
    clock = Clock()
    pace = Pace(1000, clock)
    prospect = Prospect(pace, threads)
    sentences = []
    for step in range(1, steps + 1):
        clock.now = 60 * minutes_in_all * step / steps
        pace.advance(1000 // steps)
        if sentence := prospect.sentence():
            sentences.append((clock.now, sentence))
    return sentences


@pytest.mark.parametrize("starting", [0.0, 5.0, 60.0])
@pytest.mark.parametrize("workers", [1, 2, 16])
def test_the_time_left_is_right_within_a_factor_of_two_after_a_tenth(starting, workers):
    """Tasks of 0.1 s; each worker loads for 1.5 s in its first, and has a batch a second."""
    clock = Clock()
    n = 400 * workers
    pace = Pace(n, clock)
    ends = [(starting + 1.6 + 0.03 * k, 1) for k in range(workers)]
    ends += [
        (starting + 1.6 + second + 0.03 * k, 10) for k in range(workers) for second in range(1, 41)
    ]
    last = max(when for when, _ in ends)
    for when, tasks in sorted(ends):
        clock.now = when
        for _ in range(tasks):
            pace.advance(1)
        if 0.1 * n <= pace.done < 0.95 * n:
            assert 0.5 < pace.left / (last - when) < 2


def test_a_rate_is_not_told_before_it_is_known():
    clock = Clock()
    pace = Pace(100, clock)
    assert pace.rate is None
    for now in (7.0, 7.2, 7.9):  # of three workers
        clock.now = now
        pace.advance(10)
        assert pace.left is None
    clock.now = 9.0
    pace.advance(20)
    assert pace.rate == 10
    assert pace.left == 5
    assert pace.seconds == 9


def test_a_long_run_is_told_once_with_what_a_cluster_would_take():
    ((when, sentence),) = told(100)
    assert when == 180
    assert sentence.startswith(
        "About 97 minutes are left with 2 tasks at a time; a cluster with 32"
    )
    assert "would take about 6 minutes" in sentence


def test_a_run_of_hours_is_told_in_hours():
    ((_, sentence),) = told(600, threads=4)
    assert sentence.startswith("About 10 hours are left with 4 tasks at a time; a cluster with 64")
    assert "about 36 minutes" in sentence


@pytest.mark.parametrize(("minutes", "times"), [(4, 0), (5, 0), (6, 1)])
def test_a_short_run_is_not(minutes, times):
    assert len(told(minutes)) == times


def test_nothing_is_said_before_it_can_be_known():
    ((when, _),) = told(20, steps=500)
    assert when >= 20
    assert when >= 0.03 * 20 * 60
