import pytest

from study.statistics.groups import best_repeated


@pytest.mark.parametrize(
    ("triangulations", "best"),
    [
        ({10: 40, 20: 40}, 20),
        ({10: 40, 20: 16, 30: 15}, 20),
        ({10: 15, 20: 8, 30: 2, 40: 1}, 30),
        ({10: 1, 20: 1}, 20),
        ({10: 2, 20: 1}, 10),
    ],
)
def test_the_largest_size_that_shows_how_it_varies(triangulations, best):
    assert best_repeated(triangulations) == best


def test_of_no_sizes_none_is_best():
    with pytest.raises(ValueError, match="no number of points"):
        best_repeated({})
