"""Which triangulation the paper's numbers are of: every answer that a run can give."""

import pandas as pd
import pytest
from frames import design

from reports.page.evidence import Evidence
from reports.study_page.sections.plain_insertion import paper_triangulation
from reports.study_page.tables import TABLE_4
from study.analysis.table import Tables
from study.paper.judging import AGREES, DIFFERS
from study.paper.scoreboard import OVERALL, TOO_CLOSE

PLAIN = "plain insertion, which never flips an edge"


def evidence(printed: float | None = 3.0661, **verdicts: str) -> Evidence:
    """Make what a run of these methods says, by their verdicts on the means of Table 4."""
    overall = [
        {
            "method": method,
            "quantity": "mean LEPP",
            "chi2": 15.6,
            "df": 20,
            "log10_p": {AGREES: -0.13, TOO_CLOSE: -1e-9, DIFFERS: -3000.0}[verdict],
            "verdict": verdict,
        }
        for method, verdict in verdicts.items()
    ]
    groups = [
        {
            "method": method,
            "distribution": "uniform",
            "n_points": n,
            "mean_lepp": mean,
            "published_mean": printed if n == 200_000 else None,
        }
        for method in verdicts
        for n, mean in ((200_000, 3.52), (10**6, 3.5))
    ]
    tables = Tables([OVERALL.table(overall), TABLE_4.table(groups)])
    return Evidence(tables, design(methods=tuple(verdicts)), {})


@pytest.mark.parametrize(
    ("verdicts", "sentence"),
    [
        (
            {"incremental": AGREES, "delaunay": DIFFERS},
            f"The paper's triangulations are not Delaunay triangulations: the mean LEPP sizes that "
            f"it prints agree with {PLAIN} (χ² = 15.6 on 20 degrees of freedom, "
            "p = 0.7413). That is what the package makes that the paper names, CGAL's “2D "
            "Triangulation”. Delaunay triangulations of this run's 200,000 uniform points have a "
            "mean of 3.5200, where the paper prints 3.0661.",
        ),
        (
            {"incremental": AGREES},
            f"The mean LEPP sizes that the paper prints agree with this run's {PLAIN} "
            "(χ² = 15.6 on 20 degrees of freedom, p = 0.7413). A user of CGAL would expect "
            "Delaunay triangulations, which this run does not have to compare.",
        ),
        (
            {"incremental": TOO_CLOSE},
            f"The mean LEPP sizes that the paper prints agree with this run's {PLAIN} "
            "(χ² = 15.6 on 20 degrees of freedom, p = 1.0000). A user of CGAL would expect "
            "Delaunay triangulations, which this run does not have to compare.",
        ),
        (
            {"incremental": DIFFERS},
            "The mean LEPP sizes that the paper prints do not agree with this run's "
            f"{PLAIN} (χ² = 15.6 on 20 degrees of freedom, p < 10⁻³⁰⁷): this run does not tell "
            "which triangulation the paper used.",
        ),
        (
            {"incremental": AGREES, "delaunay": AGREES},
            f"The mean LEPP sizes that the paper prints agree with {PLAIN}, and with Delaunay "
            "triangulations as well: this run is too small to tell which the paper used.",
        ),
        (
            {"incremental": DIFFERS, "delaunay": DIFFERS},
            "The mean LEPP sizes that the paper prints do not agree with this run's "
            f"{PLAIN} (χ² = 15.6 on 20 degrees of freedom, p < 10⁻³⁰⁷): this run does not tell "
            "which triangulation the paper used.",
        ),
        (
            {"delaunay": DIFFERS},
            "The mean LEPP sizes that the paper prints do not agree with Delaunay triangulations "
            "(χ² = 15.6 on 20 degrees of freedom, p < 10⁻³⁰⁷); "
            f"{PLAIN}, was not part of this run.",
        ),
        (
            {"delaunay": AGREES},
            "The mean LEPP sizes that the paper prints agree with Delaunay triangulations "
            "(χ² = 15.6 on 20 degrees of freedom, p = 0.7413); "
            f"{PLAIN}, was not part of this run.",
        ),
    ],
)
def test_the_triangulation_follows_the_verdicts(verdicts: dict[str, str], sentence: str) -> None:
    text = paper_triangulation(evidence(**verdicts))
    assert text is not None
    assert text.replace("\u00a0", " ") == sentence


def test_a_run_without_a_published_size_says_nothing_of_it() -> None:
    assert paper_triangulation(evidence()) is None


def test_no_mean_is_compared_where_the_paper_prints_none() -> None:
    text = paper_triangulation(evidence(None, incremental=AGREES, delaunay=DIFFERS))
    assert text is not None
    assert text.endswith("that the paper names, CGAL's “2D Triangulation”.")
    assert pd.isna(evidence(None, delaunay=AGREES).tables["table_4"].frame["published_mean"]).all()
