import pytest

from lepp import InputError
from study.design.design import Design
from study.run.cluster import BYTES_PER_POINT, check_memory, check_versions, connect

DESIGN = Design.from_settings({"sizes": [1000, 1_000_000], "repetitions": 1})
ONE = 1_000_000 * BYTES_PER_POINT


def test_memory_is_checked_for_the_largest_triangulations_at_once():
    check_memory(DESIGN, 4, 4 * ONE)
    with pytest.raises(InputError, match=r"1,000,000 points .* and 4 at once .*use --workers 3"):
        check_memory(DESIGN, 4, 4 * ONE - 1)
    with pytest.raises(InputError, match="are free: use smaller sizes"):
        check_memory(DESIGN, 1, ONE - 1)


def test_a_design_larger_than_this_computer_is_refused_before_anything_starts():
    huge = Design.from_settings({"sizes": [268_000_000], "repetitions": 1})
    with (
        pytest.raises(InputError, match="A triangulation of 268,000,000 points takes about"),
        connect(huge, workers=1000, scheduler=None),
    ):
        pass


def test_workers_and_scheduler_exclude_each_other():
    with (
        pytest.raises(InputError, match="--workers or --scheduler, not both"),
        connect(DESIGN, workers=2, scheduler="tcp://127.0.0.1:8786"),
    ):
        pass


def test_other_versions_are_named():
    here = {"Python": "3.11", "dask": "2026.8.0", "lepp-study": "0.1.0", "numpy": "2.4.6"}
    check_versions("worker w", here, here, ("lepp-study", "numpy"))
    check_versions("scheduler", here | {"numpy": "2.4.5"}, here, ("dask",))
    with pytest.raises(InputError, match=r"worker w has numpy 2\.4\.5, and .* has numpy 2\.4\.6"):
        check_versions("worker w", here | {"numpy": "2.4.5"}, here, ("lepp-study", "numpy"))
    with pytest.raises(InputError, match="worker w does not have lepp-study, and this"):
        check_versions("worker w", here | {"lepp-study": None}, here, ("lepp-study",))
    with pytest.raises(InputError, match=r"scheduler has Python 3\.12, and"):
        check_versions("scheduler", here | {"Python": "3.12"}, here, ("dask",))
