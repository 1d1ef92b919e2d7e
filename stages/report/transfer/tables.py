"""Networks for photographs on imprints: T tables 5.3, 5.4 and 5.6, and claims on filters and layers (T5.4 to 5.6).

`networks` is T table 5.3 or 5.4, `frozen_layers` T table 5.6. The claims ask for the worth of training on photographs
and for the layers that must learn. `build` changes one thing at a time to find the reason why frozen filters are at
chance on a 16 x 16 array in T table 5.3.
"""

from contextlib import suppress
from dataclasses import replace
from itertools import product
from typing import Any

import numpy as np
import pandas as pd
from scipy.stats import spearmanr

from haptic_glance.know.split import shared_by
from stages.charts.datasets import dataset_text
from stages.charts.drawing import label
from stages.charts.items import Table, shared_notes
from stages.charts.results import NotRun, Results
from stages.charts.tables import Ranking, grid, grouped, percent
from stages.report.claims import Claim, Pick, Reading, highest_of, lowest_of, reading
from stages.report.effects import statistic
from stages.report.networks import (
    COARSE,
    FINE,
    GUESS,
    MODES,
    NETWORK,
    PASSES,
    PRINTED,
    SEEN,
    SETS,
    SPLITS,
    STARTS,
    THEIRS,
    THESIS,
    WORDS,
    accuracy,
    both,
    everywhere,
    of_passes,
    origin,
    seen,
)  # fmt: skip

CELL = {"accuracy": "", "low": "_low", "high": "_high", "values": "_values"}  # of an accuracy -> end of a column's name
OTHERS = list(PASSES)[1:]
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
        cases = {passes: (source, MODE_OF.get(str(layers), layers), split, passes) for passes in PASSES}
        runs = groups.get(cases["printed"], rows[:0])
        line = {"objects": source, "frozen_layers": layers, "split": split}
        group = of_passes(rows[(rows["dataset"] == source) & (rows["split"] == split)])
        line |= accuracy(runs, split) | _other_passes(cases, groups, trained, split)
        lines.append(line | {"thesis": printed if split == "random" else np.nan, "seen": seen(group)})
    frame, heads = pd.DataFrame(lines), _heads(rows)
    text_table = _shown(frame.rename(columns={"frozen_layers": "frozen layers"}), ["frozen layers"], heads)
    return Table(frame, text_table, {"looked": _looked(frame)}, _ranking(frame, heads))


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
    return wide.assign(**{
        "training touches, %": [percent(share, 1) for share in training],
        "thesis, %": [percent(share, 1) for share in thesis],
    })  # fmt: skip


def _heads(rows: pd.DataFrame) -> dict[tuple, str]:
    """{(set, split): head of its column}: with the pixels a side, and the most repetitions of a training."""
    trained, heads = of_passes(rows, *PASSES), {}
    for source, split in product(dict.fromkeys(trained["dataset"]), SPLITS):
        runs = trained[(trained["dataset"] == source) & (trained["split"] == split)]
        sizes = " and ".join(f"{pixels:.0f}" for pixels in sorted(runs["size"].dropna().unique()))
        count = runs.groupby(["method", "weights", "mode", "passes"])["repetition"].nunique().max()
        ends = f", {sizes} px, {count} {'folds' if split == 'objects' else 'splits'}" if len(runs) else ""
        heads[source, split] = f"{dataset_text(source)}, {SPLITS[split]}{ends}, %"
    return heads


def _head(cells: pd.DataFrame) -> pd.Series:
    return cells["objects"].map(dataset_text) + ", " + cells["split"].map(SPLITS)


def _ranking(cells: pd.DataFrame, heads: dict[Any, str]) -> Ranking:
    """By the column of most measured rows."""
    return Ranking(heads[cells.groupby(["objects", "split"])["accuracy"].count().idxmax()])


def _looked(cells: pd.DataFrame) -> str:
    """The touches that the networks of each column saw."""
    heads = (_head(cells) + ": " + cells["seen"])[cells["seen"] != ""]
    return "; ".join(heads.unique())


