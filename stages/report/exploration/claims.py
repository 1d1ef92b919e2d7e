"""Claims on several touches: how many it takes, where to touch next, and whether the stated belief is right."""

from functools import partial

import numpy as np
import pandas as pd

from haptic_glance.know.split import Split
from stages.report.claims import Claim, Side
from stages.report.differences import side, statistic
from stages.report.results import Results

from .exploration import HEADLINE, LIKELIHOODS, STAGE, WAYS, curves

PERFECT = 0.99  # what "up to 100 %" of T table 4.6 is taken to mean
AT_RANDOM = {
    "group": "six", "method": "thesis_ssim", "split": Split.RANDOM, "likelihood": "imprint", "metric": "accuracy",
}  # fmt: skip
PLACES = AT_RANDOM | {"likelihood": "imprint_place"}
FIXED = {"way": "random", "stop": "fixed"}
SURE = {"stop": "confidence", "level": HEADLINE}
FIVE, ONE = {"level": 5.0}, {"level": 1.0}
PHRASES = {
    ("metric", "accuracy_decided"): "accuracy of those that stopped",
    **{("likelihood", name): f"belief {words}" for name, words in LIKELIHOODS.items()},
    **{("way", name): words for name, words in WAYS.items()},
    ("level", HEADLINE): f"at a belief of {100 * HEADLINE:.0f} %",
    **{("level", float(count)): f"after {count} touch{'es' if count > 1 else ''}" for count in (1, 5)},
    ("stop", "confidence"): "stopping", ("stop", "fixed"): "a fixed number of touches",
}  # fmt: skip
claim = partial(Claim, section="ours", stage=STAGE, phrases=PHRASES)
five = partial(claim, where=AT_RANDOM | FIXED, first=FIVE)
touches = partial(claim, where=AT_RANDOM | SURE, scale=1.0, unit="touches", statistic="touches_saved")


@statistic("touches_saved")
def touches_saved(results: Results, claim: Claim) -> pd.Series:
    """Touches that the second side takes minus those of the first."""
    return _touches(results, claim, claim.other) - _touches(results, claim, claim.first)


@statistic("over_as_many_touches")
def over_as_many_touches(results: Results, claim: Claim) -> pd.Series:
    """Accuracy of the first side minus that of a fixed number of touches, interpolated at as many."""
    curve = curves(results.measured(STAGE, claim.sets[0], **claim.where, stop="fixed"))
    touches = _touches(results, claim, claim.first)
    fixed = {one: np.interp(touches[one], curve.columns, curve.loc[one]) for one in touches.index}
    return side(results, claim, claim.first, None) - pd.Series(fixed)


@statistic("overconfidence")
def overconfidence(results: Results, claim: Claim) -> pd.Series:
    """Stated belief minus accuracy, after the largest number of touches."""
    rows = results.measured(STAGE, claim.sets[0], **claim.where)
    last = rows[rows["level"] == rows["level"].max()].set_index("repetition")
    return last["belief"] - last["value"]


def _touches(results: Results, claim: Claim, own: Side) -> pd.Series:
    return results.measured(STAGE, claim.sets[0], **claim.where, **own).set_index("repetition")["touches"]


CLAIMS = [
    five(key="five_touches_over_one", second=ONE, sentence="Adding up beliefs over touches is better than one touch."),
    five(key="five_touches_perfect", where=PLACES | FIXED, second=PERFECT,
         sentence="Beliefs added up over five touches and their places come up to 99 %."),
    five(key="five_touches_perfect_by_imprints", second=PERFECT,
         sentence="Beliefs added up over five touches come up to 99 % by imprints alone."),
    *(
        claim(key=f"adaptive_over_fixed{key}", sentence=f"Stopping when sure beats a fixed number{words}.",
              where=where | {"way": "random"}, first=SURE, statistic="over_as_many_touches",
              note="minus as many touches for every object")
        for key, words, where in (("", " of touches", AT_RANDOM), ("_places", " where places count too", PLACES))
    ),
    touches(key="gain_over_random", first={"way": "gain"}, second={"way": "random"},
            sentence="Touching where the belief gains most takes fewer touches than a random order."),
    touches(key="gain_over_saliency", first={"way": "gain"}, second={"way": "saliency"},
            sentence="Touching where the belief gains most takes fewer touches than by saliency."),
    touches(key="saliency_over_random", first={"way": "saliency"}, second={"way": "random"},
            sentence="Touching by saliency takes fewer touches than a random order."),
    claim(key="first_touch_by_saliency", sentence="The most salient place is the best first touch.",
          where=AT_RANDOM | {"stop": "fixed"} | ONE, first={"way": "saliency"}, second={"way": "random"}),
    claim(key="sure_is_right", sentence="A belief of 95 % is right at least 95 times in 100.",
          where=AT_RANDOM | {"metric": "accuracy_decided", "way": "random"}, first=SURE, second=HEADLINE),
    claim(key="product_too_sure", sentence="Multiplying the likelihoods of touches makes a robot too sure.",
          where=AT_RANDOM | FIXED | {"split": Split.REGIONS, "likelihood": "imprint_product"},
          statistic="overconfidence", note="stated belief minus accuracy after the largest number of touches"),
]  # fmt: skip
