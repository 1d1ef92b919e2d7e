"""T tables 5.3, 5.4 and 5.6: networks that learned by sight on imprints, whole or with some layers frozen."""

from contextlib import suppress
from itertools import product
from typing import Any

import numpy as np
import pandas as pd

from stages.report.grid import grid, grouped, percent
from stages.report.items import Table
from stages.report.networks import (
    FINE,
    MODES,
    NETWORK,
    PASSES,
    PRINTED,
    SPLITS,
    STARTS,
    THESIS,
    accuracy,
    everywhere,
    of_passes,
    origin,
    seen,
)  # fmt: skip
from stages.report.prose import shared_notes
from stages.report.ranking import Ranking
from stages.report.results import NotRun, Results
from stages.report.style import label
from stages.report.words import dataset_text

CELL = {"accuracy": "", "low": "_low", "high": "_high", "values": "_values"}  # of an accuracy -> end of a column's name
MODE_OF = {"all": "frozen", "none": "finetuned"}  # what the stage calls these rows of the thesis's table 5.6


def networks(results: Results, data: str) -> Table:
    """Accuracies of all networks on one kind of imprints, on every set and by passes, beside the thesis's."""
    thesis = results.thesis(THESIS[data]).set_index("network")
    rows = pd.concat(everywhere(results, *PASSES, data=data).values())
    sources = list(dict.fromkeys(rows["dataset"]))
    every = pd.concat([results.rows("transfer", source) for source in sources])
    chance = every[every["metric"] == "chance"].groupby(["dataset", "split"])["value"].mean()
    keys = ["dataset", "method", "weights", "mode", "split", "passes"]
    groups, trained = dict(iter(rows.groupby(keys))), _trained(results, keys, data=data)
    ran = {key[1:4] for key in groups}
    looked = {key: seen(own) for key, own in grouped(of_passes(rows), ["dataset", "split"])}
    settings = product(dict.fromkeys([*PRINTED, *rows["method"]]), STARTS, MODES)
    kept = [one for one in settings if one in ran or (one[0] in PRINTED and one[1] == "imagenet")]
    lines = []
    for source, (network, weights, mode), split in product(sources, kept, SPLITS):
        every = {passes: (source, network, weights, mode, split, passes) for passes in PASSES}
        mine = groups.get(every["printed"], rows[:0])
        cell, guess = accuracy(mine, split), chance.get((source, split), np.nan)
        printed = weights == "imagenet" and split == "random" and network in PRINTED
        lines.append({
            "objects": source, "network": network, "weights": weights,
            "pretrained": next(iter(mine["pretrained"].dropna()), None), "mode": mode, "split": split, **cell,
            **_both_passes(every, groups, trained, split), "chance": guess,
            "above_chance": cell["accuracy"] - guess, "seen": looked.get((source, split), ""),
            "precision": next(iter(mine["precision"].dropna()), None) if "precision" in mine else None,
            "thesis": thesis.loc[PRINTED[network], f"acc_{mode}"] if printed else np.nan,
            "seconds": mine["seconds"].median(),
        })  # fmt: skip
    frame = pd.DataFrame(lines)
    starts = zip(frame["weights"], frame.groupby("network")["pretrained"].transform("first"), strict=True)
    down = {"starts from": [origin(*pair) for pair in starts], "filters": frame["mode"].map(label)}
    cells = frame.assign(network=frame["network"].map(label), **down)
    notes = [
        f"Not run on {dataset_text(name)}: {note}." for name in sources for note in results.notes("transfer", name)
    ]
    words = {"networks": shared_notes(__package__, "networks"), "not_run": "\n".join(notes)}
    words |= {"precision": _precisions(frame), "looked": _looked(frame), "guesses": _guesses(frame)}
    heads = _heads(rows)
    return Table(frame, _shown(cells, ["network", *down], heads), words, _ranking(frame, heads))


def frozen_layers(results: Results) -> Table:
    """Accuracies of MobileNetV2 by the layers that stay as sight left them, on every set, beside the thesis's."""
    thesis = results.thesis("table_5_6_frozen_layers_mobilenetv2").set_index("frozen_layers")["accuracy"]
    where = {"method": NETWORK, "weights": "imagenet", "data": FINE}
    rows = pd.concat(everywhere(results, *PASSES, **where).values())
    keys = ["dataset", "mode", "split", "passes"]
    groups, trained, lines = dict(iter(rows.groupby(keys))), _trained(results, keys, **where), []
    for source, (layers, printed), split in product(dict.fromkeys(rows["dataset"]), thesis.items(), SPLITS):
        every = {passes: (source, MODE_OF.get(str(layers), layers), split, passes) for passes in PASSES}
        mine = groups.get(every["printed"], rows[:0])
        known = {"objects": source, "frozen_layers": layers, "split": split}
        saw = of_passes(rows[(rows["dataset"] == source) & (rows["split"] == split)])
        known |= accuracy(mine, split) | _both_passes(every, groups, trained, split)
        lines.append(known | {"thesis": printed, "seen": seen(saw)})
    frame, heads = pd.DataFrame(lines), _heads(rows)
    shown = _shown(frame.rename(columns={"frozen_layers": "frozen layers"}), ["frozen layers"], heads)
    return Table(frame, shown, {"looked": _looked(frame)}, _ranking(frame, heads))


