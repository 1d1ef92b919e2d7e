"""Claims of T4.4: what a whole contour tells, guided or blind, to networks and to conventional classifiers."""

from collections.abc import Iterable, Iterator
from dataclasses import replace
from functools import partial

import pandas as pd

from haptic_glance.know.split import Split
from stages.report.claims import Claim, highest_of, reading
from stages.report.differences import difference, statistic
from stages.report.results import Results

from .rows import BLIND, CLASSIFIERS, GUIDED, METRICS, PRINTED, SHARED, SIZE, SPLITS, STAGE

RANDOM, UNSEEN = ({"split": split, "metric": METRICS[split]} for split in (Split.RANDOM, Split.OBJECTS))
WITH_MAP, NO_MAP = ("knn", "svm"), ("knn_no_som", "svm_no_som")
PHRASES = {
    **{("classifier", name): words for name, words in CLASSIFIERS.items()},
    **{("split", split): words for split, words in SPLITS.items()},
    **{("metric", metric): "" for metric in METRICS.values()},
    ("classifier", WITH_MAP): "mean of kNN and SVM with the map",
    ("classifier", NO_MAP): "mean of both without the map",
}  # fmt: skip
OBJECTS = {  # the pairs: one of each class left out
    "over": ("group", "repetition"), "shared": SHARED[Split.OBJECTS],
    "phrases": PHRASES | {("over", "repetition"): "objects"},
}  # fmt: skip
PRINTED_SET = "princeton_eight"  # 11,400 sequences a strategy, as many as the thesis has
MORE = ("princeton_touched", "furniture_splits")  # fewer sequences of more objects and splits: does it carry over?
claim = partial(Claim, section="T4.4.10", stage=STAGE, dataset=PRINTED_SET, statistic="whole_sequences",
                phrases=PHRASES)  # fmt: skip
guided = partial(claim, first={"method": GUIDED}, second={"method": BLIND})
cnn = partial(claim, where={"method": GUIDED}, first={"classifier": "cnn"})


@statistic("whole_sequences")
def whole_sequences(results: Results, claim: Claim) -> pd.Series:
    """First side minus second, of the sequences with all their frames and cells."""
    size = results.measured(STAGE, claim.sets[0])[SIZE].max()
    return difference(results, replace(claim, where={**claim.where, **size})).sort_index()


def both(claims: Iterable[Claim]) -> Iterator[Claim]:
    """Each claim with sequences drawn at random, as in the thesis, and with unseen objects."""
    for one in claims:
        said = f"{one.sentence[:-1]}, on objects never touched too."
        yield replace(one, key=f"{one.key}_random", where={**one.where, **RANDOM}, shared=SHARED[Split.RANDOM])
        yield replace(one, key=f"{one.key}_unseen", sentence=said, where={**one.where, **UNSEEN}, **OBJECTS)


OWN = [
    guided(key="contours_guided", where={"classifier": "cnn"},
           sentence="Contours through visually interesting points are better than blind ones."),
    guided(key="contours_guided_all", where={"classifier": PRINTED},
           sentence="Guided contours are better, averaged over the classifiers."),
    guided(key="contours_glance", section="ours", where={"classifier": "cnn"}, first={"method": "glance"},
           sentence="Contours through points of our glance are better than blind ones."),
    cnn(key="contours_cnn_best", sentence="Networks lead on sequences.", second={"classifier": highest_of(*WITH_MAP)},
        readings=(reading("beside classifiers without the map, too",
                          second={"classifier": highest_of(*WITH_MAP, *NO_MAP)}),)),
    *(
        cnn(key=f"contours_both_over_{alone}", section="T4.4.8", second={"classifier": f"cnn_{alone}"},
            sentence=f"Images and normals together beat the {alone} alone.")
        for alone in ("images", "normals")
    ),
    cnn(key="contours_map_helps", section="T4.4.9", first={"classifier": WITH_MAP}, second={"classifier": NO_MAP},
        sentence="Reducing the features by a self-organising map helps."),
]  # fmt: skip
PRIMARY = [one for one in both(OWN) if not one.own]
CLAIMS = [
    *PRIMARY,
    *(replace(one, key=f"{one.key}_more", of=one.key, dataset=MORE, printed=0) for one in PRIMARY),
    *(replace(one, dataset=MORE) for one in both(OWN) if one.own),
    claim(key="contours_random_flatters", section="ours", dataset=MORE,
          sentence="Drawing test sequences at random flatters: the same objects are known.",
          where={"method": GUIDED, "classifier": "cnn"}, first=RANDOM, second=UNSEEN, mean_of="first", **OBJECTS),
]  # fmt: skip
