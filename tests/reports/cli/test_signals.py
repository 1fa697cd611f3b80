"""What stops a command, wherever it comes."""

import gc
import signal
import sys
from contextlib import contextmanager, suppress
from threading import Event
from time import sleep

import pytest
from click.testing import CliRunner

from reports.cli.main import main
from reports.cli.signals import exit_code, stop_once


@pytest.fixture(autouse=True)
def signals():
    """Have what a stopped process ignores afterwards be heard again."""
    hook = sys.unraisablehook
    before = {number: signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)}
    yield before
    for number, handler in before.items():
        signal.signal(number, handler)
    sys.unraisablehook = hook


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_stops_and_those_that_follow_do_not(number):
    closed = []

    @stop_once()
    def command():
        try:
            signal.raise_signal(number)
        finally:
            signal.raise_signal(signal.SIGINT)
            signal.raise_signal(signal.SIGTERM)
            closed.append(True)

    with pytest.raises(KeyboardInterrupt):
        command()
    assert closed
    signal.raise_signal(number)  # nor while Python ends
    assert exit_code() == 128 + number


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_that_a_callback_swallows_comes_again(number, capsys):
    came = []

    def callback(phase, info):
        if not came:
            came.append(phase)
            signal.raise_signal(number)

    @stop_once()
    def command():
        gc.collect()
        assert came
        Event().wait()

    gc.callbacks.append(callback)
    try:
        with pytest.raises(KeyboardInterrupt):
            command()
    finally:
        gc.callbacks.remove(callback)
    assert exit_code() == 128 + number
    assert capsys.readouterr().err == ""


def test_a_signal_that_is_taken_for_another_error_comes_again():
    taken = []

    @stop_once()
    def command():
        for _ in range(3):
            try:
                signal.raise_signal(signal.SIGINT)
                Event().wait()
            except BaseException as error:
                taken.append(type(error))
        Event().wait()

    with pytest.raises(KeyboardInterrupt):
        command()
    assert taken == [KeyboardInterrupt] * 3


def test_closing_takes_its_time_and_meets_its_own_errors():
    closed = []

    @contextmanager
    def cluster():
        try:
            yield
        finally:
            with suppress(TimeoutError):
                raise TimeoutError
            try:
                raise ValueError
            except ValueError:
                sleep(1.2)  # a few times longer than until the signal would come again
            closed.append(True)

    @stop_once()
    def command():
        with cluster():
            signal.raise_signal(signal.SIGINT)

    with pytest.raises(KeyboardInterrupt):
        command()
    assert closed


def test_other_errors_of_callbacks_are_told_as_ever(monkeypatch):
    told = []
    monkeypatch.setattr(sys, "unraisablehook", lambda what: told.append(what.exc_type))

    class Failing:
        def __del__(self):
            raise ValueError

    class Interrupted:
        def __del__(self):
            raise KeyboardInterrupt  # not of a signal

    with stop_once():
        Failing()
        Interrupted()
    assert told == [ValueError, KeyboardInterrupt]
    told.clear()
    Failing()  # and afterwards, as before
    assert told == [ValueError]


def test_what_is_left_half_made_fails_quietly(monkeypatch):
    told, closed = [], []
    monkeypatch.setattr(sys, "unraisablehook", lambda what: told.append(what.exc_type))

    class Failing:
        def __del__(self):
            raise ValueError

    @stop_once()
    def command():
        try:
            signal.raise_signal(signal.SIGINT)
        finally:
            Failing()
            closed.append(True)

    with pytest.raises(KeyboardInterrupt):
        command()
    Failing()  # also when Python ends
    assert closed
    assert told == []


def test_what_c_code_makes_of_a_signal_is_one():
    @stop_once()
    def command():
        try:
            signal.raise_signal(signal.SIGINT)
        except KeyboardInterrupt as error:
            raise SystemError("returned a result with an exception set") from error

    with pytest.raises(KeyboardInterrupt):
        command()


def test_what_is_no_signal_is_none(signals):
    hook = sys.unraisablehook
    with pytest.raises(SystemError), stop_once():
        raise SystemError
    assert sys.unraisablehook is hook
    assert {number: signal.getsignal(number) for number in signals} == signals


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_every_command_stops_with_a_word(number, monkeypatch, tmp_path):
    def stopped(directory):
        signal.raise_signal(number)

    monkeypatch.setattr("reports.study_page.page.write_report", stopped)
    answer = CliRunner().invoke(main, ["report", str(tmp_path)])
    assert (answer.exit_code, answer.output) == (128 + number, "Stopped.\n")
