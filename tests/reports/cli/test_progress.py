import pytest

from reports.cli.progress import Prospect


class Clock:
    now = 0.0

    def __call__(self):
        return self.now


def told(minutes_in_all, steps=100, threads=2):
    """Every sentence of a run that takes a time, with its time of the run in seconds."""
    clock = Clock()
    prospect = Prospect(1000, threads, clock)
    sentences = []
    for step in range(1, steps + 1):
        clock.now = 60 * minutes_in_all * step / steps
        if sentence := prospect.after(1000 // steps):
            sentences.append((clock.now, sentence))
    return sentences


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
