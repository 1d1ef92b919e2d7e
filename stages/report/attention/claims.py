"""Claims of chapter 3 on where people look: weights, SVMs and models against human gaze."""

from functools import partial

from stages.bench import PER_OBJECT
from stages.kit.breaking_point import BROKEN
from stages.report.claims import POINTS, Claim, Pick, highest_of, reading
from stages.report.results import COLOURED, GAZED, MENDED_3_2, ON_BLACK, SECTION_3_2

from .rows import ANY_POSE, CLASSICAL, NO_RIVALS, OURS, SAME

BEST_RIVAL = highest_of(but=(*NO_RIVALS, *SAME, *PER_OBJECT, "*_seen"))
ONE_HUE = 0.98  # the least correlation of DKL with intensity on four household objects, each in one colour of a palette
PHRASES = {
    ("method", OURS): "our glance", ("method", ANY_POSE): "our glance in any pose",
    ("method", "VisAttAll"): "VisAttAll", ("method", "equal"): "equal weights",
    ("metric", "weight"): "weights", ("method", "guided_ssim"): "",
    ("views", "best"): "four to eight best viewpoints", ("views", "four"): "four around the object",
    ("views", "twelve"): "twelve",
    ("metric", "repeatability"): "points found again", ("perturbation", "clay"): "with the colours taken away",
    ("metric", "intensity_likeness"): "",
    ("area", "image"): "random pixels of the whole image", ("area", "object"): "the object's pixels",
    ("training", "one_per_object"): "an object's own SVM", ("training", "one_for_all"): "the one for all",
    ("validation", "pixels"): "", ("validation", "views"): "on whole views left out",
    ("validation", "objects"): "on whole objects left out",
}  # fmt: skip
on_gaze = partial(Claim, dataset="gaze", over=("item",), phrases=PHRASES)


def closer_to_gaze(key: str, section: str, sentence: str, first: str, second: str | Pick) -> Claim:
    """A claim that the NSS of one method is higher than that of another."""
    return on_gaze(key=key, section=section, sentence=sentence, stage="salient_points", where={"metric": "nss"},
                   first={"method": first}, second={"method": second}, dataset=GAZED, scale=1,
                   unit="NSS")  # fmt: skip


def svm_per_object(key: str, sentence: str, area: str, own: str, others: str) -> Claim:
    """A claim that an object's own SVM is more accurate than the one for all; own, others: how each was validated."""
    return on_gaze(key=key, section="T3.2.3", sentence=sentence, stage="weights", unit=POINTS, mean_of="second",
                   where={"metric": "accuracy", "area": area}, dataset=GAZED,
                   first={"training": "one_per_object", "validation": own},
                   second={"training": "one_for_all", "validation": others})  # fmt: skip


def in_colour(key: str, sentence: str, method: str) -> Claim:
    """A claim that a method finds half of its points or more again on the same object in grey clay."""
    return Claim(key=key, section="T3.1.5", sentence=sentence, stage="stability", dataset=COLOURED, over=("item",),
                 where={"metric": "repeatability", "perturbation": "clay"}, first={"method": method}, second=BROKEN,
                 unit="points of the share found again", phrases=PHRASES)  # fmt: skip


CLAIMS = [
    closer_to_gaze("equal_over_itti_gaze", "T3.2.2", "All channels with equal weights (VisAttAll) beat the classical "
                   "model.", "VisAttAll", CLASSICAL),
    closer_to_gaze("guided_ed_gaze", "T3.2.2", "Weights learned by Euclidean distance predict attention better than "
                   "equal ones.", "guided_ed", "equal"),
    closer_to_gaze("guided_ssim_gaze", "T3.2.2", "Weights learned by similarity predict attention better than equal "
                   "ones.", "guided_ssim", "equal"),
    closer_to_gaze("svm_gaze", "T3.2.3", "An SVM on the channels predicts attention better than equal weights.",
                   "svm", "equal"),
    *(on_gaze(key=f"background_{key}", section="ours", stage="salient_points", scale=1, unit="NSS",
              sentence=f"Where the background is kept out of the filters, maps are closer to gaze ({name}).",
              where={"metric": "nss", "method": method}, first={"dataset": "gaze"}, second={"dataset": ON_BLACK})
      for key, name, method in (("classical", "VisAtt", CLASSICAL), ("all", "VisAttAll", "VisAttAll"),
                                ("ssim", "weights of table 3.1", "thesis_ssim"))),
    Claim(key="colour_parts_dkl", section="T3.1.5", stage="conspicuity",
          sentence="Even where objects have several hues, DKL is as close to intensity as in one hue.",
          dataset=COLOURED, over=("item",), where={"metric": "intensity_likeness"},
          first={"method": "dkl"}, second=ONE_HUE, scale=1, unit="correlation with intensity", phrases=PHRASES),
    *(in_colour(f"colour_{key}", f"Half of the points or more are found again without the colours ({name}).", method)
      for key, name, method in (("classical", "VisAtt", CLASSICAL), ("all", "VisAttAll", "VisAttAll"))),
    on_gaze(key="colour_least_ssim", section="T3.2.9", stage="weights", scale=1, unit="SSIM", dataset=SECTION_3_2,
            sentence="Colour gets the least weight by similarity where each object has one colour.",
            where={"metric": "weight", "method": "guided_ssim"}, first={"channel": "color"}, statistic="least_weight",
            note="the lowest weight of the other channels minus that of colour",
            readings=(reading("formulas mended", dataset=MENDED_3_2),)),
    svm_per_object("svm_per_object", "One SVM for each object is more accurate than one for all.",
                   "image", "pixels", "pixels"),
    svm_per_object("svm_per_object_unseen", "One SVM for each object is more accurate on what it has not seen, too.",
                   "object", "views", "objects"),
    *(
        on_gaze(key=f"best_over_{fixed}", section="T3.2.4", stage="attention_checks", scale=1, unit="NSS",
                dataset=GAZED,
                sentence=f"The most salient of 62 viewpoints show where people look better than {said} do.",
                where={"method": "equal", "metric": "nss"},
                first={"views": "best"}, second={"views": fixed})
        for fixed, said in (("four", "four fixed ones"), ("twelve", "the twelve of T figure 3.2"))
    ),
    on_gaze(key="gaze_choices_flatter_glance", section="ours", stage="attention_checks", scale=1, unit="NSS",
            sentence="Features and ridge that were chosen on the judged objects flatter the glance.",
            where={"metric": "nss"}, first={"method": "glance_once"}, second={"method": "glance_nested"}),
    closer_to_gaze("glance_over_best_gaze", "ours", "Our glance predicts where people look better than its best rival.",
                   OURS, BEST_RIVAL),
    closer_to_gaze("any_pose_over_best_gaze", "ours", "Our glance without an up axis predicts where people look better "
                   "than the best rival of the glance.", ANY_POSE, BEST_RIVAL),
]  # fmt: skip
