"""Claims on recognition by touch (T4.2), and charts of its accuracy against seconds.

The claims are about points, classifiers, imprints and groups of objects: in the thesis's protocol on random sets of
objects, and in ours. The charts are about classifiers, about features and touches, and about the search for the points.
"""

from functools import partial
from typing import Any

import pandas as pd

from haptic_glance.know.classifiers import TRAINING
from haptic_glance.know.split import Split, shared_by
from stages.charts.datasets import SETS_4_2, SUMS_4_2
from stages.charts.drawing import label
from stages.charts.items import Figure
from stages.charts.pareto import attention_seconds, pareto_chart
from stages.charts.results import Results
from stages.charts.tables import means
from stages.report.claims import (
    ALIVE,
    NO_SVM,
    RANGE,
    SCALE,
    SCALED,
    TRAINED,
    Claim,
    Reading,
    Side,
    highest_of,
    in_sums,
    lowest_of,
    reading,
)  # fmt: skip
from stages.report.effects import statistic

from .tables import BLIND, EQUAL, METHODS, MODEL, SSIM, STAGE, shared_objects

RIGHT: dict[str, Any] = {"metric": "accuracy", "split": Split.RANDOM}
EVERY, KNN = {"group": "six"} | RIGHT, {"classifier": "knn"} | RIGHT  # EVERY: the mean of all classifiers
SIX: dict[str, Any] = {"classifier": "knn"} | EVERY
FOUR, APART, NETWORK = SIX | {"group": "four"}, SIX | {"split": Split.REGIONS}, SIX | {"classifier": "deep_learning"}
SETS: dict[str, Any] = {  # as printed, on random sets of objects
    "dataset": SETS_4_2, "over": ("set",), "printed": 2, "shared": shared_objects,
}  # fmt: skip
PLAIN, FEW = dict[str, Any](variant="plain"), dict[str, Any](variant="first_15")  # FEW: as many as the thesis had
ALL = "mean of all classifiers"
RIVAL = highest_of("itti", "mesh_saliency", "salient_points", "heat_kernel", EQUAL)
# In the keys of claims: two points, and behind them the rows.
POINTS: dict[str, Any] = {
    "equal": EQUAL,
    "glance": MODEL,
    "ssim": SSIM,
    "blind": BLIND,
    "best_touch": RIVAL,
    "touch": "touch",  # places worth touching
}
ROWS = {"": SIX, "_mean": SIX, "_four": FOUR, "_all": EVERY, "_apart": APART, "_60": SIX}
ROWS |= {"_ours": ROWS[""], "_apart_ours": ROWS["_apart"]}  # of our protocol, not of the printed one
MIXED = (  # five touches; of one touch there is nothing to combine: mixed, its test part would be in training, too
    ("combined before the split", "touches_5_mixed"),
    ("combined before the split, the five from 15 imprints", "first_15_touches_5_mixed"),
)
BEFORE_SPLIT = tuple(reading(name, first={"variant": five}, where=TRAINED) for name, five in MIXED)
MANY = reading("five times as many combinations", first={"variant": "touches_5_many"},
               second={"variant": "touches_1_many"}, where=TRAINED)  # fmt: skip
ONE_MAPPED = reading("beside one touch with the map, in copies", second={"variant": "touches_1"}, where={})
JOINED = tuple(  # of all classifiers
    reading(
        f"without the SVM, {base.name}", **{**base.changes, "where": {**base.changes["where"], "classifier": ALIVE}}
    )
    for base in (ONE_MAPPED, *BEFORE_SPLIT, MANY)
)
MORE_THAN_KNN = reading("more than kNN does", contrast=({"classifier": "deep_learning"}, {"classifier": "knn"}))
COPIES = reading("one joined touch in twenty copies", where={"variant": "touches_1_many"} | TRAINED)
AS_MANY = reading("beside as many imprints removed at random", second={"variant": "selected_control"})
AS_MANY_ALL = reading("without the SVM, beside as many imprints removed at random", where={"classifier": ALIVE},
                      second={"variant": "selected_control"})  # fmt: skip
