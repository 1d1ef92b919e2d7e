"""Agreement of attention models with human gaze and with marks: claims (T3.1.5, T3.2) and tables.

`agreement` has one row per method and metric, over the objects that have ground truth. The claims compare weights, SVMs
and models on human gaze. The tables (gaze on meshes, gaze on point clouds, marks) state the findings in words. The
learned methods of the gaze tables leave out the judged object; only methods with a star have seen it.
"""

from collections.abc import Iterator, Sequence
from contextlib import suppress
from functools import partial
from typing import Any

import pandas as pd

from stages.bench import PER_OBJECT, has_seen
from stages.charts.datasets import COLOURED, GAZED, GREY_3_1, MENDED_3_2, SECTION_3_2
from stages.charts.drawing import label
from stages.charts.items import Table, shared_notes
from stages.charts.pareto import attention_seconds
from stages.charts.results import NotRun, Results, require_rows
from stages.charts.tables import Ranking, interval_columns, number, records, signed, with_interval
from stages.engine.statistics import BROKEN, interval
from stages.report.claims import POINTS, Claim, highest_of, in_sums, lowest_of, reading

OURS, ANY_POSE, HUMAN = "glance", "glance_any_pose", "human"
CLASSICAL, THESIS = "itti", "VisAttAll"
NO_RIVALS = (OURS, ANY_POSE, HUMAN)  # our models, and the ceiling
SAME = ("VisAtt",)  # the classical model under the thesis's name
NAMES = {"random": "random points", "svm": "thesis, SVM"}  # elsewhere blind touch, and a classifier
ALONE = {"nss": "NSS", "auc": "AUC"}  # shown with their interval, and in which ours is compared with each other method
MEAN, GAIN = ["mean", "low", "high"], ["gain", "gain_low", "gain_high"]  # columns: of a method, and over another


def method_text(method: str) -> str:
    """A method's name as a person says it, with a star where it has seen the object."""
    name = NAMES.get(method) or label(method)
    return f"{name} *" if has_seen(method) else name


def scores(rows: pd.DataFrame, metric: str) -> pd.DataFrame:
    """Frame objects x methods of one metric; NotRun where it was not measured."""
    values = rows[rows["metric"] == metric].dropna(subset=["value"])
    require_rows(values, f"no {metric}: no object has ground truth", "salient_points", runnable=False)
    return values[~values["method"].isin(SAME)].pivot_table(index="item", columns="method", values="value", sort=False)


def difference(rows: pd.DataFrame, metric: str, first: str, second: str) -> pd.Series:
    """First minus second, an object; NotRun where either was not judged."""
    table = scores(rows, metric)
    missing = [method for method in (first, second) if method not in table]
    if missing:
        raise NotRun(f"{' and '.join(missing)} not judged on objects with ground truth", "salient_points", False)
    return pd.Series(table[first] - table[second])


def rivals(rows: pd.DataFrame, metric: str) -> list[str]:
    """The methods that ours are to beat, best first: all but these, the ceiling, and those that peeked."""
    means = scores(rows, metric).mean().sort_values(ascending=False)
    return [method for method in map(str, means.index) if method not in NO_RIVALS and not has_seen(method)]


def gain(table: pd.DataFrame, first: str, second: str) -> dict[str, float]:
    """GAIN of one method over another, paired over the objects of `scores`; {} where either is absent."""
    if first == second or first not in table or second not in table:
        return {}
    return interval_columns("gain", interval(table[first] - table[second]))


def agreement(rows: pd.DataFrame, metrics: Sequence[str]) -> pd.DataFrame:
    """Tidy frame: method, has_seen, metric, objects, MEAN and, for ALONE, GAIN: of ours over the method.

    95 % intervals over the objects. In order of NSS, the human ceiling first.
    """
    tables, lines = {metric: scores(rows, metric) for metric in metrics}, []
    order = map(str, tables["nss"].mean().sort_values(ascending=False).index)
    for method in sorted(order, key=lambda name: name != HUMAN):
        for metric, table in tables.items():
            if method in table:
                line = {"method": method, "has_seen": has_seen(method), "metric": metric}
                line["objects"] = table[method].count()
                line |= interval_columns("mean", interval(table[method]), prefix="")
                lines.append(line | (gain(table, OURS, method) if metric in ALONE and method != HUMAN else {}))
    return pd.DataFrame(lines)


