"""T5.5: the hybrid network beside the two that it is made of, and smaller kinds of it."""

import numpy as np
import pandas as pd

from stages.report.items import Table
from stages.report.markdown import number, with_interval

from ._hybrid import SENSES, mean, rows
from ._transfer import SPLITS

METHODS = {
    "apart": "two networks",
    "hybrid": "hybrid",
    "hybrid_float16": "hybrid, weights of 16 bits",
    "hybrid_int8": "hybrid, weights of 8 bits",
}
NOTES = [
    "Accuracy in per cent [95 % interval]. Items at random: a quarter of all is tested, every object is known; unseen "
    "objects: one object of each class is left out. Both networks start from ImageNet's weights and keep layers 18 to "
    "139 as they are; grey pictures of the objects from all round for sight, imprints of 128 x 128 for touch.",
    "Size: of the files, two networks over one. The 16 and 8 bits are what is stored; the network computes in 32.",
]


def build(results):
    thesis = results.thesis("section_5_5_hybrid").set_index("quantity")["value"]
    found = rows(results)
    lines = [_line(found, method, split) for method in METHODS for split in SPLITS if split in set(found["split"])]
    frame = pd.DataFrame(lines)
    return Table("Section 5.5: one network for sight and touch", frame, [*NOTES, *_notes(found, thesis)], _shown(frame))


def _line(found, method, split):
    mine = found[found["split"] == split]
    line = {"network": method, "split": split}
    for sense in SENSES:
        name = sense if method == "apart" else method
        values = _values(mine, name, "accuracy", sense)
        line |= dict(zip((sense, f"{sense}_low", f"{sense}_high"), mean(values, split), strict=True))
    if method == "apart":
        size = sum(_values(mine, sense, "size_bytes", sense).mean() for sense in SENSES)
    else:
        size = _values(mine, method, "size_bytes").mean()
    ratio = 1.0 if method == "apart" else _values(mine, method, "size_ratio").mean()
    return line | {"megabytes": size / 1e6, "size_ratio": ratio}


def _values(frame, method, metric, sense=None):
    """One value a repetition; rows of damaged senses are others."""
    kept = frame[(frame["method"] == method) & (frame["metric"] == metric) & frame["perturbation"].isna()]
    return kept.loc[kept["sense"] == sense, "value"] if sense else kept["value"]


def _shown(frame):
    shown = pd.DataFrame({"network": frame["network"].map(METHODS), "split": frame["split"].map(SPLITS)})
    for sense, word in SENSES.items():
        triples = zip(frame[sense], frame[f"{sense}_low"], frame[f"{sense}_high"], strict=True)
        shown[f"by {word}, %"] = [with_interval(*triple, 100, 1) for triple in triples]
    shown["file, MB"] = frame["megabytes"].map(lambda value: f"{value:.2f}")
    shown["size ratio"] = frame["size_ratio"].map(lambda value: f"{value:.3f}")
    return shown


def _notes(found, thesis):
    worst = found.loc[(found["method"] == "hybrid") & (found["metric"] == "max_difference"), "value"].max()
    lost = [_lost(found, sense) for sense in SENSES]
    yield (
        f"The thesis: {100 * thesis['visual_accuracy']:.0f} % by sight, {100 * thesis['tactile_accuracy']:.1f} % by "
        f"touch, size ratio {thesis['compression_ratio']:.3f}."
    )
    yield (
        f"Scores of the hybrid network differ from those of the two networks by {number(worst)} at most; accuracy by "
        f"{max(lost):.2f} points at most, in any repetition (aim: one point)."
    )
    onnx = found[found["method"] == "hybrid_onnx"].groupby("metric")["value"].max()
    if len(onnx):
        yield f"As ONNX: scores differ by {number(onnx['max_difference'])} at most."


def _lost(found, sense):
    own, whole = (
        found[(found["method"] == name) & (found["metric"] == "accuracy") & (found["sense"] == sense)]
        .loc[lambda frame: frame["perturbation"].isna()]
        .set_index(["split", "repetition"])["value"]
        for name in (sense, "hybrid")
    )
    return float(np.abs(100 * (own - whole)).max())
