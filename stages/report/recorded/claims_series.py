"""Claims of our own on touches over time: bins and a linear classifier beside the published networks."""

from typing import Any

from haptic_glance.know.split import Split
from stages.report.claims import Claim

from .touch_events import GROUPS, NETWORK, OURS, SET

PHRASES = {
    **{("group", group): words for group, words in GROUPS.items()},
    ("method", OURS): "linear discriminant of bins", ("method", "linear_svm"): "linear SVM of bins",
    ("method", "knn"): "kNN", ("heard", 0.25): "the first quarter of a touch", ("heard", 1.0): "all of it",
    ("cells", 20): "20 taxels", ("cells", 39): "all 39",
}  # fmt: skip
TESTED = {"part": "test", "metric": "accuracy"}
FOLDED = {"part": "training", "metric": "accuracy", "method": OURS, "disturbance": None}


def on_events(key: str, sentence: str, **fields: Any) -> Claim:
    """A claim on touch events, its pairs the objects."""
    return Claim(
        key=f"events_{key}", section="ours", sentence=sentence, stage="recorded", dataset=SET, over=("item",),
        phrases=PHRASES, **fields,
    )  # fmt: skip


CLAIMS = [
    *(
        on_events(
            f"{method}_over_network_{group}",
            f"Time-binned event counts and a linear {said} recognise {group} better than the published spiking graph "
            "network.",
            where=TESTED | {"group": group}, first={"method": method}, second=NETWORK[group],
            note="the network's figure is a constant here: it has no interval",
        )
        for method, said in ((OURS, "discriminant"), ("linear_svm", "SVM")) for group in GROUPS
    ),
    *(
        on_events(f"bins_over_components_{group}", "A linear discriminant of all bins recognises more than kNN on "
                  "twelve components of them.",
                  where=TESTED | {"group": group}, first={"method": OURS}, second={"method": "knn"})
        for group in GROUPS
    ),
    on_events("quarter_enough", "The first quarter of a touch is enough to know an object nearly as well.",
              where=FOLDED | {"group": "objects", "cells": 39}, first={"heard": 0.25}, second={"heard": 1.0},
              margin=5.0, note="within five points"),
    *(
        on_events(f"half_the_taxels_{group}", "Half of the taxels are enough to know nearly as well.",
                  where=FOLDED | {"group": group, "heard": 1.0}, first={"cells": 20}, second={"cells": 39}, margin=5.0,
                  note="within five points")
        for group in GROUPS
    ),
    Claim(
        key="grasp_series_over_components", section="ours", stage="recorded", dataset="schunk", over=("item",),
        sentence="A linear discriminant of binned pressure recognises more grasps than kNN on twelve components.",
        where={"part": "training", "metric": "accuracy", "split": Split.OBJECTS}, first={"method": OURS},
        second={"method": "knn"}, phrases={**PHRASES, ("over", "item"): "grasps"},
    ),
]  # fmt: skip
