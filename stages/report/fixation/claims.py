"""Claims of T3.3: where networks look, against where people look."""

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import Any

from stages.fixation.agreement import ALL_VIEWS
from stages.fixation.places import ITSELF
from stages.fixation.tasks import FUSED_TASKS
from stages.report.claims import Claim
from stages.report.results import GAZED

from .detectors import FUSED, LEE, NARROWED, NOISE, OURS, PRIOR, RIVALS, network_text, task_text, with_random_weights
from .rows import WHOLE

# The thesis's (T3.3.2), but that ResNet101's weights come with no package; then ours, with new heads alone.
PRINTED = VGG, RESNET = ("vgg16-last_block", "resnet50-last_block")
FROZEN = ("vgg16-frozen", "resnet50-frozen", "mobilenet_v2-frozen")
TUNED = "*-last_block"
EWIGC, EWIGC_L4 = (TUNED, FUSED), (TUNED, NARROWED)
BOTH = (RESNET, FUSED), (VGG, FUSED)
NAMED = {ITSELF: "the object itself", "convexity": "the convexity"}  # tasks that are not fused
AVERAGE = "average"  # the same four maps with equal weights
Pair = tuple[str, str | tuple[str, ...]]  # method and task, or tasks
DIAMETER = "% of the bounding sphere's diameter"
SEEN = "household", "princeton", "gaze_clouds"  # sets of whose objects networks were asked for the most salient place
VIEWS = ("0", "1", "2")  # the three views of which an object's score is the mean
PHRASES = {
    ("method", TUNED): "mean of the networks", ("method", "rival"): "", ("method", "control"): "",
    ("method", "*-frozen"): "", ("metric", "nearer_than_chance"): "", ("metric", "nearer_than_middle"): "",
    ("view", VIEWS): "", ("view", ALL_VIEWS): "",
    ("metric", "pcc_masked"): "PCC the thesis's way, hidden vertices as zeros",
    ("metric", "pcc_tasks"): "PCC between tasks", ("metric", "distance"): "distance (nearest, which favours many "
    "centres)", ("metric", "distance_mean"): "distance (mean of all pairs)",
    ("task", FUSED_TASKS): "mean of the four tasks that are fused,", ("task", AVERAGE): "equal weights,",
    ("task", OURS.task): "ours, learned on the other meshes,",
    **{("task", one): f"{task_text(one)}," for one in (FUSED, NARROWED, *NAMED)},
    **{("task", one.task): one.text for one in (LEE, PRIOR, NOISE)},
    **{("task", task): task_text(task) for task in RIVALS.values()},
    **{("method", each): network_text(each) for one in (*PRINTED, *FROZEN) for each in (one, with_random_weights(one))},
}  # fmt: skip
claim = partial(Claim, stage="fixation", dataset=GAZED, over=("item",), scale=1, unit="PCC", phrases=PHRASES)


def agrees(
    key: str, said: str, first: Pair, second: Pair, section: str = "T3.3.6", metric: str = "pcc", **more: Any
) -> Claim:
    """A claim that the correlation of one (method, task) with people is higher than that of another."""
    one, other = ({"task": task, "method": method} for method, task in (first, second))
    return claim(key=key, section=section, sentence=said, where={"metric": metric, "view": VIEWS}, first=one,
                 second=other, **more)  # fmt: skip


def in_each_metric(*args: Any, **more: Any) -> list[Claim]:
    """The claim of `agrees` by PCC, the thesis's measure, and by NSS and AUC, which are of all views: one sentence."""
    claim = agrees(*args, **more)
    return [claim] + [
        replace(claim, key=f"{claim.key}_{metric}", where={"metric": metric, "view": ALL_VIEWS}, unit=metric.upper())
        for metric in WHOLE
    ]


def each_network(key: str, sentence: str, other: Callable[[str], Pair]) -> list[Claim]:
    """The claims for each of PRINTED and FROZEN. other: of a method, what it is compared with."""
    keys = {one: (f"{key}_{one.partition('-')[0]}", "T3.3.6") for one in PRINTED}
    keys |= {one: (f"{key}_{one.replace('-', '_')}", "ours") for one in FROZEN}
    return [
        claim for one, (name, section) in keys.items()
        for claim in in_each_metric(name, sentence, (one, FUSED), other(one), section)
    ]  # fmt: skip


