import pandas as pd
import pytest
from frames import frames

from lepp import METHODS
from reports.page.views import View
from reports.study_page.explorer import N_POINTS, explorer
from study.analysis.building import Study
from study.analysis.measurements import Measurements
from study.design.design import Design
from study.design.sampling import sample_points

VIEWS = [View(method, "normal") for method in METHODS]
DESIGN = Design(methods=tuple(METHODS), sizes=(1000,), repetitions=1, seed=7)


@pytest.fixture(scope="module")
def tables() -> dict[str, pd.DataFrame]:
    study = Study(Measurements.of(*frames(DESIGN), DESIGN))
    return {table.name: table.frame for table in explorer.make(study)}


def rows(frame: pd.DataFrame, view: View) -> pd.DataFrame:
    chosen = frame[(frame["method"] == view.method) & (frame["distribution"] == view.distribution)]
    return chosen.reset_index(drop=True)


def test_points_are_those_of_the_study(tables: dict[str, pd.DataFrame]) -> None:
    drawn = sample_points("normal", N_POINTS, 0, seed=7)
    for view in VIEWS:
        assert (
            rows(tables["explorer_points"], view)[["x", "y"]].to_numpy().tolist() == drawn.tolist()
        )


@pytest.mark.parametrize("view", VIEWS, ids=lambda view: view.method)
def test_following_successors_gives_the_sizes(tables: dict[str, pd.DataFrame], view: View) -> None:
    triangles = rows(tables["explorer_triangles"], view)
    for start, size in enumerate(triangles["lepp_size"]):
        path = [start]
        while not pd.isna(step := triangles.at[path[-1], "successor"]) and step not in path:
            path.append(int(step))
        assert len(path) == size
        last = triangles.loc[path[-1]]
        ends = {last["terminal_a"], last["terminal_b"]}
        assert ends == {triangles.at[start, "terminal_a"], triangles.at[start, "terminal_b"]}
        assert ends <= {last["a"], last["b"], last["c"]}
        assert last["terminal_edge"] == ("boundary" if pd.isna(last["successor"]) else "interior")
