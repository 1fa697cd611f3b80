import pytest

from study.run.waiting import RunStoppedError, Waiting, duration


class Clock:
    now = 100.0

    def __call__(self):
        return self.now


def test_what_is_waited_for_is_told_every_half_minute_and_ends():
    clock, told = Clock(), []

    def note(line):
        told.append((clock.now, line))

    waiting = Waiting(120, "--wait says how long", note, clock)
    for second in range(100, 220):
        clock.now = float(second)
        waiting.look("workers")
    clock.now = 220.0
    with pytest.raises(RunStoppedError) as caught:
        waiting.look("workers")
    assert [when for when, _ in told] == [103, 133, 163, 193]
    assert told[1][1] == "Waiting for workers, 33 seconds of at most 2 minutes."
    assert str(caught.value) == (
        "Waited 2 minutes for workers (--wait says how long); what was finished is kept, and the "
        "same command goes on from there."
    )


def test_the_time_begins_anew_when_there_is_nothing_to_wait_for():
    clock, told = Clock(), []
    waiting = Waiting(50, "", told.append, clock)
    for second in range(100, 400):
        clock.now = float(second)
        waiting.look("workers" if second % 50 else None)
    assert len(told) == 12


@pytest.mark.parametrize(
    ("seconds", "words"),
    [
        (1, "1 second"),
        (0.2, "0 seconds"),
        (60, "1 minute"),
        (90, "90 seconds"),
        (600, "10 minutes"),
        (3600, "1 hour"),
        (5400, "90 minutes"),
        (7200, "2 hours"),
    ],
)
def test_a_time_is_told_in_words(seconds, words):
    assert duration(seconds) == words