RATES = reading(  # which is the accuracy where all objects have equally many imprints, as before a selection
    "without the SVM, mean of the objects' rates", where={"classifier": ALIVE}, first={"metric": "recall"},
    second={"metric": "accuracy"},
)  # fmt: skip
EACH_ALONE = tuple(reading(f"{label(name)} alone", where={"classifier": name}, note="") for name in ("svm", *ALIVE))
FIFTEEN = reading("15 imprints of each object", where=FEW)
SIXTY = tuple(
    reading(", ".join(["60 imprints of each object", *([scaled.name] if scaled else [])]),
            where=PLAIN | (scaled.changes["where"] if scaled else {}))
    for scaled in (None, *SCALED)
)  # fmt: skip
FIFTEEN_SELECTED, FIFTEEN_TRAIN = (
    reading(FIFTEEN.name, where=TRAINED, first={"variant": f"first_15_{selected}"}, second=FEW)
    for selected in ("selected", "selected_train")
)
FIFTEEN_SELECTED_ALL = reading(f"without the SVM, {FIFTEEN.name}", where={"classifier": ALIVE} | TRAINED,
                               first={"variant": "first_15_selected"}, second=FEW)  # fmt: skip
# Scaling, imprints of each object, and the readings of both.
Protocol = tuple[dict[str, Any], dict[str, Any], tuple[Reading, ...], tuple[Reading, ...]]
PRINTED: Protocol = SCALE, FEW, SCALED, SIXTY
# Of our models and of what the thesis does not claim: nothing leaks from the test part.
OURS: Protocol = TRAINED, PLAIN, (reading("z-transform of all data beforehand", where=SCALE), RANGE), (FIFTEEN,)
PHRASES = {
    ("method", MODEL): "our glance", ("method", "touch"): "places whose imprint recurs",
    ("method", EQUAL): "the thesis's attention (equal weights)",
    ("method", SSIM): "the thesis's attention (SSIM)", ("method", BLIND): "blind touch, five draws",
    ("method", BLIND[0]): "blind touch, one draw",
    ("over", "set"): "random sets of six objects",
    ("metric", "similar_share"): "share of imprints that correlate by 0.85 or more with one of another object",
    ("variant", "plain"): "all imprints",
    ("variant", "plain_side"): "all imprints, both tested on one side of all objects",  # not on a region of each
    ("variant", "first_15"): "the first 15 imprints of each object, as the thesis had",
    ("variant", "selected"): "similar imprints removed from training and test part",
    ("variant", "selected_control"): "as many imprints of each object removed at random",
    ("variant", "selected_train_control"): "as many removed from the training part at random",
    ("scaling", "training"): "", ("scaling", "beforehand"): "z-transform of all data beforehand",
    ("scaling", "min_max"): "all data from 0 to 1",
    ("variant", "selected_train"): "similar imprints removed from the training part",
    ("variant", "locations"): "imprints with positions",
    ("variant", "locations_turned"): "imprints with positions, tested on objects turned about the vertical,",
    **{
        ("variant", f"touches_{count}{end}"): f"{count} joined touch{'es' if count > 1 else ''}{words}"
        for count in (1, 3, 5) for end, words in (
            ("", ""), ("_many", ", five times as many combinations,"), ("_mixed", ", combined before the split,"),
            ("_disjoint", ", each imprint in one combination,"))
    },
}  # fmt: skip

OF_RANKS = {("method", tuple(METHODS.values())): "", ("metric", "accuracy"): "accuracy"}
OF_FOUR = {("group", "four"): "the four least alike of six", ("group", "four_drawn"): "four of the six drawn"}


@statistic("unlike_more_accurate")
def unlike_more_accurate(results: Results, claim: Claim) -> pd.Series:
    """Minus the rank correlation over the methods of shares of like imprints (first side) and accuracies (second)."""
    rows = (results.measured(STAGE, claim.sets[0], **claim.where, **part) for part in (claim.first, claim.other))
    shares, accuracies = (part.pivot_table(index="set", columns="method", values="value") for part in rows)
    return -shares.corrwith(accuracies, axis=1, method="spearman")


