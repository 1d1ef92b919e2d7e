"""Claims of T4.4: what a whole contour tells, guided or blind, to networks and to conventional classifiers."""

from collections.abc import Iterable, Iterator
from dataclasses import replace
from functools import partial

import pandas as pd

from stages.kit.split import Split
from stages.report import claims as data
from stages.report.claims import highest_of
from stages.report.differences import difference, statistic
from stages.report.results import Results

from .rows import BLIND, CLASSIFIERS, GUIDED, METRICS, PRINTED, SHARED, SIZE, SPLITS, STAGE, THESIS_SET

RANDOM, UNSEEN = ({"split": split, "metric": METRICS[split]} for split in (Split.RANDOM, Split.OBJECTS))
OBJECTS = {"over": ("group", "repetition"), "shared": SHARED[Split.OBJECTS]}  # the pairs: one of each class left out
WITH_MAP, NO_MAP = ("knn", "svm"), ("knn_no_som", "svm_no_som")
PHRASES = {
    **{("classifier", name): words for name, words in CLASSIFIERS.items()},
    **{("split", split): words for split, words in SPLITS.items()},
    **{("metric", metric): "" for metric in METRICS.values()},
    ("classifier", WITH_MAP): "mean of kNN and SVM with the map",
    ("classifier", NO_MAP): "mean of both without the map", ("over", "group"): "objects, by classes",
}  # fmt: skip
claim = partial(data.Claim, section="T4.4.10", stage=STAGE, statistic="whole_sequences", phrases=PHRASES)


@statistic("whole_sequences")
def whole_sequences(results: Results, claim: data.Claim) -> pd.Series:
    """First side minus second, of the sequences with all their frames and cells."""
    size = results.measured(STAGE, claim.dataset)[SIZE].max()
    return difference(results, replace(claim, where={**claim.where, **size})).sort_index()


def both(claims: Iterable[data.Claim]) -> Iterator[data.Claim]:
    """Each claim with sequences drawn at random, as in the thesis, and with unseen objects."""
    for one in claims:
        at_random, unseen = ({**one.where, **where} for where in (RANDOM, UNSEEN))
        said = f"{one.sentence[:-1]}, on objects never touched too."
        yield replace(one, key=f"{one.key}_random", where=at_random, shared=SHARED[Split.RANDOM])
        yield replace(one, key=f"{one.key}_unseen", sentence=said, where=unseen, **OBJECTS)


def at_full_size(claims: Iterable[data.Claim], keys: Iterable[str]) -> Iterator[data.Claim]:
    """The claims with these keys, on the thesis's own data set and number of sequences."""
    for one in claims:
        if one.key in keys:
            said = f"{one.sentence[:-1]}, with 22,800 sequences."
            yield replace(one, key=f"{one.key}_princeton", sentence=said, dataset=THESIS_SET)


OWN = [
    claim(key="contours_guided",
          sentence="Contours through visually interesting points are better than blind ones.",
          where={"classifier": "cnn"}, first={"method": GUIDED}, second={"method": BLIND}),
    claim(key="contours_guided_all", sentence="Guided contours are better, averaged over the classifiers.",
          where={"classifier": PRINTED}, first={"method": GUIDED}, second={"method": BLIND}),
    claim(key="contours_ours", section="ours",
          sentence="Contours through points of our model of gaze are better than blind ones.",
          where={"classifier": "cnn"}, first={"method": "enhanced"}, second={"method": BLIND}),
    claim(key="contours_cnn_best", sentence="Networks lead on sequences.",
          where={"method": GUIDED}, first={"classifier": "cnn"}, second={"classifier": highest_of("knn", "svm")}),
    *(
        claim(key=f"contours_both_over_{alone}", section="T4.4.8",
              sentence=f"Images and normals together beat the {alone} alone.",
              where={"method": GUIDED}, first={"classifier": "cnn"}, second={"classifier": f"cnn_{alone}"})
        for alone in ("images", "normals")
    ),
    claim(key="contours_map_helps", section="T4.4.9",
          sentence="Reducing the features by a self-organising map helps.",
          where={"method": GUIDED}, first={"classifier": WITH_MAP}, second={"classifier": NO_MAP}),
]  # fmt: skip
CLAIMS = [
    *both(OWN),
    *both(at_full_size(OWN, ["contours_guided", "contours_guided_all", "contours_cnn_best"])),
    claim(key="contours_random_flatters", section="ours",
          sentence="Drawing test sequences at random flatters: the same objects are known.",
          where={"method": GUIDED, "classifier": "cnn"}, first=RANDOM, second=UNSEEN, mean_of="first", **OBJECTS),
]  # fmt: skip
