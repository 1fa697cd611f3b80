"""Axes and series of plots: where labels stand, and that no two series look alike."""

import numpy as np
import pytest

from reports.page import style


def labels(axis, sizes):
    """Labels that a reader sees between the ends."""
    pairs = zip(axis["tickvals"], axis["ticktext"], strict=True)
    return [text for value, text in pairs if min(sizes) <= value <= max(sizes)]


@pytest.mark.parametrize(
    ("sizes", "columns", "expected"),
    [
        ((10_000, 1_000_000), 1, "10k 20k 50k 100k 200k 500k 1M"),
        ((10_000, 10_000_000), 1, "10k 30k 100k 300k 1M 3M 10M"),
        ((10_000, 100_000_000), 1, "10k 100k 1M 10M 100M"),
        ((10_000, 1_000_000), 2, "10k 100k 1M"),
        ((10_000, 10_000_000), 2, "10k 100k 1M 10M"),
        ((100, 8000), 1, "100 200 500 1k 2k 5k"),
    ],
)
def test_labels_of_logarithmic_axes_are_numbers_that_fit(sizes, columns, expected):
    axis = style.number_of_points(sizes, columns)
    assert axis["type"] == "log"
    assert " ".join(labels(axis, sizes)) == expected


def test_an_axis_is_linear_up_to_a_factor_of_50():
    assert style.number_of_points((10_000, 500_000)).get("type") is None
    assert style.number_of_points((10_000, 500_001))["type"] == "log"
    assert style.number_of_points(()).get("type") is None


def test_bars_look_alike_on_either_axis():
    assert style.bar_widths([10, 20], [10, 20, 500]) is None
    assert style.bar_widths([], []) is None
    drawn = np.array([10, 20, 501])
    widths = np.array(style.bar_widths(drawn, drawn))
    ends = np.log(drawn + widths / 2) - np.log(drawn - widths / 2)
    np.testing.assert_allclose(ends, ends[0])
    assert 0.1 < ends[0] < np.log(2)


def test_a_fixed_axis_ends_with_the_sizes():
    assert "range" not in style.number_of_points((10_000, 200_000))
    low, high = style.number_of_points((10_000, 200_000), fixed=True)["range"]
    assert 0 < low < 10_000
    assert 200_000 < high < 210_000
    low, high = style.number_of_points((10_000, 1_000_000), fixed=True)["range"]  # of logarithms
    assert 3.9 < low < 4
    assert 6 < high < 6.1
    low, high = style.number_of_points((5000,), fixed=True)["range"]
    assert low < 5000 < high


@pytest.mark.parametrize(
    ("largest", "expected"),
    [
        (1.0, "0 %, 20 %, 40 %, 60 %, 80 %, 100 %"),
        (0.3, "0 %, 5 %, 10 %, 15 %, 20 %, 25 %, 30 %"),
        (0.0147, "0.0 %, 0.5 %, 1.0 %, 1.5 %"),
        (0.0007, "0.00 %, 0.02 %, 0.04 %, 0.06 %"),
    ],
)
def test_an_axis_of_shares_follows_the_largest(largest, expected):
    axis = style.shares("Share", largest)
    bottom, top = axis["range"]
    assert bottom < 0
    assert largest < top < 1.1 * largest
    shown = [t for v, t in zip(axis["tickvals"], axis["ticktext"], strict=True) if v <= top]
    assert ", ".join(shown).replace("\u00a0", " ") == expected


def test_an_axis_of_nothing_but_zeros_can_be_drawn():
    bottom, top = style.shares("Share", 0.0)["range"]
    assert bottom < 0 < top


def test_no_two_series_look_alike():
    lines = {tuple(style.line(k).values()) for k in range(25)}
    markers = {tuple(style.marker(k).values()) for k in range(25)}
    assert len(lines) == len(markers) == 25


def test_the_scale_is_pale_about_0():
    places = [place for place, _ in style.SCALE]
    assert places == sorted(places)
    assert (places[0], places[-1]) == (0, 1)
    assert dict(style.SCALE)[0.5] == "var(--scale-0)"
