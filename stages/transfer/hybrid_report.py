"""One network for vision and touch, and what two senses are worth together (T5.5, T5.6)."""

from itertools import product
from typing import Any

import pandas as pd

from stages.charts.datasets import dataset_text
from stages.charts.drawing import draw_matrices
from stages.charts.items import Figure, Table
from stages.charts.results import NotRun, Results
from stages.charts.tables import Ranking, grid, grouped, number, percent, with_interval
from stages.transfer.network_rows import PASSES, SPLITS, THEIRS, accuracy, everywhere, mean, seen

SENSES = {"vision": "sight", "touch": "touch"}
ITEMS = {split: words.replace("touches", "items") for split, words in SPLITS.items()}
MIDDLE = "18:139"  # the layers that the thesis's network shares
METHODS = {
    "apart": "two networks",
    "hybrid": "hybrid",
    "hybrid_float16": "hybrid, weights of 16 bits",
    "hybrid_int8": "hybrid, weights of 8 bits",
}


def section_5_5_table(results: Results) -> Table:
    """Accuracy by each sense and size, by set, by the layers that are shared, and by what is stored."""
    thesis = results.thesis("section_5_5_hybrid").set_index("quantity")["value"]
    lines, notes = [], []
    for dataset in everywhere(results, *PASSES, data="hybrid"):
        trials = results.measured("transfer", dataset, data="hybrid", perturbation=None)
        trials = trials.assign(network=trials["method"].replace(dict.fromkeys(SENSES, "apart")))
        middles = [rows for _, rows in trials.groupby("mode", sort=False)]
        middles.sort(key=lambda rows: -rows["repetition"].nunique())
        for rows in middles:
            splits = [split for split in SPLITS if split in set(rows["split"])]
            lines += [_line(rows, middles[0], *case) for case in product(METHODS, splits)]
            notes.append(_note(rows, thesis["compression_ratio"]))
    frame = pd.DataFrame(lines)
    words = {"visual": 100 * thesis["visual_accuracy"], "tactile": 100 * thesis["tactile_accuracy"]}
    words |= {"ratio": thesis["compression_ratio"], "notes": "\n".join(notes), "new": new_object_sentences(results)}
    text_table = _shown(frame)
    gains = [name for name in map(str, text_table) if name.startswith("gain")]
    text_table = text_table.fillna(dict.fromkeys(gains, "–")).fillna("not run")
    # no ranking: size stands against accuracy
    answer = [name for name in map(str, text_table) if name not in gains]
    return Table(frame, text_table, words, answer=answer, split="objects", keys=["shared layers", "network"])


def _line(rows: pd.DataFrame, first: pd.DataFrame, network: str, split: str) -> dict[str, Any]:
    """One network in one split. first: rows of the middle that was repeated, which `rows` may be."""
    source = rows["dataset"].iloc[0]
    line = {"objects": _objects(rows), "shared_layers": rows["mode"].iloc[0], "network": network, "split": split}
    for sense in SENSES:
        values, before = (_values(frame, network, split=split, sense=sense) for frame in (rows, first))
        line[sense], line[f"{sense}_low"], line[f"{sense}_high"] = mean(values, split, source)
        line[f"{sense}_gain"] = 100 * (values - before).mean()
    sizes = _values(rows, network, "size_bytes", split=split).groupby("sense", dropna=False).mean()  # of each file
    ratio = 1.0 if network == "apart" else _values(rows, network, "size_ratio", split=split).mean()
    return line | {"megabytes": sizes.sum(min_count=1) / 1e6, "size_ratio": ratio}


def _objects(rows: pd.DataFrame) -> str:
    """The set of some rows, and what its networks saw."""
    words = seen(rows)
    return dataset_text(rows["dataset"].iloc[0]) + (f", {words}" if words else "")


def _values(rows: pd.DataFrame, network: str, metric: str = "accuracy", **where: str) -> pd.Series:
    """The values of a network, indexed by its training and senses."""
    selection = pd.Series({"metric": metric, "network": network, **where})
    return rows[(rows[selection.index] == selection).all(axis=1)].set_index(["sense", "split", "repetition"])["value"]


def _shown(frame: pd.DataFrame) -> pd.DataFrame:
    """One line per network: accuracies side by side, size the mean over the splits, which differ by a few bytes."""
    lines = []
    for (objects, layers, network), group in frame.groupby(["objects", "shared_layers", "network"], sort=False):
        line, gains = {"objects": objects, "shared layers": layers, "network": METHODS[str(network)]}, {}
        for (_, row), (sense, word) in product(group.iterrows(), SENSES.items()):
            text = with_interval(*row[[sense, f"{sense}_low", f"{sense}_high"]], scale=100, places=1)
            line[f"by {word}, {ITEMS[row['split']]}, %"] = text
            gains[f"gain by {word}, {ITEMS[row['split']]}, points"] = f"{row[f'{sense}_gain']:+.1f}"
        line |= {"file, MB": f"{group['megabytes'].mean():.2f}", "size ratio": f"{group['size_ratio'].mean():.3f}"}
        lines.append(line | (gains if layers != frame["shared_layers"].iloc[0] else {}))
    return pd.DataFrame(lines)


