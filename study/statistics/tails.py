"""Upper tails of the F, t and chi-squared distributions as decimal logarithms.

A double underflows at 10^-308. The p-values of a large study lie far below, and their logarithm
is then computed from the leading factor of the incomplete beta or gamma function.
"""

import numpy as np
from scipy import special

#: Below this the probability itself has lost digits.
_TINY = 1e-290


def log10_f_tail(f: float, df1: float, df2: float) -> float:
    """log10 P(F > f) of the F distribution with df1 and df2 degrees of freedom.

    Parameters
    ----------
    f : float
        At least 0.
    df1, df2 : float
        Above 0.

    Returns
    -------
    float
        At most 0.

    Notes
    -----
    P(F > f) = I_x(df2 / 2, df1 / 2) with x = df2 / (df2 + df1 f), Abramowitz and Stegun 26.6.2.
    """
    return _log10_beta(df2 / 2, df1 / 2, df2 / (df2 + df1 * f))


def log10_t_tail(t: float, df: float) -> float:
    """log10 P(T > t) of Student's t distribution with df degrees of freedom.

    Parameters
    ----------
    t : float
        Of either sign.
    df : float
        Above 0.

    Returns
    -------
    float
        At most 0.

    Notes
    -----
    For t >= 0, P(T > t) = I_x(df / 2, 1 / 2) / 2 with x = df / (df + t^2), Abramowitz and
    Stegun 26.7.1.
    """
    if t < 0:
        return float(np.log10(special.stdtr(df, -t)))
    return _log10_beta(df / 2, 0.5, df / (df + t * t)) - float(np.log10(2))


def log10_chi2_tail(x: float, df: float) -> float:
    """log10 P(X > x) of the chi-squared distribution with df degrees of freedom.

    Parameters
    ----------
    x : float
        At least 0.
    df : float
        Above 0.

    Returns
    -------
    float
        At most 0.

    Notes
    -----
    P(X > x) = Q(a, y), a = df / 2, y = x / 2; where it underflows, Gamma(a, y) =
    e^-y y^a U(1, 1 + a, y), DLMF 8.5.3.
    """
    a, y = df / 2, x / 2
    tail = special.gammaincc(a, y)
    if tail > _TINY:
        return float(np.log10(tail))
    log = -y + a * np.log(y) + np.log(special.hyperu(1, 1 + a, y)) - special.gammaln(a)
    return float(log / np.log(10))


def _log10_beta(a: float, b: float, x: float) -> float:
    # Where I_x(a, b) underflows: x^a (1 - x)^b / (a B(a, b)) 2F1(a + b, 1; a + 1; x), DLMF 8.17.8.
    tail = special.betainc(a, b, x)
    if tail > _TINY:
        return float(np.log10(tail))
    log = a * np.log(x) + b * np.log1p(-x) - np.log(a) - special.betaln(a, b)
    return float((log + np.log(special.hyp2f1(a + b, 1, a + 1, x))) / np.log(10))
