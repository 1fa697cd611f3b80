"""The share of a variance that groups account for, with its interval."""

from scipy import optimize, special

from study.statistics.thresholds import CONFIDENCE


def eta_squared(f: float, df1: float, df2: float) -> float:
    """Share of the sample's variance between groups, from an F statistic.

    Parameters
    ----------
    f : float
        F statistic with df1 and df2 degrees of freedom, at least 0.
    df1, df2 : float
        Above 0.

    Returns
    -------
    float
        From 0 to 1: the sum of squares between groups over that of all, f df1 / (f df1 + df2).
    """
    return f * df1 / (f * df1 + df2)


def omega_squared(f: float, df1: float, total: int) -> float:
    """Share of the variance between groups with its bias corrected, from an F statistic.

    Parameters
    ----------
    f : float
        F statistic with df1 degrees of freedom between the groups.
    df1 : float
    total : int
        Number of observations.

    Returns
    -------
    float
        From 0 to 1; 0 where f is below 1.

    Notes
    -----
    Hays (1963), Statistics for Psychologists: df1 (f - 1) / (df1 (f - 1) + total).
    """
    return max(0.0, df1 * (f - 1) / (df1 * (f - 1) + total))


def population_share(f: float, df1: float, df2: float, total: int) -> tuple[float, float]:
    """Interval of the population's share of variance between groups, from an F statistic.

    Parameters
    ----------
    f : float
        F statistic with df1 and df2 degrees of freedom.
    df1, df2 : float
    total : int
        Number of observations.

    Returns
    -------
    low, high : float
        From 0 to 1, at the level `study.statistics.thresholds.CONFIDENCE`.

    Notes
    -----
    With the interval of the noncentrality lambda, the share is lambda / (lambda + total);
    Steiger (2004), Psychological Methods 9, 164-182. statsmodels' interval stops at a lambda of
    10,000, which large meshes exceed.
    """
    tail = (1 - CONFIDENCE) / 2
    low, high = (_noncentrality(f, df1, df2, level) for level in (1 - tail, tail))
    return low / (low + total), high / (high + total)


def _noncentrality(f: float, df1: float, df2: float, level: float) -> float:
    # The lambda for which P(F <= f) is `level`; 0 where no lambda makes so small an f likely.
    def excess(lam: float) -> float:
        return float(special.ncfdtr(df1, df2, lam, f)) - level

    if excess(0) <= 0:
        return 0.0
    above = max(1.0, df1 * f)
    while excess(above) > 0:
        above *= 2
    return float(optimize.brentq(excess, 0, above, rtol=1e-10))
