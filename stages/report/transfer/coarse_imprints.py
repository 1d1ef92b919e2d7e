"""Why frozen filters are at chance on a 16 x 16 array in T table 5.3: one thing changed at a time."""

import pandas as pd

from haptic_glance.know.split import shared_by
from stages.kit.stats import interval
from stages.report.grid import cell_texts, percent
from stages.report.items import Table
from stages.report.markdown import signed
from stages.report.ranking import Ranking
from stages.report.results import Results

SETTINGS = {
    "plain": "16 x 16 cells, learning rate searched",
    "fine_array": "128 x 128 cells",
    "three_channels": "the imprint in all three channels, not in red alone",
    "blocks": "cells drawn as blocks, not smoothed",
    "settled": "normalisation by the statistics of the touches",
    "size_224": "images of 224 pixels, not 80",
    "quarter_of_the_touches": "a quarter of the touches to learn from",
    "noise_0.05": "noise of 5 % of full scale",
    "noise_0.2": "noise of 20 %",
    "skin": "a worse sensor: blur of a cell, noise of 10 %, 5 % dead cells",
    "random_weights": "random weights",
    "rate_of_table_5_4": "the learning rate of T table 5.4 (0.0001)",
    "rate_of_table_5_3": "the learning rate of T table 5.3 (0.00001)",
    "fine_array_rate_of_table_5_4": "128 x 128 cells, the rate of table 5.4",
    "fine_array_rate_of_table_5_3": "128 x 128 cells, the rate of table 5.3",
    "skin_and_rate": "the worse sensor and the rate of table 5.3",
}


def build(results: Results) -> Table:
    """Accuracy of each setting, and what it gains over the first on the same splits."""
    rows = results.rows("coarse_imprints", metric="accuracy")
    values = rows.pivot(index="repetition", columns="setting", values="value")
    share, lines = shared_by("random"), []
    for setting in [name for name in SETTINGS if name in values]:
        own, gain = values[setting], values[setting] - values["plain"]
        lines.append((setting, own.count(), *interval(own, share), *interval(gain, share), rows["chance"].iloc[0]))
    gains = ["gain", "gain_low", "gain_high"]
    frame = pd.DataFrame(lines, columns=["setting", "values", "accuracy", "low", "high", *gains, "chance"])
    shown = {
        "what differs": frame["setting"].map(SETTINGS),
        "accuracy, %": cell_texts(frame, 1),
        "minus the first row, points": [signed(*gain, places=1) for gain in 100 * frame[gains].to_numpy()],
        "chance, %": [percent(guess, 1) for guess in frame["chance"]],
    }
    return Table(frame, pd.DataFrame(shown), best=Ranking("accuracy, %"))