def by_points(key: str, sentence: str, end: str = "", of: str = "") -> Claim:
    """A claim that touch at the first points of its key is better than at the second; end: of the key, for the ROWS."""
    points = POINTS | ({"blind": BLIND[0]} if end.endswith("_ours") else {})  # our protocol has one draw
    first, second = ({"method": points.get(name, name)} for name in key.split("_over_"))
    section = "ours" if key.startswith(("glance", "touch")) or end.endswith("_ours") else "T4.2.4"
    scale, size, scalings, sizes = OURS if section == "ours" else PRINTED
    if "_apart" in end or end == "_60":
        size, sizes = PLAIN, ()
    sets: dict[str, Any] = {} if end.endswith("_ours") else SETS | ({"printed": 0} if section == "ours" else {})
    sums = () if section == "ours" else in_sums(first["method"], second["method"], dataset=SUMS_4_2)
    readings = (*scalings, *((NO_SVM,) if end == "_all" else sizes), *sums)
    return Claim(
        key=key + end, sentence=sentence, first=first, second=second, where=ROWS[end] | scale | size, stage=STAGE,
        phrases=PHRASES, note=ALL if end == "_all" else "", section=section, of=of, readings=readings if sets else (),
        fixed=end == "_mean", **sets,
    )  # fmt: skip


def at(best: str, end: str = "", **common: Any) -> list[Claim]:
    """The claims on classifiers, selection, positions and several touches at the points of one model.

    end: of their keys. The protocol is the printed one, or ours where the section is "ours"; some variants were run
    with the z-transform of the training part alone.
    """
    model: Side = {"method": best}
    scale, size, scalings, sizes = OURS if common["section"] == "ours" else PRINTED

    def claim(key: str, sentence: str, where: Side, first: Side, second: Side | float, **further: Any) -> Claim:
        sides = {"where": {**scale, **where, **model}, "first": first, "second": second}
        return Claim(key=key + end, sentence=sentence, stage=STAGE, phrases=PHRASES, **sides, **common | further)

    def variant(key: str, sentence: str, kind: str, rival: str = "plain", where: Side = SIX, **further: Any) -> Claim:
        return claim(key, sentence, where, {"variant": kind}, {"variant": rival}, **further)

    four_to_six = partial(
        claim, where=KNN | size, first={"group": "four"}, second={"group": "six"}, readings=(*scalings, *sizes)
    )
    one_or_many = (*BEFORE_SPLIT, MANY)
    five_in_each = (*scalings, *(reading(name, where={"variant": five} | TRAINED) for name, five in MIXED))
    return [
        claim("knn_best", "kNN is the best classifier.", EVERY | size, {"classifier": "knn"},
              {"classifier": highest_of()}, readings=(*scalings, *sizes, COPIES)),
        claim("knn_best_four", "kNN is the best classifier with four objects, too.", RIGHT | {"group": "four"} | size,
              {"classifier": "knn"}, {"classifier": highest_of()}, readings=(*scalings, *sizes)),
        claim("knn_best_selected", "kNN is the best classifier of the selected imprints, too.",
              EVERY | {"variant": "selected"}, {"classifier": "knn"}, {"classifier": highest_of()}, readings=scalings),
        claim("svm_competes", "The SVM competes with kNN: it is at most 14 points worse.",
              EVERY | {"variant": "selected"}, {"classifier": "svm"}, {"classifier": "knn"}, margin=14.0,
              readings=scalings),
        claim("network_poor", "The small network does worse than kNN, having few imprints to learn from.",
              EVERY | size, {"classifier": "knn"}, {"classifier": "deep_learning"},
              readings=(*scalings, *sizes, COPIES)),
        four_to_six("four_easier", "Four objects are easier than six."),
        four_to_six("four_easier_beyond_chance", statistic="beyond_chance",
                    sentence="Four objects are easier than six, even beyond chance.", of=f"four_easier{end}",
                    note="guessing scaled to 0 and certainty to 100"),
        variant("selection_helps", "Removing imprints that other objects have enhances recognition.", "selected",
                readings=(*scalings, AS_MANY, FIFTEEN_SELECTED)),
        variant("selection_over_control", "Removing imprints that other objects have is better than as many at random.",
                "selected", "selected_control", SIX | TRAINED, section="ours", readings=OURS[2]),
        claim("selection_helps_all", "Selection enhances recognition by all classifiers.",
              EVERY, {"variant": "selected"}, PLAIN, note=ALL,
              readings=(NO_SVM, *scalings, RATES, FIFTEEN_SELECTED_ALL, AS_MANY_ALL, *EACH_ALONE)),
        variant("selection_helps_four", "Selection enhances recognition with four objects, too.", "selected",
                where=FOUR, readings=(*scalings, FIFTEEN_SELECTED)),
        variant("selection_helps_train", "Selection enhances recognition where the test part is whole.",
                "selected_train", where=SIX | TRAINED, of=f"selection_helps{end}", readings=(FIFTEEN_TRAIN,)),
        variant("selection_train_over_control", "Where the test part is whole, selection is better than as many "
                "imprints removed at random.", "selected_train", "selected_train_control", SIX | TRAINED,
                section="ours"),
        variant("locations_help", "Adding the position of the touch enhances recognition.", "locations",
                readings=scalings),
        variant("locations_help_side", "Adding the position enhances recognition on a side not touched before.",
                "locations", "plain_side", APART | TRAINED, of=f"locations_help{end}"),
        variant("locations_help_turned", "Adding the position still helps when the objects have been turned.",
                "locations_turned", where=SIX | TRAINED, section="ours"),
        variant("more_touches", "Five touches joined into one sample are better than one.", "touches_5", "locations",
                readings=(ONE_MAPPED, *scalings, *one_or_many)),
        variant("more_touches_svm", "Five joined touches are better than one for the SVM.", "touches_5", "locations",
                SIX | {"classifier": "svm"}, readings=(ONE_MAPPED, *scalings, *one_or_many)),
        variant("more_touches_all", "Five joined touches are better than one over all classifiers.",
                "touches_5", "locations", EVERY, note=ALL,
                readings=(NO_SVM, ONE_MAPPED, *scalings, *one_or_many, *JOINED)),
        variant("more_touches_bayes", "Five joined touches are better than one for naive Bayes.",
                "touches_5", "locations", SIX | {"classifier": "naive_bayes"}, readings=(ONE_MAPPED, *one_or_many)),
        variant("more_touches_many", "Five joined touches are better than one with many combinations to train on.",
                "touches_5_many", "touches_1_many", SIX | TRAINED, of=f"more_touches{end}"),
        claim("certain_at_five", "Recognition by kNN is near certain with five touches.",
              SIX | {"variant": "touches_5"}, {}, 0.95,  # "up to 100 % accuracy"
              readings=five_in_each),
        claim("certain_at_five_svm", "Recognition by the SVM is near certain with five touches.",
              SIX | {"classifier": "svm", "variant": "touches_5"}, {}, 0.95,
              readings=(*five_in_each, *(reading(f"all data from 0 to 1, {name}",
                                                 where={"variant": five, "scaling": "min_max"})
                                         for name, five in MIXED))),
        variant("mixed_flatters", "Combinations drawn before the split flatter.", "touches_5_mixed", "touches_5",
                SIX | TRAINED, section="ours"),
        variant("network_dips", "The network does worse with five touches than with three.", "touches_3", "touches_5",
                NETWORK, readings=scalings),
        variant("network_dips_disjoint", "The network does worse with five touches where samples get fewer.",
                "touches_3_disjoint", "touches_5_disjoint", NETWORK | TRAINED, readings=(MORE_THAN_KNN,),
                of=f"network_dips{end}"),
    ]  # fmt: skip


