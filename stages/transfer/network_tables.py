"""Networks for photographs on imprints: T tables 5.3, 5.4 and 5.6, and claims on filters and layers (T5.4 to 5.6).

`networks` is T table 5.3 or 5.4, `frozen_layers` T table 5.6. The claims ask for the worth of training on photographs
and for the layers that must learn. `build` changes one thing at a time to find the reason why frozen filters are at
chance on a 16 x 16 array in T table 5.3.
"""

from collections.abc import Iterable
from contextlib import suppress
from itertools import product
from typing import Any

import numpy as np
import pandas as pd

from haptic_glance.know.split import shared_by
from stages.charts.datasets import dataset_text
from stages.charts.drawing import label
from stages.charts.items import Table, shared_notes
from stages.charts.results import NotRun, Results
from stages.charts.tables import Ranking, cell_texts, grid, grouped, percent, signed
from stages.engine.statistics import interval
from stages.transfer.network_rows import (
    FINE,
    MODES,
    NETWORK,
    PASSES,
    PRINTED,
    SPLITS,
    STARTS,
    THEIRS,
    THESIS,
    accuracy,
    everywhere,
    of_passes,
    origin,
    seen,
)

CELL = {"accuracy": "", "low": "_low", "high": "_high", "values": "_values"}  # of an accuracy -> end of a column's name
OTHERS = list(PASSES)[1:]
PIXELS, COST = 224, "milliseconds"  # the side of a picture of the thesis's networks; what it costs
COST_TITLE = f"one picture of {PIXELS} px, ms"
MODE_OF = {"all": "frozen", "none": "finetuned"}  # what the stage calls these rows of the thesis's table 5.6


def networks(results: Results, data: str) -> Table:
    """Accuracies of all networks on one kind of imprints, on every set and by passes, beside the thesis's."""
    thesis = results.thesis(THESIS[data]).set_index("network")
    rows = pd.concat(everywhere(results, *PASSES, data=data).values())
    sources = list(dict.fromkeys(rows["dataset"]))
    cases = pd.concat([results.rows("transfer", source) for source in sources])
    chance = cases[cases["metric"] == "chance"].groupby(["dataset", "split"])["value"].mean()
    keys = ["dataset", "method", "weights", "mode", "split", "passes"]
    groups, trained = dict(iter(rows.groupby(keys))), _trained(results, keys, data=data)
    run_keys = {key[1:4] for key in groups}
    touches = {key: seen(group) for key, group in grouped(of_passes(rows), ["dataset", "split"])}
    settings = product(dict.fromkeys([*PRINTED, *rows["method"]]), STARTS, MODES)
    table_settings = [
        setting for setting in settings if setting in run_keys or (setting[0] in PRINTED and setting[1] == "imagenet")
    ]
    lines = []
    for source, (network, weights, mode), split in product(sources, table_settings, SPLITS):
        cases = {passes: (source, network, weights, mode, split, passes) for passes in PASSES}
        runs = groups.get(cases["printed"], rows[:0])
        cell, guess = accuracy(runs, split), chance.get((source, split), np.nan)
        is_printed = weights == "imagenet" and split == "random" and network in PRINTED
        lines.append({
            "objects": source, "network": network, "weights": weights,
            "pretrained": next(iter(runs["pretrained"].dropna()), None), "mode": mode, "split": split, **cell,
            **_other_passes(cases, groups, trained, split), "chance": guess,
            "above_chance": cell["accuracy"] - guess, "seen": touches.get((source, split), ""),
            "precision": next(iter(runs["precision"].dropna()), None) if "precision" in runs else None,
            "thesis": thesis.loc[PRINTED[network], f"acc_{mode}"] if is_printed else np.nan,
            "seconds": runs["seconds"].median(),
        })  # fmt: skip
    frame = pd.DataFrame(lines)
    frame[COST] = frame["network"].map(picture_milliseconds(results))
    starts = zip(frame["weights"], frame.groupby("network")["pretrained"].transform("first"), strict=True)
    down = {"starts from": [origin(*pair) for pair in starts], "filters": frame["mode"].map(label)}
    cells = frame.assign(network=frame["network"].map(label), **down)
    notes = [
        f"Not run on {dataset_text(name)}: {note}." for name in sources for note in results.notes("transfer", name)
    ]
    words = {"networks": shared_notes(__package__, "networks"), "not_run": "\n".join(notes)}
    words |= {"precision": _precisions(frame), "looked": _looked(frame), "guesses": _guesses(frame)}
    heads = [f"{words}, %" for words in SPLITS.values()]
    text_table = pd.concat(
        _of_set(cells[cells["objects"] == name], ["network", *down], heads) for name in by_print(sources)
    )
    keys = ("network", *down, "passes")
    answer = [*keys, *heads, "thesis, %", COST_TITLE]
    return Table(frame, text_table, words, Ranking(heads), split="objects", answer=answer, keys=keys)


