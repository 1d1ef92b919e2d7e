"""What table, charts and claims of the exploration have in common."""

import numpy as np

WAYS = {
    "gain": "where the belief gains most",
    "saliency": "most salient first",
    "random": "in random order",
}
TINTS = {"gain": "#0072B2", "saliency": "#009E73", "random": "#E69F00"}
LIKELIHOODS = {
    "imprint": "by imprints",
    "imprint_place": "by imprints and places",
    "imprint_product": "by imprints, as if independent",
}
HEADLINE = 0.95  # belief at which the table and the claims stop


def curves(rows):
    """Frame indexed by (repetition, touches): accuracy after a fixed number of touches."""
    fixed = rows[(rows["stop"] == "fixed") & (rows["metric"] == "accuracy")]
    return fixed.pivot(index="repetition", columns="level", values="value")


def fixed_at(rows, touches):
    """(r,) accuracy of a fixed number of touches, interpolated at touches (r,), a repetition of `touches` each."""
    curve = curves(rows)
    levels = curve.columns.to_numpy(dtype=float)
    return np.array([np.interp(touches[one], levels, curve.loc[one]) for one in touches.index])


def at_confidence(rows, level, metric="accuracy"):
    """Rows by repetition that stopped at a confidence."""
    found = rows[(rows["stop"] == "confidence") & np.isclose(rows["level"], level) & (rows["metric"] == metric)]
    return found.set_index("repetition")


def needed(rows, accuracy):
    """Touches after which the mean accuracy of a fixed number reaches `accuracy`, interpolated; NaN if never."""
    curve = curves(rows).mean()
    reached = np.flatnonzero(curve.to_numpy() >= accuracy)
    if len(reached) == 0:
        return np.nan
    last = reached[0]
    if last == 0:
        return float(curve.index[0])
    low, high = curve.iloc[last - 1], curve.iloc[last]
    return float(curve.index[last - 1] + (accuracy - low) / (high - low))
