"""Claims of chapter 3: what keeping the salient points does to a simplified mesh."""

from contextlib import suppress

import pandas as pd

from stages.report.results import NotRun
from stages.report.verdict import Claim, paired

RIVALS = ["hks", "salient_points", "mesh_saliency", "sift", "harris", "sd_corners"]  # T2.2.3's detectors
COMBINATIONS = ["itti", "VisAttCurv", "VisAttSym", "VisAttCurvSym", "VisAttCurvSymCon", "VisAttEnt", "VisAttAll"]
CELL = ["object", "target"]
PERCENT = "% of the error"


def higher_error(worse, better, metric):
    """differences(results): how much larger the error of `worse` is, in per cent of the two errors' mean, an object.

    Targets weigh the same whatever the size of their errors; two errors of zero are equal.
    """

    def differences(results):
        sides = {"first": {"method": worse}, "second": {"method": better}}
        gap = paired(results, "lod", CELL, **sides, metric=metric)
        errors = results.measurements("lod", metric=metric, method=[worse, better])
        size = errors.groupby(CELL)["value"].mean().reindex(gap.index)
        return (100 * gap / size.where(size > 0, 1.0)).groupby("object").mean()

    return differences


def rivals_higher_error(rivals, better, metric):
    """As higher_error, averaged over those of the rivals that were run, over the objects that all of them reach."""

    def differences(results):
        found = []
        for rival in rivals:
            with suppress(NotRun):
                found.append(higher_error(rival, better, metric)(results))
        if not found:
            raise NotRun(f"no lod rows of {better} beside one of {', '.join(rivals)}", "lod", runnable=False)
        return pd.concat(found, axis=1, join="inner").mean(axis=1)

    return differences


def coarse_minus_fine(results):
    """Error at the fewest faces minus error at the most, of the enhanced method, in per cent of the diagonal."""
    rows = results.measurements("lod", metric="metro_mean", method="enhanced").sort_values("faces")
    per_object = rows.dropna(subset="value").groupby("object")["value"]
    return 100 * (per_object.first() - per_object.last())


def lod_claim(key, section, sentence, worse, better, metric):
    """A claim that the method `better` has the lower error of the two."""
    what = {"metro_mean": "Metro mean error", "ssim_error": "SSIM error"}[metric]
    tested = f"{what}, {worse} minus {better}, mean over the face counts"
    return Claim(key, section, sentence, tested, PERCENT, "objects", higher_error(worse, better, metric))


CLAIMS = [
    lod_claim(
        "keep_metro", "T3.1", "Keeping what draws the eye gives a better simplified model than plain QEM (distance).",
        "qem", "enhanced", "metro_mean",
    ),
    lod_claim(
        "keep_ssim", "T3.1", "Keeping what draws the eye gives a better simplified model than plain QEM (as seen).",
        "qem", "enhanced", "ssim_error",
    ),
    lod_claim(
        "blind_metro", "T3.1.5", "Attention places the kept points better than chance does (distance).",
        "random", "enhanced", "metro_mean",
    ),
    lod_claim(
        "blind_ssim", "T3.1.5", "Attention places the kept points better than chance does (as seen).",
        "random", "enhanced", "ssim_error",
    ),
    Claim(
        "rivals_metro", "T3.2.9.1", "Attention distorts less than the detectors of the literature do.",
        "Metro mean error, mean of the literature's detectors minus enhanced", PERCENT, "objects",
        rivals_higher_error(RIVALS, "enhanced", "metro_mean"),
    ),
    Claim(
        "more_faces", "T3.1.5", "The error falls with more faces.",
        "Metro mean error at the fewest faces minus at the most, enhanced", "% of the diagonal", "objects",
        coarse_minus_fine,
    ),
    Claim(
        "contrast", "T3.1.5", "Adding contrast (VisAttCon) gives the best quality of the combinations of channels.",
        "Metro mean error, mean of the other combinations minus VisAttCon", PERCENT, "objects",
        rivals_higher_error(COMBINATIONS, "VisAttCon", "metro_mean"),
    ),
    lod_claim(
        "curvature_ssim", "T3.1.5", "Curvature in the map is slightly better as seen (VisAttCurv).",
        "itti", "VisAttCurv", "ssim_error",
    ),
    lod_claim(
        "entropy", "T3.1.5", "Entropy makes the error higher on objects without texture (VisAttEnt).",
        "VisAttEnt", "itti", "metro_mean",
    ),
    lod_claim(
        "all_channels", "T3.1.5", "All channels with equal weights are slightly worse (VisAttAll).",
        "VisAttAll", "itti", "metro_mean",
    ),
    lod_claim(
        "learned_weights", "T3.2.9.2", "Weights learned from ground truth beat equal weights.",
        "VisAttAll", "enhanced", "ssim_error",
    ),
]  # fmt: skip
