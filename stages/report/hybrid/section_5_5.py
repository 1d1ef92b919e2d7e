"""T5.5: the hybrid network beside the two that it is made of, and smaller kinds of it."""

import pandas as pd

from stages.report.items import Table
from stages.report.markdown import number, with_interval
from stages.report.networks import SPLITS, mean
from stages.report.results import NotRun
from stages.report.target import on_target
from stages.report.words import dataset_text

from .rows import SENSES, middles, rows

METHODS = {
    "apart": "two networks",
    "hybrid": "hybrid",
    "hybrid_float16": "hybrid, weights of 16 bits",
    "hybrid_int8": "hybrid, weights of 8 bits",
}
POINT, RATIO = 1.0, 1.43  # aims: points of accuracy that may be lost, and how much smaller the hybrid is
NOTES = [
    "Accuracy in per cent [95 % interval]. Items at random: a quarter of all is tested, every object is known; unseen "
    "objects: one object of each class is left out. Both networks start from ImageNet's weights and keep the shared "
    "layers, in Matlab's numbers, as they are; the thesis shares 18:139. Grey pictures of the objects from all round "
    "for sight, imprints of 128 x 128 for touch. Without an interval: one training alone, not to be held against the "
    "mean of several; behind the dot what it gains over the first shared layers on the same items.",
    "The two networks of a line learned with its shared layers frozen, so that a hybrid answers as they do by design. "
    "What that costs touch against tuning all layers is in table 5.6; by sight it was not measured.",
    "Size: of the files, two networks over one. The 16 and 8 bits are what is stored; the network computes in 32.",
]


def build(results):
    thesis = results.thesis("section_5_5_hybrid").set_index("quantity")["value"]
    lines, notes = [], []
    for dataset in places(results):
        every = middles(results, dataset)
        for middle in every:
            found, first = (rows(results, one, dataset) for one in (middle, every[0]))
            splits = [split for split in SPLITS if split in set(found["split"])]
            lines += [_line(found, first, method, split) for method in METHODS for split in splits]
            notes.append(" ".join(_note(found, thesis)))
    said = (
        f"The thesis: {100 * thesis['visual_accuracy']:.0f} % by sight, {100 * thesis['tactile_accuracy']:.1f} % by "
        f"touch, size ratio {thesis['compression_ratio']:.4f}."
    )
    frame = pd.DataFrame(lines)
    return Table("Section 5.5: one network for sight and touch", frame, [*NOTES, said, *notes], _shown(frame))


def places(results):
    """The sets that hold hybrid networks, in order; NotRun without any."""
    absent, found = NotRun("no measurements of transfer", "transfer"), []
    for dataset in results.datasets("transfer"):
        try:
            middles(results, dataset)
            found.append(dataset)
        except NotRun as missing:
            absent = missing
    if not found:
        raise absent
    return found


def _line(found, first, method, split):
    """One network in one split. first: rows of the middle that was repeated, which `found` may be."""
    mine, beside = (frame[frame["split"] == split] for frame in (found, first))
    source, middle = found["dataset"].iloc[0], found["mode"].iloc[0]
    line = {"objects": dataset_text(source), "shared_layers": middle, "network": method, "split": split}
    for sense in SENSES:
        name = sense if method == "apart" else method
        values = _values(mine, name, "accuracy", sense)
        line |= dict(zip((sense, f"{sense}_low", f"{sense}_high"), mean(values, split, source), strict=True))
        line[f"{sense}_gain"] = _points(mine, name, beside, name, sense).mean()
    if method == "apart":
        size = sum(_values(mine, sense, "size_bytes", sense).mean() for sense in SENSES)
    else:
        size = _values(mine, method, "size_bytes").mean()
    ratio = 1.0 if method == "apart" else _values(mine, method, "size_ratio").mean()
    return line | {"megabytes": size / 1e6, "size_ratio": ratio}


def _values(frame, method, metric, sense=None):
    """One value per repetition; rows of damaged senses are others."""
    kept = frame[(frame["method"] == method) & (frame["metric"] == metric) & frame["perturbation"].isna()]
    return kept.loc[kept["sense"] == sense, "value"] if sense else kept["value"]


def _shown(frame):
    """One line per network: accuracies side by side, size the mean over the splits, which differ by a few bytes."""
    keys = ["objects", "shared_layers", "network"]
    shown = []
    for (objects, layers, network), group in frame.groupby(keys, sort=False):
        line = {"objects": objects, "shared layers": layers, "network": METHODS[network]}
        for row in group.itertuples():
            for sense, word in SENSES.items():
                triple = [getattr(row, f"{sense}{end}") for end in ("", "_low", "_high")]
                head = f"by {word}, {SPLITS[row.split].replace('touches', 'items')}, %"
                line[head] = with_interval(*triple, 100, 1)
                if layers != frame["shared_layers"].iloc[0]:
                    line[head] += f" · {getattr(row, f'{sense}_gain'):+.1f}"
        line |= {"file, MB": f"{group['megabytes'].mean():.2f}", "size ratio": f"{group['size_ratio'].mean():.3f}"}
        shown.append(line)
    return pd.DataFrame(shown).fillna("not run")


def _note(found, thesis):
    """Sentences on one middle; every network holds what they say, so that all values stand for an interval."""
    worst = found.loc[(found["method"] == "hybrid") & (found["metric"] == "max_difference"), "value"].max()
    lost = pd.concat([_points(found, sense, found, "hybrid", sense).abs() for sense in SENSES])
    ratios = _values(found, "hybrid", "size_ratio")
    aims = [on_target(*_span(ratios), at_least=aim) for aim in (thesis["compression_ratio"], RATIO)]
    yield (
        f"{dataset_text(found['dataset'].iloc[0])}, layers {found['mode'].iloc[0]} shared: in every network, scores "
        f"of the hybrid differ from those of the two networks by {number(worst)} at most, accuracy by {lost.max():.2f} "
        f"points at most; the aim of {POINT:g} point or less is {on_target(*_span(lost), at_most=POINT)}. Size ratio "
        f"{ratios.mean():.4f}: the thesis's is {aims[0]}, the aim of {RATIO} is {aims[1]}."
    )
    onnx = found[found["method"] == "hybrid_onnx"].groupby("metric")["value"].max()
    if len(onnx):
        yield (
            f"As ONNX: scores differ by {number(onnx['max_difference'])} at most, {100 * onnx['agreement']:g} % of the "
            "answers are the same."
        )


def _span(values):
    return values.mean(), values.min(), values.max()


def _points(one, method, other, rival, sense):
    """Points of accuracy of a method minus another, a (split, repetition) that both were tested on."""
    ours, theirs = (
        _values(frame.set_index(["split", "repetition"]), name, "accuracy", sense)
        for frame, name in ((one, method), (other, rival))
    )
    return 100 * (ours - theirs).dropna()
