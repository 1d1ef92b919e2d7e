"""Claims of T3.3: where networks look, against where people look.

Each sentence of the thesis has one primary claim, as printed: meshes with human gaze, networks with their last block
trained, the four tasks that are fused, and Pearson's correlation over all vertices with the hidden ones as zeros, or
the least distance of a view. Its other claims name it in `of`.
"""

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import Any

from stages.charts.datasets import GAZED
from stages.fixation.agreement import ALL_VIEWS
from stages.fixation.places import ITSELF
from stages.fixation.tasks import FUSED_TASKS
from stages.report.claims import POINTS, Claim, highest_of, lowest_of, reading

from .agreement import MEDIAN, UPPER_QUARTILE
from .rows import FUSED, LEE, NARROWED, NOISE, OURS, PRIOR, RIVALS, WHOLE, network_text, task_text, with_random_weights

# The thesis's (T3.3.2), but that ResNet101's weights come with no package; then ours, with new heads alone.
PRINTED = RESNET, VGG = ("resnet50-last_block", "vgg16-last_block")
FROZEN = ("vgg16-frozen", "resnet50-frozen", "mobilenet_v2-frozen")
TUNED = RESNET  # the fully connected layers of VGG16 start from random weights here, see stages.report.validity
EWIGC, EWIGC_L4 = (TUNED, FUSED), (TUNED, NARROWED)
NEAREST = RESNET, FUSED  # to the thesis's best
BOTH = (RESNET, FUSED), (VGG, FUSED)
NAMED = {ITSELF: "the object itself", "convexity": "the convexity"}  # tasks that are not fused
AVERAGE = "average"  # the same four maps with equal weights
CLASSICAL = "thesis_ssim"  # the weighted average of T3.2
LITERATURE = (LEE.task, *RIVALS.values())  # of T figures 3.35 and 3.36
LEIFMAN, (SONG, TASSE) = LITERATURE[1], LITERATURE[2:]
REST = (LEE.task, SONG, TASSE)  # of the literature, without Leifman, whom T3.3.6 praises too
AS_PRINTED = "pcc_masked"
METRICS = (AS_PRINTED, "pcc", *WHOLE)
OUR_METRICS = ("pcc", *WHOLE, AS_PRINTED)  # visible vertices first, since knowing what is hidden is no merit
Pair = tuple[str, Any]  # method and task, or tasks
DIAMETER = "% of the bounding sphere's diameter"
SEEN = (*GAZED, "household", "princeton")  # sets of whose objects networks were asked for the most salient place
VIEWS = ("0", "1", "2")  # the three views of which an object's score is the mean
SHORT = {RESNET: "ResNet", VGG: "VGG16"}
PHRASES = {
    ("method", "rival"): "", ("method", "control"): "",
    ("method", "*-frozen"): "frozen networks,", ("metric", "nearer_than_chance"): "",
    ("metric", "nearer_than_middle"): "", ("view", VIEWS): "",
    ("view", ALL_VIEWS): "maps averaged over all views", ("over", "task"): "tasks",
    ("metric", AS_PRINTED): "PCC the thesis's way, hidden vertices as zeros",
    ("metric", "pcc_tasks"): "PCC between tasks", ("metric", "distance"): "distance (nearest, which favours many "
    "centres)", ("metric", "distance_mean"): "distance (mean of all pairs)",
    ("metric", "distance_maximum"): "distance (of the maxima to the letter)",
    ("metric", "half_share"): "share of the surface that holds half of the saliency",
    ("task", FUSED_TASKS): "mean of the four tasks that are fused,", ("task", tuple(NAMED)): "mean of the other two,",
    ("task", AVERAGE): "equal weights,",
    ("task", OURS.task): "ours, learned on the other meshes,", ("task", CLASSICAL): task_text(CLASSICAL),
    **{("task", task): f"{task_text(task)}," for task in (FUSED, NARROWED, *NAMED)},
    **{("task", task): f"{task_text(task)}," for task in FUSED_TASKS},
    **{("task", detector.task): detector.text for detector in (LEE, PRIOR, NOISE)},
    **{("task", task): task_text(task) for task in RIVALS.values()},
    **{("method", name): network_text(name) for net in (*PRINTED, *FROZEN) for name in (net, with_random_weights(net))},
    ("method", VGG): f"{network_text(VGG)} from random fully connected layers",
}  # fmt: skip
claim = partial(Claim, stage="fixation", dataset=GAZED, over=("item",), scale=1, unit="PCC", phrases=PHRASES)


