"""The words for the data of a claim, written from its fields."""

from collections.abc import Sequence

from haptic_glance.know.split import Split

from .claims import Claim, Pick, Side
from .drawing import label
from .results import (
    COLOURED,
    MENDED_3_2,
    ON_BLACK,
    ON_GREY,
    ON_WHITE,
    SECTION_3_1,
    SECTION_3_2,
    SECTION_4_2,
    SETS_3_1,
    SETS_4_2,
    Results,
)
from .tables import number

METRICS = {  # "" where the claim's unit says it
    "accuracy": "", "recall": "mean of the objects' rates", "nss": "NSS", "auc": "AUC", "pcc": "PCC",
}  # fmt: skip
DATASETS = {
    SECTION_3_1: "household as in T3.1", SETS_3_1[1]: "psb as in T3.1",
    SECTION_3_2: "meshes with human gaze as in T3.2", MENDED_3_2: "meshes with human gaze as in T3.2, formulas mended",
    SECTION_4_2: "household as in T4.2", SETS_4_2[0]: "random sets of household shapes as in T4.2",
    SETS_4_2[1]: "random sets of psb as in T4.2", COLOURED: "furniture in colour",
    ON_BLACK: "the same with the black background filtered", ON_GREY: "on grey", ON_WHITE: "on white",
    "gaze": "meshes with human gaze", "gaze_clouds": "point clouds with human gaze", "princeton": "psb",
    "princeton_touched": "psb, 8 classes of 6 objects", "princeton_hands": "psb, several arrays or touches",
    "princeton_eight": "psb, the thesis's 8 classes", "princeton_six": "psb, the thesis's 6 classes",
    "furniture_splits": "furniture, 20 splits",
    "pressure_images": "recorded pressure array", "biotac_grasps": "recorded fingertips",
    "touch_events": "recorded events of a fingertip",
    "household_denoised": "household, denoised", "household_stability": "household shapes, disturbed",
    "furniture_hands": "furniture, several arrays or touches",
    "schunk": "recorded hand with arrays", "household_scenes": "30 random scenes of household objects",
}  # fmt: skip
NAMED = ("method", "classifier", "network")  # columns whose values have a label


def dataset_text(name: str) -> str:
    """A data set in words."""
    return DATASETS.get(name, name)


def tested_on(claim: Claim, results: Results, sets: Sequence[str]) -> str:
    """`household: kNN, six objects, first minus second`: sets, what both sides share, the sides, and the note."""
    claim, several = claim.on(sets[0]), " and ".join(map(dataset_text, sets))
    shared = [_phrase(claim, results, column, value) for column, value in claim.where.items()]
    parts = [several, *shared, _sides(claim, results), claim.note]
    return ", ".join(part.rstrip(",") for part in parts if part)


def _sides(claim: Claim, results: Results) -> str:
    said = _side(claim, results, claim.first)
    if isinstance(claim.second, int | float):
        if claim.second:
            said = said or str(claim.where.get("metric", "value")).replace("_", " ")
            said += f" minus {number(claim.scale * claim.second)}"
    elif claim.second is not None:
        said += f" minus {_side(claim, results, claim.second)}"
    if claim.contrast:
        one, other = (_side(claim, results, where) for where in claim.contrast)
        said = f"{said}: {one} minus {other}"
    return said + (f", {claim.margin:+g} {claim.unit}" if claim.margin else "")


def _side(claim: Claim, results: Results, side: Side) -> str:
    return " ".join(filter(None, (_phrase(claim, results, column, value) for column, value in side.items())))


def _phrase(claim: Claim, results: Results, column: str, value: object) -> str:
    """One column and its value in words; the topic's own words first."""
    if isinstance(value, Pick):
        rank = "lowest" if value.lowest else "highest"
        names = ", ".join(_phrase(claim, results, column, name) for name in value.names)
        return f"the {rank} of {names}" if names else f"the {rank} of the others"
    if (column, value) in claim.phrases:
        return claim.phrases[column, value]
    if isinstance(value, tuple):
        return f"mean of {', '.join(_phrase(claim, results, column, one) for one in value)}"
    if value is None:
        return ""
    if column == "group":
        return results.group_text(str(value), claim.sets[0])
    if column == "dataset":
        return dataset_text(str(value))
    if column == "split":
        return Split(str(value)).words
    if column == "metric":
        return METRICS.get(str(value), str(value).replace("_", " "))
    return label(value) if column in NAMED else f"{column} {value}"
