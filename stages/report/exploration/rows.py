"""What table, charts and claims of the exploration have in common."""

import numpy as np
import pandas as pd

from stages.kit.split import Split, shared_by
from stages.report.grid import within

STAGE, GROUP = "exploration", "six"
WAYS = {"gain": "where the belief gains most", "saliency": "most salient first", "random": "in random order"}
LIKELIHOODS = {
    "imprint": "by imprints",
    "imprint_place": "by imprints and places",
    "imprint_product": "by imprints, as if independent",
}
HELD_OUT = {Split.RANDOM: "at random", Split.REGIONS: "unseen regions"}
HEADLINE = 0.95  # belief at which the table and the claims stop


def points(rows: pd.DataFrame, by: list[str]) -> pd.DataFrame:
    """Accuracy with its interval, mean touches and stated belief, one row for each combination of columns `by`."""
    found = []
    for key, group in rows.groupby(by, sort=False):
        cell = {"touches": group["touches"].mean(), "stated": group["belief"].mean()}
        accuracy = within(group["value"], shared_by(group["split"].iloc[0]))
        cell |= zip(("accuracy", "low", "high"), accuracy, strict=True)
        found.append(dict(zip(by, key, strict=True)) | cell)
    return pd.DataFrame(found)


def curves(rows: pd.DataFrame) -> pd.DataFrame:
    """Frame indexed by (repetition, touches): accuracy after a fixed number of touches."""
    fixed = rows[(rows["stop"] == "fixed") & (rows["metric"] == "accuracy")]
    return fixed.pivot(index="repetition", columns="level", values="value")


def fixed_at(rows: pd.DataFrame, touches: pd.Series) -> pd.Series:
    """Accuracy of a fixed number of touches by repetition, interpolated at the repetition's `touches`."""
    curve = curves(rows)
    levels = curve.columns.to_numpy(dtype=float)
    return pd.Series({one: np.interp(touches[one], levels, curve.loc[one]) for one in touches.index})


def needed(rows: pd.DataFrame, accuracy: float) -> float:
    """Touches after which the mean accuracy of a fixed number reaches `accuracy`, interpolated; NaN if never."""
    curve = curves(rows).mean()
    reached = np.flatnonzero(curve >= accuracy)
    if len(reached) == 0:
        return np.nan
    last = curve.iloc[max(reached[0] - 1, 0) : reached[0] + 1]  # the step that reaches it, or the first touch
    return float(np.interp(accuracy, last, last.index))