FOUR = ("alexnet", "vgg16", "resnet50", NETWORK)  # of the five networks of T table 5.4 and figure 5.3
PHRASES = WORDS | {
    ("method", FOUR): "mean of four networks,",
    ("data", FINE): "imprints of 128 x 128", ("data", COARSE): "imprints of 16 x 16",
    ("mode", "18:139"): "layers 18 to 139 frozen", ("mode", "1:134"): "layers 1 to 134 frozen",
    ("passes", "printed"): "", ("passes", "converged"): "trained until nothing improves",
    ("passes", "printed_rate"): "at the printed learning rate",
}  # fmt: skip
Value = str | tuple[str, ...] | Pick  # of a column; of several the mean
SETTING = {"method": NETWORK, "metric": "accuracy", "data": FINE, "weights": "imagenet", "passes": "printed"}
CONVERGED = (  # splits first: objects share the trainings, so that their interval is too narrow
    reading("trained until nothing improves", where={"passes": "converged"}),
    reading("trained until nothing improves, over objects", where={"passes": "converged", "metric": "object_accuracy"},
            over=("item",), within=("repetition", *SEEN), shared=0.0),
)  # fmt: skip
INITIAL = reading("until nothing improves, random side with its initial statistics", where={"passes": "converged"},
                  second={"weights": "random_initial"})  # fmt: skip
REAL = "simulated; the thesis's array of 16 x 16 is real"
PRINTED_RATE = (*CONVERGED, reading("at the printed learning rates", where={"passes": "printed_rate"}))


def claim(
    key: str, section: str, sentence: str, column: str, first: Value, second: Value, margin: float = 0.0,
    readings: tuple[Reading, ...] = CONVERGED, note: str = "", **where: str,
) -> Claim:  # fmt: skip
    """The claim of one value of a column over another. where: what both have in common that differs from SETTING."""
    common = {name: value for name, value in (SETTING | where).items() if name != column}
    return Claim(
        key=key, section=section, sentence=sentence, stage="transfer", first={column: first}, second={column: second},
        where=common, margin=margin, phrases=PHRASES, within=SEEN, dataset=SETS,
        readings=readings, note=note, printed=1,
    )  # fmt: skip


@statistic("later_convolutions_change_less")
def later_change_less(results: Results, claim: Claim) -> pd.Series:
    """Minus the rank correlation of a convolution's depth with its change, per training."""
    changes = results.measured("transfer", claim.sets[0], **claim.where)
    return -changes.groupby("repetition")["value"].agg(lambda values: spearmanr(np.arange(len(values)), values)[0])


PLAIN = both(
    claim("tuned_over_frozen", "T5.4", "Fine-tuning on touch beats frozen filters.", "mode", "finetuned", "frozen",
          readings=PRINTED_RATE),
    claim("frozen_over_chance", "T5.4", "Frozen visual filters tell simulated imprints apart better than guessing.",
          "metric", "accuracy", "chance", readings=PRINTED_RATE, mode="frozen"),
    replace(
        claim("tuned_over_chance", "T5.4", "Fine-tuned networks tell simulated imprints apart better than guessing.",
              "metric", "accuracy", "chance", readings=PRINTED_RATE, mode="finetuned"),
        checked=False,  # a network that has learned too little is above guessing all the more
    ),
    claim("frozen_coarse_by_chance", "T5.4",
          "With 16 x 16 simulated sensels frozen filters are hardly better than guessing.", "metric",
          "chance", "accuracy", GUESS, readings=PRINTED_RATE, note=REAL, data=COARSE, mode="frozen"),
    claim("fine_over_coarse_frozen", "T5.4", "A finer array makes touch more like sight: frozen filters gain by it.",
          "data", FINE, COARSE, readings=PRINTED_RATE, note=REAL, mode="frozen"),
    claim("fine_over_coarse_tuned", "T5.6", "A finer array makes touch easier to recognise.",
          "data", FINE, COARSE, readings=PRINTED_RATE, note=REAL, mode="finetuned"),
    claim("fine_over_coarse_gain", "T5.6", "A finer array gains the printed 35.60 points of accuracy, or more.",
          "data", FINE, COARSE, -35.60, readings=PRINTED_RATE, note=REAL, mode="finetuned"),
    # T5.4 concludes that vision and touch share features from accuracies above guessing, without this control.
    claim("seen_over_random_frozen", "ours",
          "Filters learned by sight help beyond their architecture: frozen filters.",
          "weights", "imagenet", "random", readings=(*CONVERGED, INITIAL), mode="frozen"),
    claim("seen_over_random_tuned", "ours",
          "Filters learned by sight help beyond their architecture: the start of a training on touch.",
          "weights", "imagenet", "random", mode="finetuned"),
    claim("early_and_late", "T5.5", "Tuning the first and the last layers alone beats frozen filters.",
          "mode", "18:139", "frozen"),
    claim("early_and_late_gain", "T5.5", "Tuning the first and the last layers alone gains the printed 33.81 points "
          "over frozen filters, or more.", "mode", "18:139", "frozen", -33.81),
    claim("middle_frozen", "T5.5", "With layers 18 to 139 frozen touch is recognised as well as with all tuned, but "
          "for one point.", "mode", "18:139", "finetuned", 1.0),
)  # fmt: skip


