"""Why frozen filters are at chance on a 16 x 16 array in T table 5.3: one thing changed at a time."""

import pandas as pd

from stages.kit.split import shared_by
from stages.kit.stats import interval
from stages.report.items import Table
from stages.report.markdown import signed, with_interval

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
NOTES = [
    "Accuracy of a frozen MobileNetV2 with a new head in per cent [95 % interval over repeated splits, widened for "
    "what they share], touches of a catalogue of furniture drawn at random for testing.",
    "In the thesis frozen filters tell 20.5 % of six classes with 16 x 16 sensels (rate 0.00001) and 43.8 % with 128 x "
    "128 (rate 0.0001). The rows at these rates show how much of that step the rate alone makes here, in ten "
    "passes. That does not prove that it made theirs: the sensor was a real one, and the thesis chose each rate for "
    "its accuracy (T5.3).",
    "The head learns from plain features; in the stage `transfer` they are scaled, and augmented copies stand beside.",
]


def build(results):
    rows = results.rows("coarse_imprints")
    rows = rows[rows["metric"] == "accuracy"]
    plain, lines = rows[rows["setting"] == "plain"].set_index("repetition")["value"], []
    for setting in SETTINGS:
        mine = rows[rows["setting"] == setting]
        if len(mine):
            line = dict(zip(("accuracy", "low", "high"), interval(mine["value"], shared_by("random")), strict=True))
            gain = (mine.set_index("repetition")["value"] - plain).dropna()
            line |= dict(zip(("gain", "gain_low", "gain_high"), interval(gain, shared_by("random")), strict=True))
            lines.append({"setting": setting, "values": len(mine)} | line)
    frame = pd.DataFrame(lines).assign(chance=rows["chance"].iloc[0])
    shown = pd.DataFrame({"what differs": frame["setting"].map(SETTINGS)})
    triples = zip(frame["accuracy"], frame["low"], frame["high"], strict=True)
    shown["accuracy, %"] = [with_interval(*triple, 100, 1) for triple in triples]
    gains = zip(frame["gain"], frame["gain_low"], frame["gain_high"], strict=True)
    points = [[100 * value for value in gain] for gain in gains]
    shown["minus the first row, points"] = [signed(*gain, places=1) if any(gain) else "" for gain in points]
    shown["chance, %"] = [f"{100 * value:.1f}" for value in frame["chance"]]
    return Table("What frozen filters lose on a coarse array", frame, NOTES, shown)