NO_RIVAL = (*NO_RIVALS, *SAME, *PER_OBJECT, "*_seen")
BEST_RIVAL = highest_of(but=NO_RIVAL)
OTHER_METRICS = (
    *(reading(metric.upper(), where={"metric": metric}) for metric in ("auc", "cc", "sim")),
    reading("KL", where={"metric": "kl"}, second={"method": lowest_of(but=NO_RIVAL)}, scale=-1.0),
)
COUNTED = "points_strong"
ONE_HUE = 0.98  # the least correlation of DKL with intensity on four household objects, each in one colour of a palette
PHRASES = {
    ("method", OURS): "our glance", ("method", ANY_POSE): "our glance in any pose",
    ("method", "VisAttAll"): "VisAttAll", ("method", "equal"): "equal weights",
    ("metric", "weight"): "weights", ("metric", "information_gain"): "information gain",
    ("metric", "extremes"): "largest over mean distance from the centre of mass",
    ("metric", "distances_deviation"): "deviation of the distances from the centre of mass",
    ("channel", "symmetry"): "of symmetry", ("metric", COUNTED): "points found",
    ("views", "best"): "four to eight best viewpoints", ("views", "four"): "four around the object",
    ("views", "twelve"): "twelve",
    ("metric", "repeatability"): "points found again", ("perturbation", "clay"): "with the colours taken away",
    ("metric", "intensity_likeness"): "",
    ("area", "image"): "random pixels of the whole image", ("area", "object"): "the object's pixels",
    ("training", "one_per_object"): "an object's own SVM", ("training", "one_for_all"): "the one for all",
    ("validation", "pixels"): "", ("validation", "views"): "on whole views left out",
    ("validation", "objects"): "on whole objects left out",
}  # fmt: skip
MARKED = "household"  # the data set whose marks come with the project
OF_3_2 = (SECTION_3_2, "gaze_clouds")  # the printed protocol first; elsewhere a method has not seen the object
UNSEEN = {"guided_ed_seen": "guided_ed", "guided_ssim_seen": "guided_ssim", "svm_object": "svm"}
MENDED = reading("formulas mended", dataset=(MENDED_3_2, OF_3_2[1]))
CHANNELS = (("classical", "VisAtt", CLASSICAL), ("all", "VisAttAll", "VisAttAll"))  # key, name, method
about = partial(Claim, section="ours", over=("item",), phrases=PHRASES)
closer = partial(about, stage="salient_points", where={"metric": "nss"}, dataset=GAZED, scale=1, unit="NSS")
colour = partial(about, dataset=COLOURED)
learned = partial(about, stage="weights", dataset=OF_3_2)
GAIN_OF_PICTURE = {"metric": "information_gain", "area": "image"}
ON_OBJECT = {"area": "object"}
MENDED_GAIN = reading("formulas mended", dataset=(MENDED_3_2, MARKED))


def by_gain(key: str, sentence: str, section: str = "T3.2.3", **more: Any) -> Claim:
    """A claim on the information gain of channels about the pixels of an object, by gaze and by marks."""
    options: dict[str, Any] = {"scale": 1, "unit": "rank correlation"} | more
    return learned(key=key, section=section, sentence=sentence, dataset=(SECTION_3_2, MARKED), **options)


def learned_to_gaze(key: str, section: str, first: str, sentence: str) -> Claim:
    """A claim that a method of T3.2 that has learned from the truth has a higher NSS than equal weights.

    As printed, it has learned from the gaze that judges it, too; readings ask for one that has not.
    """
    unseen: dict[str, Any] = {"first": {"method": UNSEEN[first]}, "note": ""}
    readings = [
        MENDED, reading("learned from other objects", **unseen),
        reading("nine channels with equal weights", second={"method": "equal"}),
        reading("our formulas, learned from other objects", **unseen, dataset=GAZED),
    ]  # fmt: skip
    return closer(key=key, section=section, sentence=sentence, first={"method": first}, second={"method": "VisAttAll"},
                  dataset=OF_3_2, elsewhere=UNSEEN, readings=tuple(readings),
                  note="learned from the gaze that judges it, too, as in the thesis")  # fmt: skip