def by_print(sources: Iterable[str]) -> list[str]:
    """The data sets, that with the thesis's classes first."""
    return sorted(sources, key=lambda name: name != THEIRS)


def _of_set(cells: pd.DataFrame, down: list[str], heads: list[str]) -> pd.DataFrame:
    """`_shown` of one data set."""
    name = cells["objects"].iloc[0]
    table = _shown(cells, down, dict(zip(((name, split) for split in SPLITS), heads, strict=True)))
    return table.assign(objects=dataset_text(name))


def picture_milliseconds(results: Results) -> dict[str, float]:
    """Milliseconds of one picture of PIXELS a side through each network on one thread; {} without the benchmark.

    Parameters
    ----------
    results : Results
        The measured rows, with those of `benchmarks.networks`.

    Returns
    -------
    dict
        {network: milliseconds}.
    """
    with suppress(NotRun):
        costs = results.bench("networks")
        costs = costs[costs["size"] == PIXELS]
        return dict(zip(costs["network"], costs["milliseconds"], strict=True))
    return {}


def frozen_layers(results: Results) -> Table:
    """Accuracies of MobileNetV2 by the layers that stay as sight left them, on every set, beside the thesis's."""
    thesis = results.thesis("table_5_6_frozen_layers_mobilenetv2").set_index("frozen_layers")["accuracy"]
    where = {"method": NETWORK, "weights": "imagenet", "data": FINE}
    rows = pd.concat(everywhere(results, *PASSES, **where).values())
    keys = ["dataset", "mode", "split", "passes"]
    groups, trained, lines = dict(iter(rows.groupby(keys))), _trained(results, keys, **where), []
    for source, (layers, printed), split in product(dict.fromkeys(rows["dataset"]), thesis.items(), SPLITS):
        cases = {passes: (source, MODE_OF.get(str(layers), layers), split, passes) for passes in PASSES}
        runs = groups.get(cases["printed"], rows[:0])
        line = {"objects": source, "frozen_layers": layers, "split": split}
        group = of_passes(rows[(rows["dataset"] == source) & (rows["split"] == split)])
        line |= accuracy(runs, split) | _other_passes(cases, groups, trained, split)
        lines.append(line | {"thesis": printed if split == "random" else np.nan, "seen": seen(group)})
    frame, heads = pd.DataFrame(lines), [f"{words}, %" for words in SPLITS.values()]
    cells, sources = frame.rename(columns={"frozen_layers": "frozen layers"}), by_print(frame["objects"].unique())
    text_table = pd.concat(_of_set(cells[cells["objects"] == name], ["frozen layers"], heads) for name in sources)
    return Table(frame, text_table, {"looked": _looked(frame)}, Ranking(heads), split="objects")


def _trained(results: Results, keys: list[str], **where: str) -> dict[tuple, pd.DataFrame]:
    """{values of `keys`: train_accuracy and epochs of each repetition}, of the trainings that say them."""
    columns = {}
    for metric in ("train_accuracy", "epochs"):
        with suppress(NotRun):
            rows = pd.concat(everywhere(results, *PASSES, metric=metric, **where).values())
            columns[metric] = rows.set_index([*keys, "repetition"])["value"]
    return dict(iter(pd.DataFrame(columns).groupby(level=list(range(len(keys)))))) if columns else {}


def _other_passes(
    keys: dict[str, tuple], groups: dict[tuple, pd.DataFrame], trained: dict[tuple, pd.DataFrame], split: str
) -> dict[str, Any]:
    """Accuracy on the training touches, and the columns of the trainings in another way than as printed."""
    course = {passes: trained[key].mean() if key in trained else {} for passes, key in keys.items()}
    values = {"training": course["printed"].get("train_accuracy", np.nan)}
    for passes in OTHERS:
        rows = groups.get(keys[passes])
        cell = accuracy(rows, split) if rows is not None else dict.fromkeys(CELL, np.nan)
        values |= {f"{passes}{end}": cell[name] for name, end in CELL.items()}
        values |= {f"{passes}_training": course[passes].get("train_accuracy", np.nan)}
    return values | {"converged_epochs": course["converged"].get("epochs", np.nan)}


