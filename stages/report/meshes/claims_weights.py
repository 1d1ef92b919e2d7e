"""Claims of T3.2.8 and T3.2.9 on simplified meshes: kept points against plain QEM, learned weights, neighbourhoods.

Each is judged on the first data set, those on the error weighted by human gaze on the meshes that have it;
tables/lod_claims has them on every set.
"""

from stages.report.claims import highest_of, lowest_of
from stages.report.style import label

from .differences import ranks_agree
from .groups import (
    ADAPTIVE,
    ALL_COUNTS,
    DIAGONAL,
    ENHANCED,
    FEW_MINUS_MANY,
    HIGH,
    HKS,
    LOW,
    PROPOSED,
    RANKS,
    RIVALS,
    claim,
    lod_claim,
)
from .rows import OURS, PLAIN

WAYS = (
    ("keep", "T3.1, T3.2.8", "Keeping what draws the eye", ENHANCED),
    ("ours_keep", "ours", "Keeping what our model finds", OURS),
    ("ours_soft", "ours", "Weighing by what our model finds, keeping nothing whole,", f"{OURS}-soft"),
)
BETTER = "{} gives a better simplified model than plain QEM ({})."
KEPT = [
    found
    for start, section, who, method in WAYS
    for found in (
        *(
            lod_claim(f"{start}_{short}", section, BETTER.format(who, how), PLAIN, method, metric)
            for short, metric, how in (
                ("metro", "metro_mean", "distance"), ("ssim", "ssim_error", "as seen"),
                ("dlap", "dlap", "Laplacian distance"), ("dnor", "dnor", "normalised Laplacian distance"),
                ("salient", "salient_error", "where our own model looks"),
            )
        ),
        lod_claim(f"{start}_gaze", section, BETTER.format(who, "where people look"), PLAIN, method, "gaze_error",
                  dataset="gaze"),
    )
]  # fmt: skip

BLIND = [
    lod_claim("blind_metro", "T3.1.5", "Attention places the kept points better than chance does (distance).",
              "random", ENHANCED, "metro_mean"),
    lod_claim("blind_ssim", "T3.1.5", "Attention places the kept points better than chance does (as seen).",
              "random", ENHANCED, "ssim_error"),
    lod_claim("ours_blind_ssim", "ours", "Our model of gaze places the kept points better than chance does (as seen).",
              "random", OURS, "ssim_error"),
]  # fmt: skip

WEIGHTS = [  # T3.2.9
    lod_claim("rivals_metro", "T3.2.9.1", "Attention distorts less than the detectors of the literature do.",
              RIVALS, ENHANCED, "metro_mean"),
    lod_claim("proposed_rivals", "T3.2.9.1", "ED, SSIM and SVM have a lower Metro error than the detectors.",
              RIVALS, PROPOSED, "metro_mean"),
    claim(key="rivals_low", section="T3.2.9.1", sentence="More so at low resolution.", where={"metric": "metro_mean"},
          first={"method": RIVALS}, second={"method": PROPOSED}, contrast=FEW_MINUS_MANY, scale=100.0, unit=DIAGONAL),
    *(
        lod_claim(
            f"adaptive_{name}_{short}", section, f"Adaptive neighbourhoods lower the error of {label(name)} ({how}).",
            name, f"{name}-adaptive", metric,
        )
        for section, metric, short, how in (
            ("T3.2.9.1", "metro_mean", "metro", "a little, distance"), ("T3.2.9.2", "ssim_error", "ssim", "as seen"),
        )
        for name in PROPOSED
    ),
    lod_claim(
        "ssim_over_ed", "T3.2.9.1", "Weights by similarity are slightly better than by Euclidean distance (distance).",
        "guided_ed", "guided_ssim", "metro_mean",
    ),
    lod_claim("ssim_over_ed_seen", "T3.2.9.2", "Weights by similarity are better than by Euclidean distance (as seen).",
              "guided_ed", "guided_ssim", "ssim_error"),
    lod_claim("svm_promising", "T3.2.9.1", "The SVM gives the most promising results.",
              lowest_of(*PROPOSED[:2]), "svm", "metro_mean"),
    lod_claim("hks_low", "T3.2.9.1", "Adaptive ED, SSIM and SVM have a slightly lower error than HKS at 1,500 faces.",
              HKS, ADAPTIVE, "metro_mean", LOW),
    lod_claim("hks_high", "T3.2.9.1", "All methods based on attention beat HKS at 3,000 faces.",
              HKS, highest_of(*PROPOSED, *ADAPTIVE), "metro_mean", HIGH),
    claim(key="seen_confirms", section="T3.2.9.2", sentence="The error as seen confirms the Metro error.",
          first={"metric": "metro_mean"}, second={"metric": "ssim_error"}, statistic=ranks_agree.__name__, unit=RANKS,
          note=f"over the methods, {ALL_COUNTS}"),
    lod_claim("hks_seen", "T3.2.9.2", "HKS is better as seen than attention.", PROPOSED, HKS, "ssim_error"),
    lod_claim("ssim_over_all", "T3.2.9.2", "Weights by similarity beat equal weights (VisAttAll) as seen.",
              "VisAttAll", "guided_ssim", "ssim_error"),
    lod_claim("ed_over_all", "T3.2.9.2", "Weights by Euclidean distance beat equal weights (VisAttAll) as seen.",
              "VisAttAll", "guided_ed", "ssim_error"),
    lod_claim("learned_weights", "T3.2.9.2", "Weights learned from ground truth beat equal weights.",
              "VisAttAll", ENHANCED, "ssim_error"),
]  # fmt: skip

CLAIMS = [*KEPT, *BLIND, *WEIGHTS]
