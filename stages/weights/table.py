"""The table of weights: a row a method, a channel (or feature), and an object that was left out of the learning."""

import pandas as pd

from .learn import ALL, learned_rows
from .published import ENHANCED, METHODS, weights

OF_FEATURES = ("gaze", "fixations")  # weights of the fixation model's features; the others weigh channels


def weight_table(lessons, chosen):
    """Frame with columns method, channel, weight, left_out; the rows of `enhanced` repeat those of the chosen method.

    lessons: dict name -> lesson, may be empty. So the choice travels with the data, and later stages follow it without
    reading another stage's settings. Raises ValueError for a choice that is not in OF_FEATURES or was not learned here.
    """
    rows = [
        {"method": method, "channel": channel, "weight": weight, "left_out": ALL}
        for method in METHODS
        for channel, weight in weights(method).items()
    ]
    rows += learned_rows(lessons) if lessons else []
    repeated = [row | {"method": ENHANCED} for row in rows if row["method"] == chosen and chosen in OF_FEATURES]
    if not repeated:
        known = ", ".join(OF_FEATURES)
        learn = "" if lessons else "; no object has ground truth to learn from"
        raise ValueError(f"weights.method {chosen!r} is not there: choose {known}{learn}")
    return pd.DataFrame(rows + repeated)