CLAIMS = [
    Claim(
        key="four_views_cover", section="T4.2.1", stage="views", dataset=(None, "gaze", "furniture", "princeton"),
        printed=0,
        sentence="Four perpendicular viewpoints see the whole surface, but for one percent.", over=("item",),
        where={"metric": "seen_share", "views": 4}, first={"method": "principal"}, second=0.99, scale=100.0,
        unit="% of the surface", readings=(reading("four viewpoints around the object", first={"method": "four"}),),
        phrases={("method", "principal"): "four principal viewpoints", ("method", "four"): "four viewpoints around",
                 ("metric", "seen_share"): "share of the surface that any of 62 viewpoints sees"},
    ),
    closer(key="equal_over_itti_gaze", first={"method": "VisAttAll"}, second={"method": CLASSICAL}, dataset=OF_3_2,
           sentence="All channels with equal weights (VisAttAll) predict where people look better than the classical "
                    "model.",
           printed=1, readings=(*in_sums("VisAttAll", CLASSICAL), MENDED, reading("our formulas", dataset=GAZED))),
    closer(key="grey_colour", section="T3.1.1", first={"method": "VisAttAll"}, second={"method": "VisAttAllNoColour"},
           sentence="Although the objects are grey, the colour channels improve the detection of regions of interest.",
           dataset=GREY_3_1, readings=in_sums("VisAttAll", "VisAttAllNoColour")),
    learned_to_gaze("guided_ed_gaze", "T3.2.2", "guided_ed_seen",
                    "Weights learned by Euclidean distance predict attention better than equal ones."),
    learned_to_gaze("guided_ssim_gaze", "T3.2.2", "guided_ssim_seen",
                    "Weights learned by similarity predict attention better than equal ones."),
    learned_to_gaze("svm_gaze", "T3.2.3", "svm_object",
                    "An SVM on the channels predicts attention better than equal weights."),
    closer(key="svm_more_points", section="T3.2.3", dataset=OF_3_2, elsewhere=UNSEEN, where={"metric": COUNTED},
           first={"method": "svm_object"}, second={"method": highest_of("guided_ed_seen", "guided_ssim_seen")},
           sentence="The SVM finds more salient points than the weighted maps do.", unit="points", readings=(MENDED,),
           note="at most 32 of the SVM's, and all of the others"),
    colour(key="colour_parts_dkl", stage="conspicuity", where={"metric": "intensity_likeness"},
           first={"method": "dkl"}, second=ONE_HUE, scale=1, unit="correlation with intensity",
           sentence="Even where objects have several hues, DKL is as close to intensity as in one hue."),
    *(colour(key=f"colour_{key}", stage="stability", where={"metric": "repeatability", "perturbation": "clay"},
             first={"method": method}, second=BROKEN, unit="points of the share found again",
             sentence=f"Half of the points or more are found again without the colours ({name}).",
             readings=(reading("the hues alone taken away", where={"perturbation": "grey"}),))
      for key, name, method in CHANNELS),
    *(learned(key=f"{key}_ssim", section=section, sentence=sentence, dataset=SECTION_3_2, scale=1, unit="SSIM",
              where={"metric": "weight", "method": "guided_ssim"}, first={"channel": channel}, statistic=statistic,
              phrases=PHRASES | {("method", "guided_ssim"): ""}, note=note,
              readings=(reading("formulas mended", dataset=MENDED_3_2),))
      for key, section, channel, statistic, sentence, note in (
          ("colour_least", "T3.2.9", "color", "least_weight",
           "Colour gets the least weight by similarity where each object has one colour.",
           "the lowest weight of the other channels minus that of colour"),
          ("entropy_most", "T3.2.1.4", "entropy", "largest_weight",
           "The entropy map is the most similar to the ground truth.",
           "the weight of entropy minus the largest of the other channels"))),
    *(learned(key=key, section="T3.2.3", unit=POINTS, mean_of="second", where={"metric": "accuracy", "area": area},
              first={"training": "one_per_object", "validation": alone},
              second={"training": "one_for_all", "validation": joint},
              sentence=f"One SVM for each object is more accurate {words}.", of=of,
              note="each learns from 1,000 pixels, the one for all from few of each object")
      for key, area, alone, joint, words, of in (
          ("svm_per_object", "image", "pixels", "pixels", "than one for all", ""),
          ("svm_per_object_unseen", "object", "views", "objects", "on what it has not seen, too", "svm_per_object"))),
    by_gain(
        "symmetry_gain_varies", "The weight of symmetry by information gain changes a lot from object to object.",
        statistic="varies_more", where=GAIN_OF_PICTURE, first={"channel": "symmetry"}, scale=100,
        unit="% of the mean gain", readings=(reading("pixels of the object alone", where=ON_OBJECT), MENDED_GAIN),
        note="distance of an object's gain from the mean gain, minus the same of the other channels"),
    by_gain(
        "symmetry_gain_extremes",
        "Symmetry contributes less where the extremes of an object deviate less from its centre of mass.",
        statistic="share_rises_with", first=GAIN_OF_PICTURE | {"channel": "symmetry"}, second={"metric": "extremes"},
        note="rank correlation over the objects, of the channel's share in the gain",
        readings=(reading("pixels of the object alone", first=ON_OBJECT), MENDED_GAIN,
                  reading("deviation of all distances", second={"metric": "distances_deviation"}))),
    by_gain(
        "gain_by_convexity", "The contribution of the channels depends on the level of convexity of an object.",
        section="T3.2.9.2", statistic="differs_with", first=GAIN_OF_PICTURE, second={"metric": "convexity"},
        note="rank correlation over pairs of objects: distance of the channels' shares in the gain, and of convexities",
        readings=(reading("pixels of the object alone", first=ON_OBJECT), MENDED_GAIN)),
    closer(key="glance_over_best_gaze", first={"method": OURS}, second={"method": BEST_RIVAL}, readings=OTHER_METRICS,
           sentence="Our glance predicts where people look better than its best rival."),
    closer(key="any_pose_over_best_gaze", first={"method": ANY_POSE}, second={"method": BEST_RIVAL},
           readings=OTHER_METRICS,
           sentence="Our glance without an up axis predicts where people look better than the best rival of the "
                    "glance."),
]  # fmt: skip


