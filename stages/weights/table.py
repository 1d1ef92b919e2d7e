"""The table of weights: one row per method, channel (or feature) and object left out of the training."""

import numpy as np
import pandas as pd

from haptic_glance.look.weights.weights import ALL, GLANCES, METHODS, learned_weight_rows, weights
from stages.kit.run import Rows

CHOICES = ("gaze", "fixations")  # published weights of GLANCES, or those learned from the data set


def weight_table(training_data: dict[str, dict[str, np.ndarray]], chosen: str) -> pd.DataFrame:
    """Frame with columns method, channel, weight, left_out.

    training_data: dict name -> arrays of collect_training_data, may be empty. chosen: of CHOICES, whether the weights
    of GLANCES are the published ones or learned. Raises ValueError for another choice, or for weights that cannot be
    learned for lack of ground truth.
    """
    if chosen not in CHOICES or (chosen == "fixations" and not training_data):
        reason = "" if training_data else "; no object has ground truth to learn from"
        raise ValueError(f"weights.method {chosen!r} is not available: choose {', '.join(CHOICES)}{reason}")
    rows = [
        {"method": method, "channel": channel, "weight": weight, "left_out": ALL}
        for method in METHODS
        if method not in GLANCES or chosen != "fixations"
        for channel, weight in weights(method).items()
    ]
    learned = learned_weight_rows(training_data) if training_data else []
    rows += [row for row in learned if row["method"] not in GLANCES or chosen == "fixations"]
    return pd.DataFrame(rows)


def weight_rows(table: pd.DataFrame) -> Rows:
    """The table as measurements: `item` is the object left out, empty where the weights are of all objects."""
    renamed = table.rename(columns={"left_out": "item", "weight": "value"})
    return renamed.assign(metric="weight").to_dict("records")  # type: ignore[return-value]  # names of columns are texts
