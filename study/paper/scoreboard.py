"""The scoreboard: verdicts on the published numbers counted, and the independent ones together."""

from collections.abc import Iterator

import numpy as np
import pandas as pd
from scipy import stats

from study.analysis.building import Study, rows_of
from study.analysis.table import METHOD, Column, Declaration, Row
from study.paper import judging, published
from study.paper.consistency import PUBLISHED_TABLE
from study.paper.judging import AGREES, CLOSE, DIFFERS
from study.paper.published import INDEPENDENT
from study.paper.reproduction import REPRODUCTION
from study.statistics.tails import log10_chi2_tail
from study.statistics.thresholds import AGREES_UP_TO, TABLE_DIFFERS_BELOW


def verdict_column(verdict: str) -> str:
    """Name of the column that counts a verdict."""
    return verdict.replace(" ", "_")


def independent_column(verdict: str) -> str:
    """Name of the column that counts a verdict on independent numbers."""
    return f"independent_{verdict}"


#: Verdicts by standard errors.
JUDGED = (AGREES, CLOSE, DIFFERS)

SUMMARY = Declaration(
    "reproduction_summary",
    "Verdicts on the published numbers",
    (
        METHOD,
        PUBLISHED_TABLE,
        Column("numbers", "Numbers", "", "int"),
        Column("independent", "Independent, and judged", "", "int"),
        *(Column(independent_column(v), f"of these {v}", "", "int") for v in JUDGED),
        *(Column(verdict_column(v), v.capitalize(), "", "int") for v in judging.VERDICTS),
    ),
    note=f"{judging.RULE}. The last columns count all numbers, independent or not.",
)

#: All independent numbers together, beside the quantities of Table 4.
ALL_INDEPENDENT = "all independent numbers"
#: Verdict on numbers that are nearer to ours than chance brings them.
TOO_CLOSE = "closer than chance"

OVERALL = Declaration(
    "reproduction_overall",
    "The independent numbers together",
    (
        METHOD,
        Column("quantity", "Quantity"),
        Column("numbers", "Numbers", "", "int"),
        Column("beyond", f"Beyond {AGREES_UP_TO:g} standard errors", "", "int"),
        Column("expected_beyond", "Expected by chance", "", "fixed1"),
        Column("chi2", "χ²", "", "fixed1"),
        Column("df", "Df", "", "int"),
        Column("p", "p of more", "", "p"),
        Column("log10_p", "log10 p", "", "log10p"),
        Column("p_less", "p of less", "", "p"),
        Column("shift", "Common shift, z", "standard errors", "fixed2"),
        Column("shift_p", "p of the shift", "", "p"),
        Column("furthest", "Largest difference", "standard errors", "fixed2"),
        Column("verdict", "Verdict", "", "verdict"),
    ),
    note="χ² is the sum of the squared differences, in standard errors; p of more is the "
    "chance of a larger sum, p of less of a smaller. The common shift is the sum of the "
    "differences over the root of their number (Stouffer), normal if there is none; its p counts "
    "both directions. All independent numbers have no shift together, as they are of different "
    "kinds. Verdicts: differs if p of more or of the shift is below "
    f"{TABLE_DIFFERS_BELOW}, else {TOO_CLOSE} if p of less is. Independent are the numbers "
    "that are not derived from another printed one; those of one run are not quite without a bond: "
    "Levene's F hangs on the standard deviations.",
)


@rows_of(SUMMARY, needs=(REPRODUCTION,))
def summary(study: Study) -> Iterator[Row]:
    """Count the verdicts by published table."""
    frame = study.tables.rows(REPRODUCTION).frame
    for method in study.data.design.methods:
        for number, judged in frame[frame["method"] == method].groupby("published_table"):
            counts = judged["verdict"].value_counts()
            counted = judged.loc[judged["standing"] == INDEPENDENT, "verdict"].value_counts()
            independent = {independent_column(v): int(counted.get(v, 0)) for v in JUDGED}
            row: Row = {
                "method": method,
                "published_table": number,
                "numbers": len(judged),
                "independent": sum(independent.values()),
            }
            row |= independent
            yield row | {verdict_column(v): int(counts.get(v, 0)) for v in judging.VERDICTS}


@rows_of(OVERALL, needs=(REPRODUCTION,))
def overall(study: Study) -> Iterator[Row]:
    """Test the independent numbers together, by quantity of Table 4 and all."""
    for method in study.data.design.methods:
        rows = study.tables.rows(REPRODUCTION, method=method, standing=INDEPENDENT)
        judged = rows.frame[rows["difference"].notna()]
        for quantity in published.QUANTITIES_OF_TABLE_4:
            of_quantity = judged[judged["quantity"] == quantity]
            if not of_quantity.empty:
                yield {"method": method, "quantity": quantity} | _together(of_quantity, shift=True)
        if not judged.empty:
            together = _together(judged, shift=False)
            yield {"method": method, "quantity": ALL_INDEPENDENT} | together


def _together(judged: pd.DataFrame, *, shift: bool) -> Row:
    z = judged["difference"].to_numpy()
    chi2, df = float(z @ z), len(z)
    p, p_less = float(stats.chi2.sf(chi2, df)), float(stats.chi2.cdf(chi2, df))
    row: Row = {
        "numbers": df,
        "beyond": int((np.abs(z) > AGREES_UP_TO).sum()),
        "expected_beyond": judged["chance_beyond"].sum(),
        "chi2": chi2,
        "df": df,
        "p": p,
        "log10_p": log10_chi2_tail(chi2, df),
        "p_less": p_less,
        "furthest": z[np.abs(z).argmax()],
    }
    lowest = p
    if shift:
        common = float(z.sum() / np.sqrt(df))
        shift_p = float(2 * stats.norm.sf(abs(common)))
        row |= {"shift": common, "shift_p": shift_p}
        lowest = min(p, shift_p)
    verdict = DIFFERS if lowest < TABLE_DIFFERS_BELOW else AGREES
    if verdict == AGREES and p_less < TABLE_DIFFERS_BELOW:
        verdict = TOO_CLOSE
    return row | {"verdict": verdict}
