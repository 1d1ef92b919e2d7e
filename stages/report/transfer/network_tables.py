"""T tables 5.3, 5.4 and 5.6: networks that learned by sight on imprints, whole or with some layers frozen."""

from itertools import product

import numpy as np
import pandas as pd

from stages.report.grid import grid, grouped, percent
from stages.report.items import Table
from stages.report.networks import (
    FINE,
    MODES,
    NETWORK,
    PRINTED,
    SPLITS,
    STARTS,
    THESIS,
    accuracy,
    everywhere,
    origin,
    seen,
)  # fmt: skip
from stages.report.prose import shared_notes
from stages.report.ranking import Ranking
from stages.report.results import Results
from stages.report.style import label
from stages.report.words import dataset_text

MODE_OF = {"all": "frozen", "none": "finetuned"}  # what the stage calls these rows of the thesis's table 5.6


def networks(results: Results, data: str) -> Table:
    """Accuracies of all networks on one kind of imprints, on every set, beside the thesis's."""
    thesis = results.thesis(THESIS[data]).set_index("network")
    sources = list(everywhere(results))
    every = pd.concat([results.rows("transfer", source) for source in sources])
    chance = every[every["metric"] == "chance"].groupby(["dataset", "split"])["value"].mean()
    rows = pd.concat(everywhere(results, data=data).values())
    groups = dict(iter(rows.groupby(["dataset", "method", "weights", "mode", "split"])))
    ran, lines = {key[1:4] for key in groups}, []
    looked = {key: seen(own) for key, own in grouped(rows, ["dataset", "split"])}
    settings = product(dict.fromkeys([*PRINTED, *rows["method"]]), STARTS, MODES)
    kept = [one for one in settings if one in ran or (one[0] in PRINTED and one[1] == "imagenet")]
    for source, (network, weights, mode), split in product(sources, kept, SPLITS):
        mine = groups.get((source, network, weights, mode, split), rows[:0])
        cell, guess = accuracy(mine, split), chance.get((source, split), np.nan)
        printed = weights == "imagenet" and split == "random" and network in PRINTED
        lines.append({
            "objects": source, "network": network, "weights": weights,
            "pretrained": next(iter(mine["pretrained"].dropna()), None), "mode": mode, "split": split, **cell,
            "chance": guess, "above_chance": cell["accuracy"] - guess, "seen": looked.get((source, split), ""),
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
    return Table(frame, _shown(cells, ["network", *down]), words, _ranking(frame))


def frozen_layers(results: Results) -> Table:
    """Accuracies of MobileNetV2 by the layers that stay as sight left them, on every set, beside the thesis's."""
    thesis = results.thesis("table_5_6_frozen_layers_mobilenetv2").set_index("frozen_layers")["accuracy"]
    lines = []
    for source, mine in everywhere(results, method=NETWORK, weights="imagenet", data=FINE).items():
        for (layers, printed), split in product(thesis.items(), SPLITS):
            cell = accuracy(mine[mine["mode"] == MODE_OF.get(str(layers), layers)], split)
            known = {"objects": source, "frozen_layers": layers, "split": split, "values": cell["values"]}
            lines.append(known | cell | {"thesis": printed, "seen": seen(mine[mine["split"] == split])})
    frame = pd.DataFrame(lines)
    shown = _shown(frame.rename(columns={"frozen_layers": "frozen layers"}), ["frozen layers"])
    return Table(frame, shown, {"looked": _looked(frame)}, _ranking(frame))


def _precisions(frame: pd.DataFrame) -> str:
    """Which networks computed in other numbers than float32, in a sentence; empty for none."""
    other = frame[frame["precision"].notna() & (frame["precision"] != "float32")]
    kinds = other[["network", "precision"]].drop_duplicates().itertuples(index=False)
    return " ".join(f"{label(name)} computed in {numbers}." for name, numbers in kinds)


def _guesses(frame: pd.DataFrame) -> str:
    """What guessing gives on each set."""
    shares = frame.groupby("objects", sort=False)["chance"].first().dropna()
    return ", ".join(f"{dataset_text(str(name))} {percent(share, 1)} %" for name, share in shares.items())


def _shown(cells: pd.DataFrame, down: list[str]) -> pd.DataFrame:
    """Accuracies in per cent, a column for each set and split, then the thesis's."""
    wide = grid(cells.assign(head=_head(cells) + ", %"), down, "head", places=1)
    thesis = cells.groupby(down, sort=False)["thesis"].max()  # printed beside touches at random alone
    return wide.assign(**{"thesis, %": [percent(share, 1) for share in thesis]})


def _head(cells: pd.DataFrame) -> pd.Series:
    return cells["objects"].map(dataset_text) + ", " + cells["split"].map(SPLITS)


def _ranking(cells: pd.DataFrame) -> Ranking:
    """By the column of most measured rows."""
    return Ranking(_head(cells.dropna(subset=["accuracy"])).mode().iloc[0] + ", %")


def _looked(cells: pd.DataFrame) -> str:
    """What the networks of each column saw."""
    heads = (_head(cells) + ": " + cells["seen"])[cells["seen"] != ""]
    return "; ".join(heads.unique())
