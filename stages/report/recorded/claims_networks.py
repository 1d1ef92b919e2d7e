"""Claims of T5.4 on recorded touches: what filters learned by sight are worth on a pressure array and on fingertips."""

from collections.abc import Iterable, Iterator
from typing import Any

import pandas as pd

from haptic_glance.know.split import Split, shared_by
from stages.report.claims import Claim, Side, highest_of
from stages.report.effects import side, statistic
from stages.report.networks import GUESS, NETWORK, PRINTED
from stages.report.results import Results

from .rows import CLASSICAL, DATA, OVER, SPLITS, STAGE, commonest

SETTINGS = {
    "pressure_random": ("pressure", Split.RANDOM),
    "pressure_runs": ("pressure", Split.BLOCKS),
    "fingers_random": ("grasps_object", Split.RANDOM),
    "fingers_runs": ("grasps_object", Split.BLOCKS),
    "fingers_slip": ("grasps_slip", Split.TEST_OBJECTS),
}  # name in the key of a claim -> (data, split)
HAND = {"hand_random": ("schunk_coarse", Split.RANDOM), "hand_grasps": ("schunk_coarse", Split.OBJECTS)}
SETS = {"pressure": "pressure_images", "schunk_coarse": "schunk"}  # data -> set; all others: the fingertips
ARRAY, SLIP = ("pressure_random", "pressure_runs"), "fingers_slip"
FROZEN = {"method": NETWORK, "mode": "frozen", "weights": "imagenet"}
TUNED = FROZEN | {"mode": "finetuned"}
ANY = {"mode": "frozen"}  # of the networks
RIVALS = highest_of(*(network for network in PRINTED if network != "resnet50"))
SEEN, UNSEEN = {"weights": "imagenet"}, {"weights": "random"}
ACCURACY, GUESSING = {"metric": "accuracy"}, {"metric": highest_of("chance", "majority")}
PHRASES = {
    **{("data", data): words.partition(", ")[2] for data, words in DATA.items()},
    **{("split", split): words for split, words in SPLITS.items()},
    ("weights", "imagenet"): "ImageNet's weights", ("weights", "random"): "random weights",
    ("mode", "frozen"): "frozen", ("mode", "finetuned"): "fine-tuned",
    ("method", CLASSICAL[0]): "features and kNN", ("over", "method"): "networks",
    ("metric", "accuracy"): "accuracy", ("metric", "chance"): "guessing",
    ("metric", "majority"): "the commonest answer",
}  # fmt: skip


@statistic("over_commonest")
def over_commonest(results: Results, claim: Claim) -> pd.Series:
    """First side minus what the commonest answer gets right, which another stage has object by object."""
    return side(results, claim, claim.first, None) - commonest(results)


def claims(
    key: str, sentence: str, first: Side, second: Side, names: Iterable[str] = SETTINGS, where: Side = FROZEN,
    **fields: Any,
) -> Iterator[Claim]:  # fmt: skip
    """The claim on each of the settings `names`. where: what both sides have in common, unless they say otherwise."""
    for name in names:
        data, split = (SETTINGS | HAND)[name]
        common = {"data": data, "split": split, **ACCURACY, **where}
        said = {"section": "T5.4", "over": ("item",) if split in OVER else ("repetition",)} | fields
        yield Claim(
            key=f"recorded_{key}_{name}", sentence=sentence, stage=STAGE, first=first, second=second, phrases=PHRASES,
            dataset=SETS.get(data, "biotac_grasps"),
            where={column: value for column, value in common.items() if column not in first}, **said,
        )  # fmt: skip


SHARED = "Vision and touch share features:"
BETTER = "Frozen visual filters tell recorded touches apart better than guessing."
CLAIMS = [
    *claims("frozen_over_guessing", BETTER, ACCURACY, GUESSING, [name for name in SETTINGS if name != SLIP]),
    *claims("frozen_over_guessing", BETTER, ACCURACY, {"metric": "majority"}, [SLIP], statistic="over_commonest"),
    *claims("frozen_by_guessing", "On a pressure array frozen visual filters are hardly better than guessing.",
            GUESSING, ACCURACY, ARRAY, margin=GUESS,
            note="the thesis's own largest lead; 28 x 50 cells, the thesis has 16 x 16"),
    *claims("instant_by_guessing", "One reading of 7 x 3 cells is hardly better than guessing what is grasped.",
            GUESSING, ACCURACY, HAND, margin=GUESS, shared=shared_by(Split.RANDOM), note="another hand than BiGS's"),
    *claims("series_over_instant", "A series of readings tells grasped objects apart better than one of 7 x 3 cells.",
            {"data": "schunk"}, {"data": "schunk_coarse"}, HAND, shared=shared_by(Split.RANDOM),
            note="another hand than BiGS's"),
    *claims("seen_over_random_frozen", f"{SHARED} frozen filters learned by sight help with recorded touches.",
            SEEN, UNSEEN),
    *claims("seen_over_random_networks", f"{SHARED} frozen filters learned by sight help, whichever network.",
            SEEN, UNSEEN, ARRAY, ANY, over=("method",), within=("repetition",), note="each network that was run"),
    *claims("seen_over_random_tuned", f"{SHARED} sight is a better start for recorded touches.",
            SEEN, UNSEEN, where=TUNED),
    *claims("tuned_over_frozen", "Fine-tuning on recorded touches beats frozen filters.",
            {"mode": "finetuned"}, {"mode": "frozen"}, note="tuned in 600 steps at most, of fingertips two passes"),
    *claims("resnet_best", "ResNet50 is the best of the networks on recorded touches.",
            {"method": "resnet50"}, {"method": RIVALS}, ARRAY,
            note="of those that were run; the highest in these tests, which is hard on ResNet50"),
    *claims("frozen_over_features", "Frozen visual filters beat hand-made features on recorded touches.",
            {"method": NETWORK}, {"method": CLASSICAL[0], "mode": None, "weights": None}, section="ours"),
]  # fmt: skip
