import pytest

from lepp import InputError
from study.design.design import MAX_POINTS, Design, preset_names

SMALL = {"sizes": [100, 200], "repetitions": 2}


def test_paper_preset_is_the_published_design():
    paper = Design.from_preset("paper")
    assert paper.n_triangulations == 3200
    assert paper.n_points == 336_000_000
    assert paper.methods == ("incremental",)
    assert paper.sizes == tuple(range(10_000, 200_001, 10_000))


def test_presets_share_the_seed_and_differ_in_the_method():
    paper, delaunay, both = map(Design.from_preset, ("paper", "delaunay", "both"))
    assert paper.difference(delaunay) == "methods is incremental there and delaunay here"
    assert both.methods == ("incremental", "delaunay")
    assert {paper.seed, delaunay.seed, both.seed} == {paper.seed}
    assert preset_names() == ["beyond", "beyond-billion", "both", "delaunay", "paper", "smoke"]


def test_beyond_goes_to_ten_million_points_with_more_sets_of_the_small_ones():
    beyond = Design.from_preset("beyond")
    assert beyond.sizes[-1] == 10_000_000
    assert beyond.repetitions_by_size[10_000] == 200
    assert beyond.repetitions_by_size[10_000_000] == 32
    sets = sum(beyond.repetitions_by_size.values())
    assert beyond.n_triangulations == 2 * 4 * sets
    assert beyond.n_points == 8 * sum(n * r for n, r in beyond.repetitions_by_size.items())


def test_beyond_billion_adds_two_sizes_to_the_plain_insertion_of_beyond():
    beyond, billion = map(Design.from_preset, ("beyond", "beyond-billion"))
    added = {100_000_000: 4, 1_000_000_000: 1}
    assert billion.repetitions_by_size == beyond.repetitions_by_size | added
    assert billion.sizes_of("delaunay") == beyond.sizes
    assert billion.sizes_of("incremental") == billion.sizes
    assert billion.n_triangulations == beyond.n_triangulations + 4 * 5
    assert billion.n_points == beyond.n_points + 4 * 1_400_000_000
    others = {"sizes", "repetitions", "largest"}
    assert billion.model_dump(exclude=others) == beyond.model_dump(exclude=others)


BOTH = {"methods": ["incremental", "delaunay"], "sizes": [10, 20, 30], "repetitions": 2}


def test_a_method_may_stop_before_the_others():
    design = Design.from_settings(BOTH | {"largest": {"delaunay": 20}, "distributions": ["normal"]})
    assert design.methods_of(20) == ("incremental", "delaunay")
    assert design.methods_of(30) == ("incremental",)
    assert design.sizes_of("delaunay") == (10, 20)
    assert design.sizes_of("incremental") == (10, 20, 30)
    assert design.largest_of_all == 20
    assert (design.n_triangulations, design.n_points) == (10, 180)
    assert Design.from_settings(design.model_dump(mode="json")) == design
    whole = Design.from_settings(BOTH | {"distributions": ["normal"]})
    assert design.difference(whole) == "largest is delaunay 20 there and not set here"
    assert whole.largest_of_all == 30
    assert (whole.n_triangulations, whole.n_points) == (12, 240)


def test_only_what_has_the_whole_mesh_in_memory_has_to_stop():
    sizes = [1000, 1_000_000_000]
    settings = BOTH | {"sizes": sizes, "repetitions": 1, "largest": {"delaunay": 1000}}
    assert Design.from_settings(settings).n_points == 4 * (2000 + 1_000_000_000)
    with pytest.raises(InputError, match=r"Let the others stop before, as in largest = "):
        Design.from_settings(settings | {"largest": {"incremental": 1000}})


def test_repetitions_go_with_their_sizes_in_any_order():
    one = Design.from_settings({"sizes": [300, 100, 200], "repetitions": [3, 1, 2]})
    assert one.repetitions_by_size == {100: 1, 200: 2, 300: 3}
    assert one == Design.from_settings(one.model_dump(mode="json"))
    alike = Design.from_settings({"sizes": [300, 100], "repetitions": [4, 4]})
    assert alike == Design.from_settings({"sizes": [100, 300], "repetitions": 4})
    ranged = {"sizes": {"first": 10, "last": 30, "step": 10}, "repetitions": [5, 6, 7]}
    assert Design.from_settings(ranged).repetitions_by_size == {10: 5, 20: 6, 30: 7}


def test_every_way_of_writing_a_design_gives_the_same_one():
    one = Design.from_settings(
        {
            "sizes": {"first": 10, "last": 35, "step": 10},
            "repetitions": 1,
            "distributions": ["normal", "uniform"],
            "methods": ["delaunay", "incremental", "delaunay"],
        }
    )
    other = Design.from_settings(
        {
            "sizes": [30, 10, 20, 10],
            "repetitions": 1,
            "distributions": ["uniform", "normal"],
            "methods": ["incremental", "delaunay"],
        }
    )
    assert one == other
    assert one.difference(other) is None
    assert one.sizes == (10, 20, 30)


