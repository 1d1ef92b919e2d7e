"""The table of weights: one row per method, channel (or feature) and object left out of the training."""

import numpy as np
import pandas as pd

from stages.kit.run import Rows

from .learn_weights import ALL, learned_weight_rows
from .published import ENHANCED, GLANCES, METHODS, weights

FEATURE_METHODS = ("gaze", "fixations")  # published weights of the fixation models, or those learned from the data set


def weight_table(training_data: dict[str, dict[str, np.ndarray]], chosen: str) -> pd.DataFrame:
    """Frame with columns method, channel, weight, left_out; the rows of `enhanced` repeat those of the chosen method.

    Those of GLANCES are published or learned by the same choice. training_data: dict name -> arrays of
    collect_training_data, may be empty. The choice is stored in the table, so that later stages do not read the
    settings of another stage. Raises ValueError for a choice that is not in
    FEATURE_METHODS, or whose weights were not learned for lack of ground truth.
    """
    rows = [
        {"method": method, "channel": channel, "weight": weight, "left_out": ALL}
        for method in METHODS
        if method not in GLANCES or chosen != "fixations"
        for channel, weight in weights(method).items()
    ]
    learned = learned_weight_rows(training_data) if training_data else []
    rows += [row for row in learned if row["method"] not in GLANCES or chosen == "fixations"]
    repeated = [row | {"method": ENHANCED} for row in rows if row["method"] == chosen and chosen in FEATURE_METHODS]
    if not repeated:
        reason = "" if training_data else "; no object has ground truth to learn from"
        raise ValueError(f"weights.method {chosen!r} is not available: choose {', '.join(FEATURE_METHODS)}{reason}")
    return pd.DataFrame(rows + repeated)


def weight_rows(table: pd.DataFrame) -> Rows:
    """The table as measurements: `item` is the object left out, empty where the weights are of all objects."""
    renamed = table.rename(columns={"left_out": "item", "weight": "value"})
    return renamed.assign(metric="weight").to_dict("records")  # type: ignore[return-value]  # names of columns are texts
