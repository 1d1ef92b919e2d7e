"""The table of weights: a row a method, a channel (or feature), and an object that was left out of the learning."""

import pandas as pd

from .learn import ALL, learned_rows
from .published import ENHANCED, METHODS, weights


def weight_table(lessons, chosen):
    """Frame with columns method, channel, weight, left_out; the rows of `enhanced` repeat those of the chosen method.

    lessons: dict name -> lesson, may be empty. So the choice travels with the data, and later stages follow it without
    reading another stage's settings. Raises ValueError for a choice that is neither published nor learned here.
    """
    rows = [
        {"method": method, "channel": channel, "weight": weight, "left_out": ALL}
        for method in METHODS
        for channel, weight in weights(method).items()
    ]
    rows += learned_rows(lessons) if lessons else []
    repeated = [row | {"method": ENHANCED} for row in rows if row["method"] == chosen]
    if not repeated:
        known = ", ".join(dict.fromkeys(row["method"] for row in rows))
        learn = "" if lessons else "; no object has ground truth to learn from"
        raise ValueError(f"weights.method {chosen!r} is not there: choose one of {known}{learn}")
    return pd.DataFrame(rows + repeated)
