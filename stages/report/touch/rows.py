"""Rows of the stage classification, as printed in the thesis (T4.2) and in our protocol, and their accuracies.

`METHODS` maps the thesis's samplings to methods.
"""

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd

from haptic_glance.know.classifiers import TRAINING
from haptic_glance.know.split import Split, shared_by
from haptic_glance.look.weights.weights import GLANCE
from stages.report.drawing import label
from stages.report.results import SECTION_4_2, SETS_4_2, Results, some
from stages.report.tables import everywhere, scaled, within

STAGE = "classification"
PRINTED = SECTION_4_2
EQUAL, SSIM = "VisAttAll", "thesis_ssim"  # the thesis's models of T3.1, and of T3.2 with its SSIM weights
MODEL = GLANCE  # this project's model of gaze
METHODS = {  # sampling of the thesis: its method; enhanced visual attention is SSIM in our protocol
    "blind_touch": "random", "hks": "heat_kernel", "salient_points": "salient_points",
    "mesh_saliency": "mesh_saliency", "visual_attention": "itti", "enhanced_visual_attention": EQUAL,
}  # fmt: skip
BLIND = ("random", *(f"random_{draw}" for draw in range(2, 6)))  # draws of blind touch
# The mean share of six objects that two random sets have in common: a deck is dealt again when it is used up.
COMMON = {SETS_4_2[0]: 0.0859, SETS_4_2[1]: 0.0238, SETS_4_2[2]: 0.0}


def shared_objects(*datasets: str) -> float:
    """The test over training share of splits that are as much alike as random sets of objects, for `interval`.

    datasets: that of each random set; one name stands for any number of its sets. Two sets with a share r of their
    objects in common correlate by r, and so do repeated splits with a share of r / (1 - r) (Nadeau and Bengio 2003).
    """
    counts = Counter(datasets * 2 if len(datasets) == 1 else datasets)
    pairs = sum(count * (count - 1) * COMMON.get(name, 0.0) for name, count in counts.items())
    common = pairs / (counts.total() * (counts.total() - 1))
    return common / (1 - common)


@dataclass(frozen=True)
class Protocol:
    """Rows of one set: of T4.2's own sensor, views and model, or of ours.

    dataset: its name, that of the first of several. rows: what was measured. name: as the tables call it. best: the
    model whose points are looked at closer.
    """

    dataset: str
    rows: pd.DataFrame
    name: str
    best: str

    @property
    def samplings(self) -> dict[str, str]:
        """{sampling of the thesis: method}."""
        return METHODS | ({} if self.best == EQUAL else {"enhanced_visual_attention": SSIM})


def protocols(results: Results, on_sets: bool = False, scaling: str = TRAINING, **where: Any) -> Iterator[Protocol]:
    """The protocol as printed, where it was run, then ours on the first other set; NotRun where neither has rows.

    on_sets: also that as printed on random sets of objects. scaling: of the samples; rows about no classifier
    have none.
    """
    by_set = everywhere(results, STAGE, **where)
    by_set = {name: part for name, rows in by_set.items() if not (part := scaled(rows, scaling)).empty}
    by_set = {name: rows for name, rows in by_set.items() if on_sets or name not in SETS_4_2}
    some(by_set, f"no rows of the scaling {scaling}", STAGE)
    if PRINTED in by_set:
        yield Protocol(PRINTED, by_set.pop(PRINTED), "as printed", EQUAL)
    if printed_sets := {name: by_set.pop(name) for name in SETS_4_2 if name in by_set}:
        rows = pd.concat(printed_sets.values(), ignore_index=True).replace({"method": dict.fromkeys(BLIND, BLIND[0])})
        count = len(rows[["dataset", "set"]].drop_duplicates())
        yield Protocol(next(iter(printed_sets)), rows, f"as printed, {count} random sets", EQUAL)
    for dataset, rows in list(by_set.items())[:1]:
        yield Protocol(dataset, rows, "ours", MODEL)


def accuracies(rows: pd.DataFrame, split: Split = Split.RANDOM) -> dict[str, float]:
    """accuracy, low, high, repetitions of one split, and mean accuracy on the others; NaN where not measured.

    The interval is over repeated splits of the same objects, or over random sets of objects.
    """
    columns = [column for column in ("dataset", "set", "split", "value") if column in rows]  # of some forty
    accuracy_rows = rows.loc[rows["metric"] == "accuracy", columns].dropna(subset=["value"])
    splits, values = accuracy_rows["split"].to_numpy(), accuracy_rows["value"].to_numpy(float)
    of_split, share = values[splits == split], shared_by(split)
    split_rows = accuracy_rows[splits == split]
    if "set" in split_rows and split_rows["set"].notna().any():
        of_split = split_rows.groupby(["dataset", "set"])["value"].mean()
        share = shared_objects(*of_split.index.get_level_values("dataset"))
    ends = zip(("accuracy", "low", "high"), within(of_split, share), strict=True)
    by_split = {name: values[splits == name] for name in (Split.FOLDS, Split.REGIONS, Split.RANDOM_FEWER)}
    means = {f"accuracy_{name}": group.mean() if len(group) else np.nan for name, group in by_split.items()}
    return {**dict(ends), "repetitions": len(of_split), **means}


def fifteen(variant: str) -> str:
    """The variant of the stage that has only the first 15 imprints of each object, as the thesis had."""
    return "first_15" if variant == "plain" else f"first_15_{variant}"


def sampling_text(name: str) -> str:
    """A sampling in words; `, 15 imprints` stays behind it."""
    base, comma, suffix = name.partition(", ")
    return label(base) + comma + suffix