printed = partial(Claim, section="T4.2.4", stage=STAGE, phrases=PHRASES, **SETS)
CLAIMS = [
    by_points("equal_over_itti", "Touch guided by the thesis's attention is better than by the classical one."),
    by_points("itti_over_blind", "Touch guided by the classical model is better than blind touch."),
    by_points("equal_over_blind", "Touch guided by the thesis's attention is better than blind touch."),
    by_points("equal_over_blind", "The thesis's attention beats blind touch where each object has 60 imprints.", "_60",
              of="equal_over_blind"),
    by_points("equal_over_blind", "The thesis's attention beats blind touch with four objects too.", "_four"),
    *(
        by_points(f"equal_over_{rival}", f"The thesis's attention beats {words} with four objects too.", "_four")
        for rival, words in (("itti", "the classical one"), ("heat_kernel", "heat kernel signatures"),
                             ("salient_points", "salient points"), ("mesh_saliency", "mesh saliency"))
    ),
    by_points("equal_over_blind", "The thesis's attention beats blind touch over all classifiers.", "_all"),
    by_points("equal_over_blind", "The thesis's attention beats blind touch where no training touch overlaps.",
              "_apart", of="equal_over_blind"),
    by_points("equal_over_heat_kernel",
              "Touch guided by the thesis's attention is better than by heat kernel signatures."),
    by_points("equal_over_salient_points", "Touch guided by the thesis's attention is better than by salient points."),
    by_points("equal_over_mesh_saliency", "Touch guided by the thesis's attention is better than by mesh saliency."),
    by_points("equal_over_itti",
              "Touch guided by the thesis's attention is better than by the classical one, on new regions.", "_apart",
              of="equal_over_itti"),
    by_points("itti_over_blind",
              "Touch guided by the classical model is better than blind touch, on new regions.", "_apart",
              of="itti_over_blind"),
    by_points("glance_over_blind", "Touch guided by our glance is better than blind touch."),
    by_points("glance_over_blind", "Touch guided by our glance beats blind touch, on new regions.", "_apart"),
    by_points("glance_over_best_touch", "Touch guided by our glance is better than at the best rival's points."),
    by_points("glance_over_best_touch", "Touch guided by our glance is better than at the best rival's points, on new "
              "regions.", "_apart"),
    by_points("touch_over_best_touch", "Touch where imprints recur is better than at the best rival's points."),
    by_points("touch_over_best_touch", "Touch where imprints recur is better than at the best rival's points, on the "
              "mean of these three collections.", "_mean", of="touch_over_best_touch"),
    by_points("touch_over_best_touch", "Touch where imprints recur is better than at the best rival's points, on new "
              "regions.", "_apart"),
    by_points("touch_over_glance", "Touch where imprints recur is better than at the places of our glance."),
    by_points("glance_over_blind", "Touch guided by our glance beats blind touch in our protocol.", "_ours"),
    by_points("glance_over_blind", "Touch guided by our glance beats blind touch in our protocol, on new regions.",
              "_apart_ours"),
    by_points("glance_over_ssim", "Touch guided by our glance is better than by the thesis's SSIM weights.", "_ours"),
    by_points("ssim_over_blind", "Touch guided by the thesis's SSIM weights is better than blind touch.", "_ours"),
    *(
        printed(key=f"dissimilar_{rival}", sentence=f"The thesis's attention gives {words}.", within=("item",),
                first={"method": others}, second={"method": EQUAL}, unit="points of the share",
                where={"group": "six", "metric": "similar_share"} | FEW,
                readings=(reading(SIXTY[0].name, where=PLAIN),))
        for rival, others, words in (
            ("itti", "itti", "fewer imprints that others have than the classical model"),
            ("random", BLIND, "fewer imprints that others have than blind touch"),
            ("best", lowest_of("itti", "heat_kernel", "mesh_saliency", "salient_points"),
             "the most dissimilar imprints of all methods"),
        )
    ),
    printed(key="dissimilar_accurate", phrases=PHRASES | OF_RANKS, statistic="unlike_more_accurate", scale=1.0,
            sentence="The more dissimilar the imprints of a method, the more accurate is the recognition.",
            where={"group": "six", "method": tuple(METHODS.values())} | FEW, first={"metric": "similar_share"},
            second=KNN | SCALE, unit="rank correlation", note="minus the rank correlation of both over the methods",
            readings=(*(reading(scaled.name, second=scaled.changes["where"]) for scaled in SCALED),
                      reading(SIXTY[0].name, where=PLAIN))),
    printed(key="locations_best", first={"method": EQUAL},
            sentence="With the position of the touch, the thesis's attention is the most accurate.",
            second={"method": highest_of("random", "itti", "heat_kernel", "mesh_saliency", "salient_points")},
            where=SIX | TRAINED | {"variant": "locations"}),  # other scalings have no rows of the rivals
    printed(key="locations_knn_best", sentence="With the position of the touch, kNN is the most accurate.",
            first={"classifier": "knn"}, second={"classifier": highest_of()}, readings=SCALED,
            where=EVERY | SCALE | {"variant": "locations", "method": EQUAL}),
    printed(key="alike_harder", sentence="The similarity between objects degrades the performance.",
            phrases=PHRASES | OF_FOUR, first={"group": "four"}, second={"group": "four_drawn"},
            where=KNN | SCALE | {"method": EQUAL} | FEW,
            readings=(*SCALED, *SIXTY, reading("mean of all classifiers but the SVM", where={"classifier": ALIVE}))),
    *(
        printed(key=key, sentence=sentence, first={"classifier": first}, second={"classifier": second},
                where=RIGHT | SCALE | {"method": EQUAL} | where, contrast=contrast, readings=readings)
        for key, sentence, first, second, where, contrast, readings in (
            ("knn_best_selected_four", "kNN is the best classifier of the selected imprints of four objects, too.",
             "knn", highest_of(), {"group": "four", "variant": "selected"}, None, SCALED),
            ("network_poor_svm", "The small network does worse than the SVM, too.", "svm", "deep_learning",
             {"group": "six"} | FEW, None, (*SCALED, *SIXTY)),
            ("network_catches_up", "The small network lacks data: with more imprints it falls behind kNN less.",
             "knn", "deep_learning", {"group": "six"}, (FEW, PLAIN), SCALED),
        )
    ),
    *at(EQUAL, section="T4.2.4", **SETS),
    *at(MODEL, "_ours", section="ours"),
]  # fmt: skip