@pytest.mark.parametrize(
    ("settings", "words"),
    [
        ({"sizes": [100]}, "does not set repetitions: give a whole number from 1"),
        ({"repetitions": 2}, "does not set sizes: give a list of whole numbers of points from 3"),
        (SMALL | {"repetitions": 0}, "repetitions = 0, which is not allowed"),
        (SMALL | {"repetitions": True}, "repetitions = True"),
        (SMALL | {"repetitions": 2.0}, "repetitions = 2.0"),
        (SMALL | {"repetitions": [2, 0]}, "repetitions = [2, 0], which"),
        (SMALL | {"repetitions": [2, True]}, "repetitions = [2, True], which"),
        (SMALL | {"repetitions": []}, "repetitions = [], which"),
        (SMALL | {"repetitions": ["2", 2]}, "repetitions = ['2', 2], which"),
        (SMALL | {"repetitions": [2]}, "have one number among its repetitions for each of its si"),
        (SMALL | {"repetitions": [1, 2, 3]}, "have one number among its repetitions for each of"),
        ({"sizes": [10, 20, 10], "repetitions": [1, 2, 3]}, "have one number among its repetitio"),
        (SMALL | {"sizes": [100, 2]}, "2 among its sizes"),
        (SMALL | {"sizes": [0]}, "0 among its sizes"),
        (
            SMALL | {"sizes": [268_435_456], "methods": ["delaunay"]},
            r"has 268,435,456 points among its sizes, but a mesh in memory has at most 268,435,455",
        ),
        (SMALL | {"sizes": [MAX_POINTS + 1]}, "10000000001 among its sizes"),
        (SMALL | {"sizes": []}, "sizes = [], which"),
        (SMALL | {"sizes": 100}, "sizes = 100, which"),
        (SMALL | {"sizes": {"first": 10, "last": 20}}, "sizes = {'first': 10, 'last': 20}"),
        (SMALL | {"sizes": {"first": 10, "last": 20, "step": 0}}, "sizes = {"),
        (SMALL | {"sizes": {"first": 3, "last": 300_000_000, "step": 1}}, "sizes = {"),
        (SMALL | {"methods": ["cgal"]}, "'cgal' among its methods, which is not allowed: give a"),
        (SMALL | {"methods": [["delaunay"]]}, "['delaunay'] among its methods"),
        (SMALL | {"distributions": ["cauchy"]}, "one or more of uniform, normal, bivariate_normal"),
        (SMALL | {"distributions": "uniform"}, "distributions = 'uniform'"),
        (SMALL | {"seed": -1}, "seed = -1, which is not allowed: give a whole number from 0"),
        (BOTH | {"largest": {"delaunay": 30}}, "stops at none of its sizes but the last"),
        (BOTH | {"largest": {"delaunay": 15}}, "stops at none of its sizes but the last"),
        (SMALL | {"largest": {"delaunay": 100}}, "or is none of its methods"),
        (
            BOTH | {"largest": {"delaunay": 10, "incremental": 20}},
            "or all stop: give a table with the size at which a method stops",
        ),
        (BOTH | {"largest": {"cgal": 10}}, "'cgal' among its largest, which is not allowed"),
        (BOTH | {"largest": {"delaunay": "10"}}, "'10' among its largest, which is not allowed"),
        (BOTH | {"largest": 10}, "largest = 10, which is not allowed: give a table"),
        (SMALL | {"correlation": 1}, "correlation = 1, which is not allowed: give a number betw"),
        (SMALL | {"correlation": float("nan")}, "correlation = nan"),
        (SMALL | {"repetition": 3}, "unknown setting 'repetition'; the settings are methods, dis"),
        (SMALL | {"repetitions": 1_000_000}, "8,000,000 triangulations, more than the 1,000,000"),
    ],
)
def test_a_wrong_setting_is_named_with_its_value_and_what_is_allowed(settings, words):
    with pytest.raises(InputError) as caught:
        Design.from_settings(settings, "study.toml")
    message = str(caught.value)
    assert words in message
    assert message.startswith("study.toml ")
    assert "\n" not in message


def test_a_file_is_read_and_a_wrong_one_named(tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text("sizes = [10]\nrepetitions = 1\nseed = 7\n")
    assert Design.from_toml(path).seed == 7
    path.write_text("sizes = [10\n")
    with pytest.raises(InputError, match=r"mine\.toml is not a TOML file"):
        Design.from_toml(path)
    with pytest.raises(InputError, match=r"Cannot read the design .*No such file"):
        Design.from_toml(tmp_path / "none.toml")
    with pytest.raises(InputError, match="no preset 'papers'; the presets are beyond, b"):
        Design.from_preset("papers")


def test_another_seed_is_checked_as_the_first():
    design = Design.from_settings(SMALL)
    assert design.with_seed(5).difference(design) == "seed is 5 there and 2022 here"
    with pytest.raises(InputError, match="seed = -5"):
        design.with_seed(-5)
