"""T5.5: the hybrid network beside the two that it is made of, and smaller kinds of it."""

from itertools import product
from typing import Any

import pandas as pd

from stages.report.items import Table
from stages.report.markdown import number, with_interval
from stages.report.networks import SPLITS, everywhere, mean
from stages.report.results import Results
from stages.report.target import on_target
from stages.report.words import dataset_text

SENSES = {"vision": "sight", "touch": "touch"}
ITEMS = {split: words.replace("touches", "items") for split, words in SPLITS.items()}
MIDDLE = "18:139"  # the layers that the thesis's network shares
METHODS = {
    "apart": "two networks",
    "hybrid": "hybrid",
    "hybrid_float16": "hybrid, weights of 16 bits",
    "hybrid_int8": "hybrid, weights of 8 bits",
}
POINT, RATIO = 1.0, 1.43  # aims: points of accuracy that may be lost, and how much smaller the hybrid is
NOTE = (
    "{objects}, layers {middle} shared: in every network, scores of the hybrid differ from those of the two networks "
    "by {worst} at most, accuracy by {lost:.2f} points at most; the aim of {point:g} point or less is {kept}. Size "
    "ratio {ratio:.4f}: the thesis's is {theirs}, the aim of {aim} is {ours}."
)
ONNX = " As ONNX: scores differ by {worst} at most, {same:g} % of the answers are the same."


def build(results: Results) -> Table:
    """Accuracy by each sense and size, by set, by the layers that are shared, and by what is stored."""
    thesis = results.thesis("section_5_5_hybrid").set_index("quantity")["value"]
    lines, notes = [], []
    for dataset, accuracies in everywhere(results, data="hybrid").items():
        found = results.measured("transfer", dataset, data="hybrid", perturbation=None)
        found = found.assign(network=found["method"].replace(dict.fromkeys(SENSES, "apart")))
        repeated = accuracies.groupby("mode", sort=False)["repetition"].nunique()
        middles = [found[found["mode"] == middle] for middle in sorted(repeated.index, key=lambda one: -repeated[one])]
        for rows in middles:
            splits = [split for split in SPLITS if split in set(rows["split"])]
            lines += [_line(rows, middles[0], *which) for which in product(METHODS, splits)]
            notes.append(_note(rows, thesis["compression_ratio"]))
    frame = pd.DataFrame(lines)
    words = {"visual": 100 * thesis["visual_accuracy"], "tactile": 100 * thesis["tactile_accuracy"]}
    return Table(frame, _shown(frame), words | {"ratio": thesis["compression_ratio"], "notes": "\n".join(notes)})


def _line(rows: pd.DataFrame, first: pd.DataFrame, network: str, split: str) -> dict[str, Any]:
    """One network in one split. first: rows of the middle that was repeated, which `rows` may be."""
    source = rows["dataset"].iloc[0]
    line = {"objects": dataset_text(source), "shared_layers": rows["mode"].iloc[0], "network": network, "split": split}
    for sense in SENSES:
        values, before = (_values(frame, network, split=split, sense=sense) for frame in (rows, first))
        line |= dict(zip((sense, f"{sense}_low", f"{sense}_high"), mean(values, split, source), strict=True))
        line[f"{sense}_gain"] = 100 * (values - before).mean()
    sizes = _values(rows, network, "size_bytes", split=split).groupby("sense", dropna=False).mean()  # of each file
    ratio = 1.0 if network == "apart" else _values(rows, network, "size_ratio", split=split).mean()
    return line | {"megabytes": sizes.sum(min_count=1) / 1e6, "size_ratio": ratio}


def _values(rows: pd.DataFrame, network: str, metric: str = "accuracy", **where: str) -> pd.Series:
    """What was measured of a network, indexed by what tells its trainings and senses apart."""
    for column, value in {"metric": metric, "network": network, **where}.items():
        rows = rows[rows[column] == value]
    return rows.set_index(["sense", "split", "repetition"])["value"]


def _shown(frame: pd.DataFrame) -> pd.DataFrame:
    """One line per network: accuracies side by side, size the mean over the splits, which differ by a few bytes."""
    shown = []
    for (objects, layers, network), group in frame.groupby(["objects", "shared_layers", "network"], sort=False):
        line = {"objects": objects, "shared layers": layers, "network": METHODS[str(network)]}
        for (_, row), (sense, word) in product(group.iterrows(), SENSES.items()):
            text = with_interval(*row[[sense, f"{sense}_low", f"{sense}_high"]], scale=100, places=1)
            gain = "" if layers == frame["shared_layers"].iloc[0] else f" · {row[f'{sense}_gain']:+.1f}"
            line[f"by {word}, {ITEMS[row['split']]}, %"] = text + gain
        line |= {"file, MB": f"{group['megabytes'].mean():.2f}", "size ratio": f"{group['size_ratio'].mean():.3f}"}
        shown.append(line)
    return pd.DataFrame(shown).fillna("not run")


def _note(rows: pd.DataFrame, theirs: float) -> str:
    """Sentences on one middle; every network holds what they say, so that all values stand for an interval."""
    ratios, lost = _values(rows, "hybrid", "size_ratio"), 100 * abs(_values(rows, "apart") - _values(rows, "hybrid"))
    ratio, span = ((one.mean(), one.min(), one.max()) for one in (ratios, lost))
    note = NOTE.format(
        objects=dataset_text(rows["dataset"].iloc[0]), middle=rows["mode"].iloc[0], point=POINT, aim=RATIO,
        worst=number(_values(rows, "hybrid", "max_difference").max()), lost=lost.max(), ratio=ratios.mean(),
        kept=on_target(*span, at_most=POINT), theirs=on_target(*ratio, at_least=theirs),
        ours=on_target(*ratio, at_least=RATIO),
    )  # fmt: skip
    onnx = rows[rows["network"] == "hybrid_onnx"].groupby("metric")["value"].max()
    if onnx.empty:
        return note
    return note + ONNX.format(worst=number(onnx["max_difference"]), same=100 * onnx["agreement"])