def of_four(claim: Claim) -> Claim:
    """The claim on the mean of FOUR networks, as the thesis speaks of all; other sets have rows of NETWORK alone.

    Readings on objects, and at the printed rates, are those of NETWORK alone, too.
    """
    sides = {side: {"method": FOUR, **getattr(claim, side)} for side in ("first", "second")}
    alone = {side: {"method": NETWORK} for side in sides}
    readings = (CONVERGED[0], *(
        reading(f"{label(NETWORK)}, {base.name}", **{**base.changes, **alone}) for base in claim.readings))  # fmt: skip
    where = {column: value for column, value in claim.where.items() if column != "method"}
    within = (*claim.within, "method")  # a network that one side lacks does not count
    return replace(claim, where=where, within=within, elsewhere=dict.fromkeys(FOUR, NETWORK), readings=readings,
                   **sides)  # fmt: skip


PLAIN = [of_four(entry) if entry.section in ("T5.4", "T5.6") and not entry.of else entry for entry in PLAIN]
EARLY = [  # by layers that the default run does not freeze
    replace(entry, key=f"{entry.key}_psb", of=entry.of and f"{entry.of}_psb", dataset=THEIRS)
    for entry in both(
        claim("early_decisive", "T5.5", "The early layers are decisive: tuning them too beats tuning the last ones "
              "alone.", "mode", "18:139", "1:134"),
    )
]  # fmt: skip
CHANGES = Claim(
    key="earlier_change_more", section="T5.4", stage="transfer", dataset=SETS, phrases=PHRASES, scale=1.0,
    shared=shared_by("random"),
    sentence="Earlier convolutions are altered more for touch than later ones.", unit="rank correlation",
    where={"method": NETWORK, "mode": "finetuned", "split": "random", "data": FINE, "weights": "imagenet",
           "passes": "printed", "metric": "layer_weight_change"},
    statistic="later_convolutions_change_less", note="minus the rank correlation of depth and change",
    readings=CONVERGED[:1],
)  # fmt: skip
BESIDE = ("alexnet", "mobilenet_v2", "vgg16")  # networks beside ResNet50
BEST = [  # of the networks at the thesis's size
    replace(claim(key, "T5.4", "ResNet50 outperforms the other architectures in all cases.", "method", "resnet50",
                  highest_of(*BESIDE), split="random", mode=mode), dataset=THEIRS, of=of)
    for key, mode, of in (("resnet_best_tuned", "finetuned", ""), ("resnet_best_frozen", "frozen", "resnet_best_tuned"))
]  # fmt: skip
RANGES = ("1:150", "1:144", "1:134", "10:150", "10:144", "16:138")  # T table 5.6, but for 18:139
LESS = [  # at the thesis's size, by networks or by layers
    replace(entry, dataset=THEIRS)
    for entry in (
        claim("mobile_near_resnet", "T5.4", "Fine-tuned, MobileNetV2 comes within 3.33 points of ResNet50.", "method",
              NETWORK, "resnet50", 3.33, split="random", mode="finetuned"),
        replace(claim("resnet_smallest_updates", "T5.4", "ResNet50 has the smallest updates of its weights.", "method",
                      lowest_of(*BESIDE), "resnet50", split="random", mode="finetuned", metric="weight_change",
                      readings=CONVERGED[:1]), scale=1e6, unit="millionths, of squared weights"),
        replace(claim("resnet_gains_least", "T5.4", "ResNet50 has the smallest updates of its accuracy.", "method",
                      lowest_of(*BESIDE), "resnet50", split="random", note="what tuning gains over frozen filters"),
                contrast=({"mode": "finetuned"}, {"mode": "frozen"}), of="resnet_smallest_updates"),
        claim("early_and_late_best", "T5.5", "Frozen in layers 18 to 139, a network comes closest to one that is tuned "
              "whole.", "mode", "18:139", highest_of(*RANGES), split="random", note="of T table 5.6's ranges"),
    )
]  # fmt: skip
CLAIMS = [*PLAIN, *EARLY, CHANGES, *BEST, *LESS]
