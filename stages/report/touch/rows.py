"""The rows of the stage classification that this topic reads, and how its methods and variants are called."""

import numpy as np
import pandas as pd

from stages.kit.split import Split, shared_by
from stages.kit.stats import interval
from stages.report.results import Results

STAGE = "classification"
OURS = {
    "blind_touch": "random",
    "hks": "heat_kernel",
    "salient_points": "salient_points",
    "mesh_saliency": "mesh_saliency",
    "visual_attention": "itti",
    "enhanced_visual_attention": "thesis_ssim",
}
ENHANCED = OURS["enhanced_visual_attention"]  # the thesis's own: the average weighted with its SSIM weights
MODEL = "enhanced"  # this project's model of gaze
FIFTEEN = "the first 15 imprints of each object, as the thesis had"
PHRASES = {
    ("method", MODEL): "our model of gaze",
    ("method", ENHANCED): "enhanced attention",
    ("metric", "similar_share"): "share of imprints that correlate by 0.85 or more with one of another object",
    ("variant", "plain"): "all imprints",
    ("variant", "plain_side"): "all imprints",  # split regions: one side of all objects, not a region of each
    ("variant", "first_15"): FIFTEEN,
    ("variant", "selected"): "similar imprints removed from training and test part",
    ("variant", "selected_train"): "similar imprints removed from the training part",
    ("variant", "locations"): "imprints with positions",
    ("variant", "locations_turned"): "imprints with positions, tested on objects turned about the vertical,",
    **{
        ("variant", f"touches_{count}{suffix}"): f"{count} joined touch{'es' if count > 1 else ''}{words}"
        for count in (1, 3, 5)
        for suffix, words in (
            ("", ""), ("_many", ", five times as many combinations,"), ("_mixed", ", combined before the split,"),
            ("_disjoint", ", each imprint in one combination,"),
        )
    },
}  # fmt: skip


def accuracies(rows: pd.DataFrame) -> dict[str, float]:
    """accuracy, low, high, repetitions at random, and mean accuracy on the other splits; NaN where not measured."""
    right = rows[rows["metric"] == "accuracy"]
    by_split = {split: group["value"].to_numpy() for split, group in right.groupby("split")}
    at_random = by_split.get(Split.RANDOM, [])
    mean, low, high = interval(at_random, shared_by(Split.RANDOM))
    found = {"accuracy": mean, "low": np.maximum(low, 0.0), "high": np.minimum(high, 1.0)}
    others = (Split.FOLDS, Split.REGIONS, Split.RANDOM_FEWER)
    found |= {"repetitions": len(at_random)}
    return found | {f"accuracy_{split}": interval(by_split.get(split, []))[0] for split in others}


def at_random(results: Results, **where: object) -> pd.DataFrame:
    """Accuracies on touches drawn at random; NotRun where there is none."""
    return results.measured(STAGE, metric="accuracy", split=Split.RANDOM, **where)