COUNTS = (1, 2, 5)  # touches; with the five kinds of features as many as there are colours
KINDS = {
    "plain": "41 features", "pixels": "pixels", "wavelet_features": "36 wavelet features",
    "image_features": "5 image features", "locations": "41 features and position",
    **{f"touches_{count}": f"{count} touch{'es' if count > 1 else ''}, map and position" for count in COUNTS},
}  # fmt: skip
MADE_OF = {"locations": "plain", **{f"touches_{count}": "plain" for count in COUNTS}}  # whose features they take


def by_classifier(results: Results) -> Figure:
    """Accuracy against the seconds to fit and ask a classifier; the reference is the thesis's best, blind."""
    by, title = ["classifier", "method"], f"Recognising {results.group_text('six')} by one touch"
    frame = _timed(results, by, variant="plain", method=[*METHODS.values(), SSIM, MODEL])
    return _chart(results, frame, title, by, f"{label('knn')}, {label('random')}", colour="classifier", marker="method")


def by_features(results: Results) -> Figure:
    """Accuracy against seconds over features, classifiers and the number of touches."""
    frame = _timed(results, ["variant", "classifier"], method=MODEL, variant=list(KINDS))
    making = results.measured(STAGE, group="six", method=MODEL, metric="features").groupby("variant")["seconds"].mean()
    frame["seconds"] += frame["variant"].replace(MADE_OF).map(making).fillna(0.0)  # the mean of several random sets
    frame["samples"] = frame["variant"].map(KINDS)
    title = f"Recognising {results.group_text('six')} by one touch and more"
    by = ["classifier", "samples"]
    return _chart(results, frame, title, by, "kNN, 41 features", colour="samples", marker="classifier")


