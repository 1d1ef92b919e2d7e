"""Networks for photographs on recorded touches: a pressure array and a hand of fingertips."""

from stages.report.items import Table
from stages.report.markdown import signed, with_interval
from stages.report.style import label

from .pairs import OVER
from .rows import DATA, SPLITS, measured_lines, origin

NOTES = [
    "Accuracy in per cent [95 % interval]: over repeated splits, widened for what they share; with objects kept for "
    "the test, over those objects. px: pixels a side that a network sees. Guessing: any class, or always the commonest "
    "of the training part, whichever is right more often.",
    "Gains in points of accuracy [95 % interval], paired: each split, or object, minus the same one. Over features and "
    "kNN: what table 4.4 recognises the same touches with, of fingertips the readings of their electrodes. Over "
    "random weights: the same network that did not learn by sight, one draw of its weights, so that the interval holds "
    "for that draw. Untrained, one architecture is a much better start than another: compare what each alone gains.",
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
    shown["starts from"] = [origin(*pair) for pair in zip(frame["weights"], frame["pretrained"], strict=True)]
    shown["filters"] = [_filters(*pair) for pair in zip(frame["mode"], frame["size"], strict=True)]
    triples = zip(frame["accuracy"], frame["low"], frame["high"], strict=True)
    shown["accuracy, %"] = [with_interval(*triple, 100, 1) for triple in triples]
    shown["guessing, %"] = [_share(value) for value in frame["guess"]]
    shown["over features and kNN"] = _gains(frame, "over_features")
    shown["over random weights"] = _gains(frame, "over_random")
    shown["over"] = [_units(*pair) for pair in zip(frame["split"], frame["values"], strict=True)]
    columns = ["data", "split", "network", "starts from", "filters", *shown.columns[-5:]]
    return Table("Networks that learned by sight, on recorded touches", frame, NOTES, shown[columns])


def _filters(mode, size):
    """How a network was trained, and the pixels it saw."""
    return f"{label(mode)}, {size} px" if mode else "–"


def _share(value):
    """A share in per cent; a dash where it is unknown."""
    return f"{100 * value:.1f}" if value == value else "–"


def _gains(frame, name):
    """Gains in points as text; a dash where there is nothing to compare with."""
    triples = zip(frame[name], frame[f"{name}_low"], frame[f"{name}_high"], strict=True)
    return [signed(*(100 * value for value in triple), 1) if triple[0] == triple[0] else "–" for triple in triples]


def _units(split, count):
    """What an interval runs over."""
    return f"{count} {'objects' if split in OVER else 'splits'}"