def nearer(key: str, sentence: str, near: Pair, far: Pair) -> list[Claim]:
    """The claim that the centres of `near` are nearer: the mean of all pairs, and the nearest, the thesis's measure."""
    pairs = agrees(key, sentence, far, near, metric="distance_mean", scale=100, unit=DIAMETER)
    said, where = f"{sentence[:-1]}, each by its nearest.", {**pairs.where, "metric": "distance"}
    return [pairs, replace(pairs, key=f"{key}_least", sentence=said, where=where)]


def same_place(other: str, words: str, note: str) -> Claim:
    """The claim that the maxima of two views lie nearer to each other than other places: "chance" or "middle"."""
    sentence = f"Changing the viewpoint moves the most salient place less than {words}."
    note = f"{task_text(ITSELF)}, frozen networks: distance of {note} minus that of their maxima"
    return claim(key=f"same_place_over_{other}", section="T3.3.3", sentence=sentence, dataset=SEEN, unit=DIAMETER,
                 where={"metric": f"nearer_than_{other}"}, first={"method": "*-frozen"}, second=0, scale=100,
                 note=note)  # fmt: skip


CLAIMS = [
    *each_network("ewigc_over_lee", "Fused Grad-CAM predicts gaze better than Lee's mesh saliency.", lambda _: LEE),
    *each_network("ewigc_over_random_weights", "What a network learned from photographs makes its attention like "
                  "people's.", lambda method: (with_random_weights(method), FUSED)),
    *each_network("ewigc_over_centre", "Fused Grad-CAM predicts gaze better than the middle of the picture.",
                  lambda _: PRIOR),
    *nearer("ewigc_nearer_than_lee", "Fused Grad-CAM finds centres nearer to fixations than mesh saliency does.",
            EWIGC, LEE),
    *[one for name, task in RIVALS.items()
      for one in in_each_metric(f"ewigc_over_{task}", f"Fused Grad-CAM predicts gaze better than {name}.", EWIGC,
                                ("rival", task))],
    *[one for name, task in RIVALS.items()
      for one in nearer(f"ewigc_nearer_than_{task}", f"Fused Grad-CAM finds centres nearer to fixations than {name}.",
                        EWIGC, ("rival", task))],
    *nearer("ewigc_nearer_than_noise", "Fused Grad-CAM finds centres nearer to fixations than noise does.",
            EWIGC, NOISE),
    *[one for task, name in NAMED.items()
      for one in in_each_metric(f"{task}_least", f"Attention is less like people's where a network names {name} than "
                                "in the tasks that are fused.", (TUNED, FUSED_TASKS), (TUNED, task), "T3.3.3",
                                within=("method",))],
    claim(key="resnet_more_alike", section="T3.3.3", where={"metric": "pcc_tasks"},
          sentence="The tasks' maps of ResNet are more alike than those of VGG16.",
          first={"method": RESNET}, second={"method": VGG}),
    same_place("chance", "chance would", "random places that two views see"),
    same_place("middle", "the middle of the picture", "what two views show in the middle"),
    *in_each_metric("entropy_over_average", "Weighing maps by their entropy beats averaging them.", EWIGC,
                    (TUNED, AVERAGE), "T3.3.4", within=("method",)),
    *in_each_metric("resnet_over_vgg", "Fused Grad-CAM of ResNet predicts gaze better than that of VGG16.", *BOTH),
    *nearer("resnet_nearer_than_vgg", "Fused Grad-CAM of ResNet finds centres nearer to fixations than that of VGG16.",
            *BOTH),
    *in_each_metric("fused_over_narrowed", "The whole map correlates more with gaze than its highest levels alone.",
                    EWIGC, EWIGC_L4, within=("method",)),
    *nearer("fused_nearer_than_narrowed", "The whole map's centres lie nearer than those of its highest levels.",
            EWIGC, EWIGC_L4),
    agrees("fused_over_narrowed_masked", "The whole map correlates more with gaze than its highest levels, hidden "
           "vertices counted as zero.", EWIGC, EWIGC_L4, metric="pcc_masked", within=("method",)),
    agrees("ewigc_over_lee_masked", "Fused Grad-CAM predicts gaze better than Lee's mesh saliency, hidden vertices "
           "counted as zero.", EWIGC, LEE, metric="pcc_masked"),
    *in_each_metric("ours_over_ewigc", "Our model of gaze predicts where people look better than fused Grad-CAM.",
                    OURS, EWIGC, "ours"),
]  # fmt: skip