def _trained(results: Results, keys: list[str], **where: str) -> dict[tuple, pd.DataFrame]:
    """{values of `keys`: train_accuracy and epochs of each repetition}, of the trainings that say them."""
    found = {}
    for metric in ("train_accuracy", "epochs"):
        with suppress(NotRun):
            rows = pd.concat(everywhere(results, *PASSES, metric=metric, **where).values())
            found[metric] = rows.set_index([*keys, "repetition"])["value"]
    return dict(iter(pd.DataFrame(found).groupby(level=list(range(len(keys)))))) if found else {}


def _both_passes(
    keys: dict[str, tuple], groups: dict[tuple, pd.DataFrame], trained: dict[tuple, pd.DataFrame], split: str
) -> dict[str, Any]:
    """Accuracy on the training touches, and the columns of the trainings until nothing improves."""
    course = {passes: trained[key].mean() if key in trained else {} for passes, key in keys.items()}
    late = groups.get(keys["converged"])
    cell = accuracy(late, split) if late is not None else dict.fromkeys(CELL, np.nan)
    values = {f"converged{end}": cell[name] for name, end in CELL.items()}
    values |= {"training": course["printed"].get("train_accuracy", np.nan)}
    values |= {"converged_training": course["converged"].get("train_accuracy", np.nan)}
    return values | {"converged_epochs": course["converged"].get("epochs", np.nan)}


def _precisions(frame: pd.DataFrame) -> str:
    """Which networks computed in other numbers than float32, in a sentence; empty for none."""
    other = frame[frame["precision"].notna() & (frame["precision"] != "float32")]
    kinds = other[["network", "precision"]].drop_duplicates().itertuples(index=False)
    return " ".join(f"{label(name)} computed in {numbers}." for name, numbers in kinds)


def _guesses(frame: pd.DataFrame) -> str:
    """What guessing gives on each set."""
    shares = frame.groupby("objects", sort=False)["chance"].first().dropna()
    return ", ".join(f"{dataset_text(str(name))} {percent(share, 1)} %" for name, share in shares.items())


def _shown(cells: pd.DataFrame, down: list[str], heads: dict[tuple, str]) -> pd.DataFrame:
    """Accuracies in per cent, a column for each set and split, then on the training touches, then the thesis's.

    A second row of each setting is of trainings until nothing improves, where there are any of these.
    """
    late = {"accuracy": "converged", "low": "converged_low", "high": "converged_high", "training": "converged_training"}
    parts = [cells.assign(passes="printed")]
    if cells["converged"].notna().any():
        setting = [cells[name] for name in down]
        tried = cells[["accuracy", "converged"]].notna().any(axis=1).groupby(setting).transform("any")
        theirs = cells["thesis"].groupby(setting).transform("max").notna()
        asked = cells["converged"].notna() | (tried & theirs)
        again = cells[asked].assign(**{name: cells[own] for name, own in late.items()}, passes="converged")
        parts.append(again)
    every, keys = pd.concat(parts).sort_index(kind="stable"), [*down, "passes"]
    head = [heads[key] for key in zip(every["objects"], every["split"], strict=True) if key in heads]
    wide = grid(every.assign(head=head), keys, "head", names={"passes": PASSES.__getitem__}, places=1)
    thesis = every.groupby(keys, sort=False)["thesis"].max()  # printed beside touches at random alone
    known = every[every["split"] == "random"].groupby(keys, sort=False)["training"].last()
    return wide.assign(**{
        "training touches, %": [percent(share, 1) for share in known],
        "thesis, %": [percent(share, 1) for share in thesis],
    })  # fmt: skip


def _heads(rows: pd.DataFrame) -> dict[tuple, str]:
    """{(set, split): head of its column}: with the pixels a side, and the most repetitions of a training."""
    known, found = of_passes(rows, *PASSES), {}
    for source, split in product(dict.fromkeys(known["dataset"]), SPLITS):
        mine = known[(known["dataset"] == source) & (known["split"] == split)]
        sizes = " and ".join(f"{pixels:.0f}" for pixels in sorted(mine["size"].dropna().unique()))
        count = mine.groupby(["method", "weights", "mode", "passes"])["repetition"].nunique().max()
        ends = f", {sizes} px, {count} {'folds' if split == 'objects' else 'splits'}" if len(mine) else ""
        found[source, split] = f"{dataset_text(source)}, {SPLITS[split]}{ends}, %"
    return found


def _head(cells: pd.DataFrame) -> pd.Series:
    return cells["objects"].map(dataset_text) + ", " + cells["split"].map(SPLITS)


def _ranking(cells: pd.DataFrame, heads: dict[tuple, str]) -> Ranking:
    """By the column of most measured rows."""
    measured = cells.dropna(subset=["accuracy"])
    place = (measured["objects"] + " " + measured["split"]).mode().iloc[0]
    return Ranking(heads[tuple(place.rsplit(" ", 1))])


def _looked(cells: pd.DataFrame) -> str:
    """What the networks of each column saw."""
    heads = (_head(cells) + ": " + cells["seen"])[cells["seen"] != ""]
    return "; ".join(heads.unique())
