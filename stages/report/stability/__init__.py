"""The stability of methods: the perturbation and severity at which each breaks; and the time of each kernel.

The claims are on a denoising autoencoder before recognition by touch (T6.3), and on the stability of attention.
"""

from functools import partial

from haptic_glance.know.split import Split
from stages.report.claims import Claim, reading
from stages.stability.uses import PLAIN as NOTHING_KEPT

from . import breaking, costs, people, score, simplification, touch
from .score import BENCHMARK, KINDS

TABLES = {
    "stability_score": score.table,
    "stability_breaking": score.breaking,
    "stability_pairs": people.pairs_table,
    "stability": breaking.points_table,
    "stability_people": people.people_table,
    "stability_simplification": simplification.table,
    "touch_stability": touch.table,
    "transfer_stability": breaking.networks_table,
}
FIGURES = {
    "stability": breaking.points_figure,
    "stability_failures": breaking.failures,
    "touch_stability": touch.figure,
    "touch_stability_imprints": touch.build,
    "transfer_stability": breaking.networks_figure,
    "kernels": costs.kernels,
}
CHARTS = {"stability": score.chart}

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
SCORED = tuple(name for names in KINDS.values() for name in names)
MOVES = "noise", "decimation", "remeshing", "missing_faces", "scan", "tilt"  # what moves the points of a glance
SURFACE = reading("the surface alone disturbed", where={"perturbation": MOVES})  # a geometric method sees no light
MORE_STABLE = [  # (key, first method, second, under which perturbations, other readings, what is claimed)
    ("glance_stable_itti", "glance", "itti", SCORED, (SURFACE,),
     "The gaze model finds more of its points again than Itti's attention."),
    ("glance_stable_mesh_saliency", "glance", "mesh_saliency", SCORED, (SURFACE,),
     "The gaze model finds more of its points again than mesh saliency."),
    ("any_pose_stable_tilt", "glance_any_pose", "glance", "tilt", (),
     "Learned from any pose, the gaze model finds more of its points again when tilted."),
]  # fmt: skip
OF_POINTS = {
    ("metric", "repeatability"): "points found again", ("metric", "recognised"): "recognition by touch",
    ("metric", "lod_salient"): "error weighted by saliency", ("perturbation", SCORED): "all disturbances",
    ("perturbation", MOVES): "noise, other triangles, holes, scans and tilts", ("perturbation", "none"): "undisturbed",
    ("perturbation", NOTHING_KEPT): "plain simplification",
}  # fmt: skip
about_points = partial(Claim, section="ours", stage=score.STAGE, dataset=BENCHMARK, over=("item",), phrases=OF_POINTS)
CLAIMS = [
    *(
        Claim(key=f"autoencoder_over_none_{fault}", sentence=sentence, section="T6.3", stage=touch.STAGE,
              dataset=touch.DENOISED, printed=0, first={"features": LEARNED}, second={"features": PLAIN},
              within=("severity",), phrases=OF_TOUCHES,
              where={"perturbation": fault, "split": Split.RANDOM, "classifier": "knn", "metric": "accuracy"})
        for fault, sentence in DENOISING
    ),
    *(
        about_points(key=key, sentence=sentence, first={"method": first}, second={"method": second},
                  where={"perturbation": perturbation, "metric": "repeatability"}, within=("perturbation", "severity"),
                  unit="% of the points", readings=readings)
        for key, first, second, perturbation, readings, sentence in MORE_STABLE
    ),
    about_points(key="disturbed_touch", first={"perturbation": "none"}, second={"perturbation": MOVES},
              where={"method": "glance", "metric": "recognised"},
              sentence="Places that a disturbance has moved are recognised by touch less often than the learned "
                       "places."),
    about_points(key="disturbed_lod", first={"perturbation": NOTHING_KEPT}, second={"perturbation": MOVES},
              where={"method": "glance", "metric": "lod_salient"}, relative=True, unit="% of the mean of both errors",
              sentence="Points of a disturbed object still spare what the gaze model finds salient."),
]  # fmt: skip