def _precisions(frame: pd.DataFrame) -> str:
    """The networks that computed in other numbers than float32, in a sentence a set; empty for none."""
    other_rows = frame[frame["precision"].notna() & (frame["precision"] != "float32")]
    parts = []
    for (source, numbers), group in other_rows.groupby(["objects", "precision"], sort=False):
        names = ", ".join(label(name) for name in dict.fromkeys(group["network"]))
        parts.append(f"On {dataset_text(str(source))}, {names} computed in {numbers}.")
    return " ".join(parts)


def _guesses(frame: pd.DataFrame) -> str:
    """The accuracy of guessing on each set."""
    shares = frame.groupby("objects", sort=False)["chance"].first().dropna()
    return ", ".join(f"{dataset_text(str(name))} {percent(share, 1)} %" for name, share in shares.items())


def _shown(cells: pd.DataFrame, down: list[str], heads: dict[tuple, str]) -> pd.DataFrame:
    """Accuracies in per cent, a column for each set and split, then on the training touches, then the thesis's.

    Further rows of each setting are of trainings in another way, where there are any. Until nothing improves, the row
    of a setting that the thesis has stays without a value, too.
    """
    place = cells.groupby(down, sort=False, dropna=False).ngroup()  # so that the rows of a setting stand together
    parts = [cells.assign(passes="printed", place=place)]
    for passes in OTHERS:
        ends = {"accuracy": "", "low": "_low", "high": "_high", "training": "_training"}
        is_listed = cells[passes].notna()
        if passes == "converged" and is_listed.any():
            setting = [cells[name] for name in down]
            is_measured = cells[["accuracy", passes]].notna().any(axis=1).groupby(setting).transform("any")
            is_listed |= is_measured & cells["thesis"].groupby(setting).transform("max").notna()
        renamed = {name: cells[f"{passes}{end}"] for name, end in ends.items()}
        parts.append(cells.assign(**renamed, passes=passes, place=place)[is_listed])
    rows, keys = pd.concat(parts).sort_values("place", kind="stable"), [*down, "passes"]
    head = [heads[key] for key in zip(rows["objects"], rows["split"], strict=True) if key in heads]
    wide = grid(rows.assign(head=head), keys, "head", names={"passes": PASSES.__getitem__}, places=1)
    thesis = rows.groupby(keys, sort=False)["thesis"].max()  # printed beside touches at random alone
    training = rows["training"].where(rows["split"] == "random").groupby([rows[key] for key in keys], sort=False).last()
    columns = {
        "training touches, %": [percent(share, 1) for share in training],
        "thesis, %": [percent(share, 1) for share in thesis],
    }
    if COST in rows and rows[COST].notna().any():
        costs = rows.groupby(keys, sort=False)[COST].first()
        columns[COST_TITLE] = ["–" if cost != cost else f"{cost:.1f}" for cost in costs]
    return wide.assign(**columns)


def _head(cells: pd.DataFrame) -> pd.Series:
    return cells["objects"].map(dataset_text) + ", " + cells["split"].map(SPLITS)


def _looked(cells: pd.DataFrame) -> str:
    """The touches that the networks of each column saw."""
    heads = (_head(cells) + ": " + cells["seen"])[cells["seen"] != ""]
    return "; ".join(heads.unique())


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
        rates, gain = values[setting], values[setting] - values["plain"]
        lines.append((setting, rates.count(), *interval(rates, share), *interval(gain, share), rows["chance"].iloc[0]))
    gains = ["gain", "gain_low", "gain_high"]
    frame = pd.DataFrame(lines, columns=["setting", "values", "accuracy", "low", "high", *gains, "chance"])
    text_columns = {
        "what differs": frame["setting"].map(SETTINGS),
        "accuracy, %": cell_texts(frame, 1),
        "minus the first row, points": [signed(*gain, places=1) for gain in 100 * frame[gains].to_numpy()],
        "chance, %": [percent(guess, 1) for guess in frame["chance"]],
    }
    return Table(frame, pd.DataFrame(text_columns), best=Ranking("accuracy, %"))