def _note(rows: pd.DataFrame, theirs: float) -> str:
    """Sentences on one middle; every network holds what they say, so that all values stand for an interval."""
    ratios, losses = _values(rows, "hybrid", "size_ratio"), 100 * abs(_values(rows, "apart") - _values(rows, "hybrid"))
    differences, counts = _values(rows, "hybrid", "max_difference"), rows.groupby("split")["repetition"].nunique()
    trained = " and ".join(f"{counts[split]} on {words}" for split, words in ITEMS.items() if split in counts)
    note = (
        f"{dataset_text(rows['dataset'].iloc[0])}, layers {rows['mode'].iloc[0]} shared: {trained}. In every network, "
        f"scores of the hybrid differ from those of the two networks by {number(differences.max())} at most, "
        f"accuracy by {losses.max():.2f} points at most. Size ratio {ratios.mean():.4f}; the thesis's is "
        f"{theirs:.4f}."
    )
    onnx = rows[rows["network"] == "hybrid_onnx"].groupby("metric")["value"].max()
    if len(onnx):
        note += f" As ONNX: scores differ by {number(onnx['max_difference'])} at most, "
        note += f"{100 * onnx['agreement']:g} % of the answers are the same."
    return note


def figure_5_6(results: Results) -> Figure:
    """Confusion matrices on the thesis's classes where they were measured, senses in columns and splits in rows."""
    dataset = results.printed(THEIRS, "transfer")
    frame = results.measured("transfer", dataset, method="hybrid", metric="confusion", mode=MIDDLE)
    splits = {(split,): words for split, words in ITEMS.items() if split in set(frame["split"])}
    senses = {sense: f"by {word}" for sense, word in SENSES.items()}
    figure, words = draw_matrices(frame, splits, senses, ["split"], "sense")
    return Figure(figure, words | {"splits": ", ".join(splits.values()), "objects": _objects(frame)})


NEW_OBJECTS = "new_object_accuracy"
HEADS = {
    "hybrid_head": "a new head on the hybrid's features", "imagenet_head": "a new head on ImageNet's features",
    "hybrid_nearest": "the nearest touch by the hybrid's features",
    "imagenet_nearest": "the nearest touch by ImageNet's features",
}  # fmt: skip


def new_object_sentences(results: Results) -> str:
    """A line for each data set and method: accuracy by touches."""
    lines = []
    for dataset in results.datasets("transfer"):
        try:
            rows = results.measured("transfer", dataset, metric=NEW_OBJECTS)
        except NotRun:
            continue
        lines += [
            f"{dataset_text(dataset)}, {HEADS[name]}: {_counts(trials)}."
            for (name,), trials in grouped(rows[rows["method"] != "chance"], ["method"])
        ]
        guessing = rows.loc[rows["method"] == "chance", "value"].iloc[0]
        lines[-1] += f" {rows['item'].nunique()} new objects, guessing {100 * guessing:.1f} %."
    return "\n".join(lines)


def _counts(rows: pd.DataFrame) -> str:
    """`31 % after 1 touch, 38 % after 2 touches` of one method."""
    texts = (
        f"{percent(trials['value'].mean())} % after {count:g} touch{'es' if count > 1 else ''}"
        for (count,), trials in grouped(rows, ["severity"])
    )
    return ", ".join(texts)


JOINED = {
    "better_sense": "the better sense alone",
    "vision": "sight alone",
    "touch": "touch alone",
    "sum_mean": "the streams summed, both heads",
    "sum_vision": "the streams summed, sight's head",
    "sum_touch": "the streams summed, touch's head",
    "fusion_mean": "both heads, mean",
    "fusion_product": "both heads, product",
    "fusion_entropy": "both heads, by certainty",
    "fusion_entropy_raw": "both heads, by certainty, no temperatures",
    "fusion_surest": "the surer head",
}
MEAN = "mean of all columns, %"
DETAILS = ("blur", "darkness", "occlusion", "dead cells")  # damages that stand behind noise and a missing sense
WHOLE = "none"  # the perturbation of senses that are as they should be


def hybrid_senses(results: Results) -> Table:
    """Accuracy of each way to join the senses under the harshest of each damage, on items at random."""
    rows = results.measured("transfer", metric="accuracy", data="hybrid", mode=MIDDLE, split="random", sense="both")
    rows = rows[rows["severity"] == rows.groupby("perturbation")["severity"].transform("max")]
    frame = pd.DataFrame(
        {"damage": damage, "severity": severity, "method": method} | accuracy(part[part["method"] == method], "random")
        for (damage, severity), part in grouped(rows, ["perturbation", "severity"])
        for method in JOINED
    ).drop(columns="values")
    cells = frame.assign(head=[*map(spoken, frame["damage"], frame["severity"])])
    wide = grid(cells, "method", "head", names={"method": JOINED.get}).rename(columns={"method": "answers"})
    shares = frame.groupby("method", sort=False)["accuracy"].mean()
    wide.insert(1, MEAN, [percent(shares[method]) for method in JOINED if method in shares])
    words, answer = seen(rows), [name for name in map(str, wide) if not any(part in name for part in DETAILS)]
    return Table(frame, wide, {"seen": f"For touch: {words}." if words else ""}, Ranking(MEAN), answer)


def spoken(perturbation: str, severity: float) -> str:
    """A damage as a person says it, as the head of a column of per cents."""
    sense, _, damage = perturbation.partition("_")
    words = "both whole" if perturbation == WHOLE else f"{sense}: {damage.replace('_', ' ')}"
    return words + (f" {severity:g}, %" if severity not in (0, 1) else ", %")
