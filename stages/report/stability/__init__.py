"""The stability of methods: the perturbation and severity at which each breaks; and the time of each kernel.

The claims are on a denoising autoencoder before recognition by touch (T6.3).
"""

from haptic_glance.know.split import Split
from stages.report.claims import Claim

from . import breaking, costs, touch

TABLES = {"stability": breaking.points_table, "touch_stability": touch.table}
FIGURES = {"stability": breaking.points_figure, "touch_stability": touch.figure, "kernels": costs.kernels}
CHARTS = {}

PLAIN, LEARNED, FILTERED = (f"{touch.PLAIN}{denoiser}" for denoiser in ("", "_autoencoder", "_median"))
FAULTS = {"noise": "noise", "dead_cells": "dead cells", "blur": "blur"}
DENOISING = [  # (perturbation, what the autoencoder is held against, what is claimed)
    *((fault, PLAIN, f"A denoising autoencoder makes recognition by touch more accurate under {words}.")
      for fault, words in FAULTS.items()),
    *((fault, FILTERED, f"Under {words} a denoising autoencoder is better than a median filter.")
      for fault, words in FAULTS.items()),
    ("none", PLAIN, "On touches without noise a denoising autoencoder does no harm."),
]  # fmt: skip
OF_TOUCHES = {
    ("features", PLAIN): "touches as they are", ("features", LEARNED): "after the autoencoder",
    ("features", FILTERED): "after the median filter",
    **{("perturbation", fault): words for fault, words in FAULTS.items()},
    ("perturbation", "none"): "undisturbed touches",
}  # fmt: skip
CLAIMS = [
    *(
        Claim(key=f"autoencoder_over_{'none' if second == PLAIN else 'median'}_{fault}", sentence=sentence,
              section="T6.3" if second == PLAIN else "ours", stage=touch.STAGE,
              dataset=(touch.DENOISED, "princeton_denoised", "furniture_denoised"), printed=0,
              first={"features": LEARNED}, second={"features": second}, within=("severity",), phrases=OF_TOUCHES,
              where={"perturbation": fault, "split": Split.RANDOM, "classifier": "knn", "metric": "accuracy"})
        for fault, second, sentence in DENOISING
    ),
]  # fmt: skip