def frozen(**sides: str) -> dict[str, Any]:
    """The reading with frozen filters, for claims on VGG16, whose tuned rows start from random layers (validity)."""
    methods = {side: {"method": f"{name}-frozen"} for side, name in sides.items()}
    return {"readings": (reading("frozen filters, new heads alone", **methods),)}


VGG_FROZEN, BOTH_FROZEN = frozen(first="vgg16"), frozen(first="resnet50", second="vgg16")


def agrees(
    key: str, sentence: str, first: Pair, second: Pair, section: str = "T3.3.6", metric: str = "pcc", **more: Any
) -> Claim:
    """A claim that the correlation of one (method, task) with people is higher than that of another."""
    higher, lower = ({"task": task, "method": method} for method, task in (first, second))
    return claim(key=key, section=section, sentence=sentence, where={"metric": metric, "view": VIEWS}, first=higher,
                 second=lower, **more)  # fmt: skip


def in_each_metric(*args: Any, metrics: tuple[str, ...] = METRICS, of: str = "", **more: Any) -> list[Claim]:
    """The claim of `agrees` by each metric, the first of which is the primary claim unless `of` names another.

    NSS and AUC are of all views together. The key of PCC over visible vertices has no suffix.
    """
    claim, claims = agrees(*args, **more), []
    for metric in metrics:
        view, unit = (ALL_VIEWS, metric.upper()) if metric in WHOLE else (VIEWS, "PCC")
        key = {"pcc": claim.key, AS_PRINTED: f"{claim.key}_masked"}.get(metric, f"{claim.key}_{metric}")
        claims.append(replace(claim, key=key, where={"metric": metric, "view": view}, unit=unit, of=of))
        of = of or key
    return claims


def each_network(
    key: str, sentence: str, rival: Callable[[str], Pair], section: str = "ours", **more: Any
) -> list[Claim]:
    """The claims for each of PRINTED and FROZEN. rival(method): the method's rival."""
    names = {method: f"{key}_{method.partition('-')[0]}" for method in PRINTED}
    names |= {method: f"{key}_{method.replace('-', '_')}" for method in FROZEN}
    claims = []
    for method, name in names.items():
        fields: dict[str, Any] = {"of": claims[0].key if claims else ""} | more | (VGG_FROZEN if method == VGG else {})
        part = section if method in PRINTED else "ours"
        claims += in_each_metric(name, sentence, (method, FUSED), rival(method), part, **fields)
    return claims


def nearer(key: str, sentence: str, near: Pair, far: Pair, of: str = "", **more: Any) -> list[Claim]:
    """The claim that the centres of `near` are nearer: the nearest of a view, the thesis's measure; the mean of all."""
    mean = agrees(key, sentence, far, near, metric="distance_mean", scale=100, unit=DIAMETER, **more)
    least = replace(mean, key=f"{key}_least", where={**mean.where, "metric": "distance"}, of=of)
    least = replace(least, readings=(*mean.readings, LETTER))
    return [least, replace(mean, of=of or least.key)]


LETTER = reading("maxima to the letter", where={"metric": "distance_maximum"})
MEAN_DISTANCE = reading("mean distance of all pairs", where={"metric": "distance_mean"})


def quartile(key: str, sentence: str, near: Pair, far: Pair, statistic: str, of: str = "") -> Claim:
    """The claim that a quantile of the least distances of all views is lower. statistic: a statistic of .people."""
    words = statistic.replace("_", " ").replace("below", "of both")
    return agrees(key, sentence, near, far, metric="distance", scale=100, unit="% of the views", within=("view",),
                  statistic=statistic, of=of, note=f"share of views below the {words}",
                  readings=(*(VGG_FROZEN["readings"] if near[0] == VGG else ()), MEAN_DISTANCE, LETTER))  # fmt: skip


