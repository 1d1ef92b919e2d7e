"""The stability of methods: the perturbation and severity at which each breaks; and the time of each kernel.

The claims are on a denoising autoencoder before recognition by touch (T6.3).
"""

from haptic_glance.know.split import Split
from stages.report.claims import Claim

from . import breaking, costs, touch

TABLES = {"stability": breaking.points_table, "touch_stability": touch.table}
FIGURES = {"stability": breaking.points_figure, "touch_stability": touch.figure, "kernels": costs.kernels}
CHARTS = {}

PLAIN, LEARNED = (f"{touch.PLAIN}{denoiser}" for denoiser in ("", "_autoencoder"))
FAULTS = {"noise": "noise", "dead_cells": "dead cells", "blur": "blur"}
DENOISING = [  # (perturbation, what is claimed)
    *((fault, f"A denoising autoencoder makes recognition by touch more accurate under {words}.")
      for fault, words in FAULTS.items()),
    ("none", "On touches without noise a denoising autoencoder does no harm."),
]  # fmt: skip
OF_TOUCHES = {
    ("features", PLAIN): "touches as they are", ("features", LEARNED): "after the autoencoder",
    **{("perturbation", fault): words for fault, words in FAULTS.items()},
    ("perturbation", "none"): "undisturbed touches",
}  # fmt: skip
CLAIMS = [
    *(
        Claim(key=f"autoencoder_over_none_{fault}", sentence=sentence, section="T6.3", stage=touch.STAGE,
              dataset=touch.DENOISED, printed=0, first={"features": LEARNED}, second={"features": PLAIN},
              within=("severity",), phrases=OF_TOUCHES,
              where={"perturbation": fault, "split": Split.RANDOM, "classifier": "knn", "metric": "accuracy"})
        for fault, sentence in DENOISING
    ),
]  # fmt: skip
