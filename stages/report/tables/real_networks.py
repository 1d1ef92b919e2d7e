"""Networks for photographs on recorded touches: a pressure array and a hand of fingertips."""

from stages.report.items import Table
from stages.report.markdown import with_interval
from stages.report.style import label

from ._recorded import DATA, OVER, SPLITS, measured_lines, origin

NOTES = [
    "Accuracy in per cent [95 % interval]: over repeated splits, widened for what they share; with objects kept for "
    "the test, over those objects. Networks see 96 x 96 pixels where they are frozen and 64 x 64 where fine-tuned.",
    "Features and kNN: what table 4.4 recognises the same touches with. Random weights: the same network, untrained.",
    "Pressure images: Gandarias, García-Cerezo and Gómez-de-Gabriel 2019, 28 x 50 cells. Fingertips: BTS3 v2, 24 "
    "electrodes a finger at their published places, one finger a channel.",
]


def build(results):
    frame = measured_lines(results)
    shown = frame.assign(
        data=frame["data"].map(lambda name: DATA.get(name, name)),
        split=frame["split"].map(lambda name: SPLITS.get(name, name)),
        network=frame["method"].map(lambda name: "features and kNN" if name == "features_knn" else label(name)),
    )
    shown["starts from"] = [origin(*pair) for pair in zip(frame["weights"], frame["had"], strict=True)]
    shown["filters"] = [label(mode) if isinstance(mode, str) else "–" for mode in frame["mode"]]
    triples = zip(frame["accuracy"], frame["low"], frame["high"], strict=True)
    shown["accuracy, %"] = [with_interval(*triple, 100, 1) for triple in triples]
    shown["over"] = [_units(*pair) for pair in zip(frame["split"], frame["values"], strict=True)]
    columns = ["data", "split", "network", "starts from", "filters", "accuracy, %", "over"]
    return Table("Networks that learned by sight, on recorded touches", frame, NOTES, shown[columns])


def _units(split, count):
    """What an interval runs over."""
    return f"{count} {'objects' if split in OVER else 'splits'}"