def same_place(place: str, words: str, note: str, of: str = "") -> Claim:
    """The claim that the maxima of two views lie nearer to each other than other places: "chance" or "middle"."""
    sentence = f"Changing the viewpoint moves the most salient place less than {words}."
    note = f"{task_text(ITSELF)}: distance of {note} minus that of their maxima; MobileNetV2 and ResNet50, not VGG16"
    return claim(key=f"same_place_over_{place}", section="T3.3.3", sentence=sentence, dataset=SEEN, unit=DIAMETER,
                 where={"metric": f"nearer_than_{place}"}, first={"method": "*-frozen"}, second=0, scale=100,
                 note=note, of=of)  # fmt: skip


def spreads(key: str, task: str, method: str, of: str) -> Claim:
    """The claim that half of the classical model's saliency lies on more of the surface than that of a network."""
    return claim(key=key, section="T3.4", sentence="Fused Grad-CAM has its saliency in small regions, classical "
                 "attention has it all over the surface.", where={"metric": "half_share", "view": VIEWS}, scale=100,
                 first={"task": CLASSICAL, "method": "rival"}, second={"task": task, "method": method},
                 unit="% of the surface", of=of)  # fmt: skip


CLAIMS = [
    claim(key="test_accuracy", section="T3.3.2", sentence="Networks that learned the tasks name 96 to 100 % of the "
          "test pictures right.", where={"metric": "accuracy", "split": "views"}, first={"method": lowest_of(*PRINTED)},
          second=0.96, over=("task",), scale=100, unit=POINTS),
    same_place("middle", "the middle of the picture", "what two views show in the middle"),
    same_place("chance", "chance would", "random places that two views see", "same_place_over_middle"),
    claim(key="resnet_more_alike", section="T3.3.3", where={"metric": "pcc_tasks"},
          sentence="The tasks' maps of ResNet are more alike than those of VGG16.",
          first={"method": RESNET}, second={"method": VGG}, **BOTH_FROZEN),
    *in_each_metric("excluded_least", "Attention is less like people's where a network names the object itself or its "
                    "convexity than in the tasks that are fused.", (TUNED, FUSED_TASKS), (TUNED, tuple(NAMED)),
                    "T3.3.3", within=("method",)),
    *in_each_metric("excluded_least_vgg16", "Attention is less like people's where a network names the object itself "
                    "or its convexity than in the tasks that are fused (VGG16).", (VGG, FUSED_TASKS),
                    (VGG, tuple(NAMED)),
                    "T3.3.3", within=("method",), of="excluded_least_masked",
                    **frozen(first="vgg16", second="vgg16")),
    *[entry for task, name in NAMED.items()
      for entry in in_each_metric(f"{task}_least", f"Attention is less like people's where a network names {name} than "
                                  "in the tasks that are fused.", (TUNED, FUSED_TASKS), (TUNED, task), "T3.3.3",
                                  within=("method",), of="excluded_least_masked")],
    *in_each_metric("entropy_over_average", "Weighing maps by their entropy beats averaging them, as the thesis "
                    "expects.", EWIGC, (TUNED, AVERAGE), "T3.3.4", within=("method",)),
    *[entry for method, name in SHORT.items()
      for entry in in_each_metric(f"ewigc_over_rest_{method.partition('-')[0]}", f"Fused Grad-CAM of {name} correlates "
                                  "more with fixations than the models of Lee, Song and Tasse.", (method, FUSED),
                                  ("rival", highest_of(*REST)), **(VGG_FROZEN if method == VGG else {}))],
    *in_each_metric("leifman_over_rest", "Leifman's regions of interest correlate more with fixations than the models "
                    "of Lee, Song and Tasse.", ("rival", LEIFMAN), ("rival", highest_of(*REST))),
    *each_network("ewigc_over_lee", "Fused Grad-CAM predicts gaze better than Lee's mesh saliency.", lambda _: LEE,
                  "T3.3.6", of="ewigc_over_rest_resnet50_masked"),
    *[entry for name, task in RIVALS.items()
      for entry in in_each_metric(f"ewigc_over_{task}", f"Fused Grad-CAM predicts gaze better than {name}.", NEAREST,
                                  ("rival", task), of="ewigc_over_rest_resnet50_masked")],
    *in_each_metric("fused_over_narrowed", "The whole map correlates more with gaze than its highest levels alone.",
                    EWIGC, EWIGC_L4, within=("method",)),
    *nearer("ewigc_nearer_than_literature", "Fused Grad-CAM finds centres nearer to fixations than the best model of "
            "the literature.", NEAREST, ("rival", lowest_of(*LITERATURE))),
    *[entry for name, task in {"mesh saliency": LEE.task, **RIVALS}.items()
      for entry in nearer(f"ewigc_nearer_than_{'lee' if task == LEE.task else task}", "Fused Grad-CAM finds centres "
                          f"nearer to fixations than {name}.", NEAREST, ("rival", task),
                          "ewigc_nearer_than_literature_least")],
    *[quartile(f"ewigc_{key}_{method.partition('-')[0]}", f"The {words} of the distances to fixations is lower by "
               f"fused Grad-CAM of {name} than by the best model of the literature.", (method, FUSED),
               ("rival", lowest_of(*LITERATURE)), below)
      for key, words, below in (("median_nearer", "median", MEDIAN),
                                ("upper_quartile_nearer", "75th percentile", UPPER_QUARTILE))
      for method, name in SHORT.items()],
    *nearer("leifman_nearer_than_rest", "Leifman's regions of interest lie nearer to fixations than those of Lee, Song "
            "and Tasse.", ("rival", LEIFMAN), ("rival", lowest_of(*REST))),
    *nearer("fused_nearer_than_narrowed", "The whole map's centres lie nearer than those of its highest levels.",
            EWIGC, EWIGC_L4),
    *nearer("ewigc_nearer_than_middle", "Fused Grad-CAM tells the place of fixations, if not their extent: better than "
            "the middle of the picture does.", NEAREST, PRIOR, "ewigc_nearer_than_literature_least"),
    *nearer("ewigc_nearer_than_noise", "Fused Grad-CAM finds centres nearer to fixations than noise does.",
            NEAREST, NOISE, "ewigc_nearer_than_literature_least", checked=False),
    *[spreads(f"deep_concentrates{key}{suffix}", task, method, "deep_concentrates" if key or suffix else "")
      for key, task in {"": FUSED, "_narrowed": NARROWED}.items()
      for suffix, method in {"": TUNED, "_frozen": "*-frozen"}.items()],
    claim(key="noise_concentrates", section="ours", scale=100, unit="% of the surface",
          sentence="Half of the saliency of noise lies on less of the surface than that of classical attention: this "
          "measure does not see regions.",
          where={"metric": "half_share", "view": VIEWS}, first={"task": CLASSICAL, "method": "rival"},
          second=NOISE._asdict()),
    *each_network("ewigc_over_random_weights", "A network that learned from photographs has attention more like "
                  "people's than one with random weights.", lambda method: (with_random_weights(method), FUSED),
                  metrics=OUR_METRICS),
    *each_network("ewigc_over_centre", "Fused Grad-CAM predicts gaze better than the middle of the picture.",
                  lambda _: PRIOR, metrics=OUR_METRICS),
    *in_each_metric("resnet_over_vgg", "Fused Grad-CAM of ResNet predicts gaze better than that of VGG16.", *BOTH,
                    "ours", metrics=OUR_METRICS, **BOTH_FROZEN),
    *nearer("resnet_nearer_than_vgg", "Fused Grad-CAM of ResNet finds centres nearer to fixations than that of VGG16.",
            *BOTH, section="ours", **BOTH_FROZEN),
    *[claim(key=key, section="ours", sentence="Noise correlates with gaze where hidden vertices count as zeros.", of=of,
            where={"metric": metric, "view": VIEWS}, first=NOISE._asdict(), second=0)
      for key, metric, of in (("noise_correlates_masked", AS_PRINTED, ""),
                              ("noise_correlates", "pcc", "noise_correlates_masked"))],
    *in_each_metric("ewigc_over_noise", "Fused Grad-CAM correlates more with fixations than noise does.", NEAREST,
                    NOISE, "ours"),
    *in_each_metric("glance_over_ewigc", "Our glance predicts where people look better than fused Grad-CAM.",
                    OURS, (highest_of(but=("*-random",)), FUSED), "ours", metrics=OUR_METRICS),
]  # fmt: skip