MEANS = {
    "cc": "CC", "sim": "SIM", "kl": "KL", COUNTED: "points", "fne@0.05": "FNE", "fpe@0.05": "FPE", "wme@0.05": "WME",
}  # fmt: skip
NAMED = 5  # methods that a sentence names at most
PEEKED = {"guided_ssim": "guided_ssim_seen", "guided_ed": "guided_ed_seen", "svm": "svm_object"}


def against_gaze(results: Results) -> Table:
    """The meshes with human gaze, each left out of the learning."""
    rows = results.rows("salient_points", "gaze")
    return _table(results, rows, list(MEANS), {"count": rows["item"].nunique()})


def against_clouds(results: Results) -> Table:
    """The point clouds with human gaze, each left out of the learning; how their surfaces are made costs apart."""
    rows = results.rows("salient_points", "gaze_clouds")
    return _table(results, rows, list(MEANS), {"count": rows["item"].nunique()})


def against_marks(results: Results) -> Table:
    """The marks on this run's own objects."""
    rows = results.measured("salient_points")
    dataset, count = rows["dataset"].iloc[0], rows.loc[rows["metric"] == "nss", "item"].nunique()
    default = f"The truth is what comes with the data set {dataset}."
    truth = shared_notes(__package__, "marks") if dataset == MARKED else default
    return _table(results, rows, [COUNTED, "fne@0.05", "fpe@0.05"], {"count": count, "truth": truth})


