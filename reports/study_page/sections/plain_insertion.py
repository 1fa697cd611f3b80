"""Which triangulation the paper's numbers are of, as far as a run can tell."""

import pandas as pd

from lepp import METHODS
from reports.page.evidence import Evidence
from reports.page.views import distribution_word
from reports.study_page.tables import TABLE_4
from study.paper.judging import DIFFERS
from study.paper.published import MEAN_LEPP, REFERENCE_METHOD, SHOWN
from study.paper.scoreboard import OVERALL
from study.text.numbers import listed, p_is, show

_PLAIN = "plain insertion, which never flips an edge"


def paper_triangulation(evidence: Evidence) -> str | None:
    """Say which methods have the means of the paper's Table 4; None if no group of it was run."""
    rows = evidence.rows(OVERALL, quantity=MEAN_LEPP).frame.set_index("method")
    if rows.empty:
        return None
    others = rows.drop(index=REFERENCE_METHOD, errors="ignore")
    agreeing = [_name(method) for method in others.index[others["verdict"] != DIFFERS]]
    if REFERENCE_METHOD not in rows.index:
        verb = "agree" if len(agreeing) == len(others) else "do not agree"
        return (
            f"The mean LEPP sizes that the paper prints {verb} with "
            f"{listed([_name(method) for method in others.index])} ({_tests(others)}); {_PLAIN}, "
            "was not part of this run."
        )
    plain = rows.loc[[REFERENCE_METHOD]]
    if plain["verdict"].iloc[0] == DIFFERS:
        return (
            "The mean LEPP sizes that the paper prints do not agree with this run's "
            f"{_PLAIN} ({_tests(plain)}): this run does not tell which triangulation the paper "
            "used."
        )
    if others.empty:
        return (
            f"The mean LEPP sizes that the paper prints agree with this run's {_PLAIN} "
            f"({_tests(plain)}). A user of CGAL would expect Delaunay triangulations, which this "
            "run does not have to compare."
        )
    if agreeing:
        return (
            f"The mean LEPP sizes that the paper prints agree with {_PLAIN}, and with "
            f"{listed(agreeing)} as well: this run is too small to tell which the paper used."
        )
    return (
        f"The paper's triangulations are not {listed([_name(m) for m in others.index], 'or')}: the "
        f"mean LEPP sizes that it prints agree with {_PLAIN} ({_tests(plain)}). That is what the "
        "package makes that the paper names, CGAL's “2D Triangulation”. "
        + " ".join(filter(None, (_beside(evidence, method) for method in others.index)))
    ).strip()


def _name(method: str) -> str:
    return f"{METHODS[method].word} triangulations"


def _tests(rows: pd.DataFrame) -> str:
    return "; ".join(
        f"χ²\u00a0=\u00a0{show(row.chi2, 'fixed1')} on {row.df} degrees of freedom, "
        f"{p_is(row.log10_p)}"
        for row in rows.itertuples()
    )


def _beside(evidence: Evidence, method: str) -> str | None:
    groups = evidence.rows(TABLE_4, method=method, distribution=SHOWN).frame
    printed = groups.dropna(subset=["published_mean", "mean_lepp"])
    if printed.empty:
        return None
    last = printed.iloc[-1]
    return (
        f"{_name(method)[0].upper()}{_name(method)[1:]} of this run's {last['n_points']:,} "
        f"{distribution_word(SHOWN)} points have a mean of {show(last['mean_lepp'], 'fixed4')}, "
        "where the paper prints "
        f"{show(last['published_mean'], 'fixed4')}."
    )
