"""Quartiles of two sides compared: the thesis tells distances by the box plot of all views (T figure 3.36)."""

import pandas as pd

from stages.report.claims import Claim
from stages.report.differences import side, statistic
from stages.report.results import Results

MEDIAN, UPPER_QUARTILE = "median_below", "upper_quartile_below"  # names of statistics


def below(results: Results, claim: Claim, share: float) -> pd.Series:
    """How many more of the first side's values than of the second's lie below a quantile of both, as a share by unit.

    It is above zero where the first side's own quantile is the lower one. Values at the quantile count half.
    """
    sides = (claim.first, claim.other), (claim.other, claim.first)
    both = pd.concat([side(results, claim, own, other) for own, other in sides], axis=1, keys=["first", "second"])
    both = both.dropna()
    if both.empty:
        return both["first"]
    edge = both.stack().quantile(share)  # pyright: ignore[reportAttributeAccessIssue]
    under = (both < edge) + (both == edge) / 2
    return (under["first"] - under["second"]).groupby(level=list(range(len(claim.over))), sort=False).mean()


@statistic(MEDIAN)
def median_below(results: Results, claim: Claim) -> pd.Series:
    """Of the median."""
    return below(results, claim, 0.5)


@statistic(UPPER_QUARTILE)
def upper_quartile_below(results: Results, claim: Claim) -> pd.Series:
    """Of the 75th percentile."""
    return below(results, claim, 0.75)