def _table(results: Results, rows: pd.DataFrame, beside: Sequence[str], words: dict) -> Table:
    """The judged rows, with those of MEANS that stand beside NSS and AUC; words: without those that the numbers say.

    The seconds are those from the pictures to the points; of a set without rows of pictures or maps there are none.
    """
    cost: dict[str, float] = {}
    with suppress(NotRun):
        cost = attention_seconds(results, rows["dataset"].iloc[0])
    frame = agreement(rows, [*ALONE, *beside])
    names, lines = list(ALONE.values()), {}
    columns = ["method", *names, *(f"ours − it, {name}" for name in names), *map(MEANS.get, beside)]
    columns += ["seconds"] if cost else []
    for row in records(frame.reindex(columns=frame.columns.union(GAIN))):
        line = lines.setdefault(row.method, dict.fromkeys(columns, "–"))
        line |= {"method": method_text(row.method), "seconds": number(cost[row.method]) if row.method in cost else "–"}
        if row.metric in ALONE:
            line[ALONE[row.metric]] = with_interval(row.mean, row.low, row.high, places=2)
        elif row.mean == row.mean:
            line[MEANS[row.metric]] = f"{row.mean:.{1 if row.metric == COUNTED else 2}f}"
        if row.gain == row.gain:
            line[f"ours − it, {ALONE[row.metric]}"] = signed(row.gain, row.gain_low, row.gain_high)
    findings = "\n".join([*_ours_and_rivals(rows), *_learned(rows), *_peeking(rows)])
    words = words | {"findings": findings, "reading": shared_notes(__package__, "reading")}
    cells = pd.DataFrame(lines.values())
    truth_and_peeking = [method_text(name) for name in lines if name == HUMAN or has_seen(name)]
    answer = [name for name in columns if name not in MEANS.values() or name == MEANS[COUNTED]]
    return Table(frame, cells, words, Ranking("NSS", exempt=truth_and_peeking), answer)


def _ours_and_rivals(rows: pd.DataFrame) -> Iterator[str]:
    """The place of ours, and the rivals that it does not beat beyond chance."""
    table = scores(rows, "nss")
    if OURS not in table:
        return
    first = f"{label(OURS)}: NSS {with_interval(*interval(table[OURS]), places=2)}"
    if HUMAN in table:
        first += f"; {label(HUMAN)}, spread as smoothly, has {table[HUMAN].mean():.2f}"
    yield f"{first}."
    best = next(iter(rivals(rows, "nss")), None)
    if best is None:
        return
    gains = [f"{name} {signed(*interval(difference(rows, metric, OURS, best)))}" for metric, name in ALONE.items()]
    yield f"The best other method that has not seen the object is {label(best)}: ours − it {_and(gains)}."
    for metric, name in ALONE.items():
        table, methods = scores(rows, metric), rivals(rows, metric)
        left = [label(rival) for rival in methods if not interval(table[OURS] - table[rival])[1] > 0]
        labels = left if len(left) <= NAMED else [*left[:NAMED], f"{len(left) - NAMED} more"]
        yield (
            f"In {name} ours is higher than {len(methods) - len(left)} of the {len(methods)} others that have not seen "
            "the object, with an interval that excludes zero" + (f"; not than {_and(labels)}." if left else ".")
        )


def _learned(rows: pd.DataFrame) -> Iterator[str]:
    """The gain of more channels with equal weights over the classical model, and of learned weights over equal ones."""
    base = "equal" if "equal" in scores(rows, "nss") else THESIS
    for pair in ((THESIS, CLASSICAL), ("equal", CLASSICAL), ("guided_ssim", base), ("guided_ed", base)):
        with suppress(NotRun):
            gains = []
            for metric, name in ALONE.items():
                mean, low, high = interval(difference(rows, metric, *pair))
                word = "higher" if low > 0 else "lower" if high < 0 else "not told apart"
                gains.append(f"{name} {signed(mean, low, high, places=3)} ({word})")
            yield f"{' − '.join(map(label, pair))}: {_and(gains)}."


def _peeking(rows: pd.DataFrame) -> Iterator[str]:
    """The gain of the same method from having seen the object: the leak of the thesis's way of testing."""
    gains = []
    for clean, peeked in PEEKED.items():
        with suppress(NotRun):
            gains.append(f"{label(clean)} {signed(*interval(difference(rows, 'nss', peeked, clean)))}")
    if gains:
        text = "* has seen the object: the method learned from the object's own truth, too. Gain in NSS: "
        yield f"{text}{'; '.join(gains)}."


def _and(parts: list[str]) -> str:
    return " and ".join([", ".join(parts[:-1]), parts[-1]]) if len(parts) > 1 else "".join(parts)