def by_saliency(results: Results) -> Figure:
    """The worth of a second spent on saliency to the touch that follows."""
    frame = _timed(results, ["method"], classifier="knn", variant="plain")
    frame["seconds"] = frame["method"].map(attention_seconds(results))
    title = f"Looking before touching: {results.group_text('six')}, kNN"
    return _chart(results, frame, title, ["method"], label(MODEL))


def _timed(results: Results, by: list[str], **where: Any) -> pd.DataFrame:
    """Mean accuracies on touches of six objects drawn at random, and their seconds."""
    where |= {"metric": "accuracy", "split": Split.RANDOM, "group": "six", "scaling": TRAINING}
    rows = results.measured(STAGE, **where)
    return pd.DataFrame(means(rows, by, shared_by(Split.RANDOM), top=1.0))


def _chart(results: Results, frame: pd.DataFrame, title: str, named: list[str], reference: str, **style: Any) -> Figure:
    """named: columns that make up the name of a choice."""
    frame = frame.assign(name=frame[named].map(label).agg(", ".join, axis=1)).dropna(subset=["seconds"])
    return pareto_chart(frame, "mean", title=title, reference=reference, quality_label="hold-out accuracy",
                        clock=results.clock(STAGE),
                        legends={"method": "touched by", "samples": "a sample"}, **style)  # fmt: skip
