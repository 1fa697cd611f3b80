"""The paper's statements, on results that are made to bear them out or not."""

import pytest
from frames import design, frames

from study.analysis import analyse


@pytest.mark.parametrize(
    ("low", "width", "holds"),
    [(0.25, 0.001, "no"), (0.40, 0.001, "yes"), (0.30, 0.3, "undecided")],
    ids=["one size surely below", "all surely above", "one size unsure"],
)
def test_one_group_surely_below_a_third_refutes_the_premise(low, width, holds):
    asked = design(distributions=("uniform",))
    results, *others = frames(asked)
    inside = results["n_interior_longest"]
    share = 0.45 + 0.001 * results["replicate"]
    first = results["n_points"] == 1000
    share[first] = low + width * (results["replicate"][first] % 2)
    unsure = results["n_points"] == 2000
    if holds == "no":  # a size that leaves it open does not outweigh the one that refutes
        share[unsure] = 0.2 + 0.3 * (results["replicate"][unsure] % 2)
    results["n_type_c"] = (share * inside).astype(int)
    tables = analyse(results, *others, asked)
    premise = tables["theorem_2"].frame["premise"]
    assert premise[0] == holds
    assert ("undecided" in set(premise)) == (holds != "yes")
    stated = tables["statements"].frame.set_index("statement")["holds"]
    assert stated["The probability p of a type C neighbour is at least 1/3"] == holds
