"""Claims of T3.3: where networks look, against where people look."""

from dataclasses import replace
from functools import partial

from stages.report.claims import Claim
from stages.report.style import label

from .places import nearer_than_chance, nearer_than_middle
from .rows import (
    CHOSEN,
    FUSED,
    LEE,
    MODELS,
    NARROWED,
    NOISE,
    OURS,
    PRIOR,
    network_text,
    with_random_weights,
)  # fmt: skip

# The thesis's, but that ResNet101's weights come with no package; and a small one.
NETWORKS = VGG, RESNET, _ = ("vgg16-frozen", "resnet50-frozen", "mobilenet_v2-frozen")
FROZEN = "*-frozen"
AVERAGE = "average"  # the same four maps with equal weights
DIAMETER = "% of the bounding sphere's diameter"
VIEWS = ("0", "1", "2")  # the three views of which an object's score is the mean
PHRASES = {
    ("method", FROZEN): "mean of the frozen networks", ("method", "rival"): "", ("method", "control"): "",
    ("view", VIEWS): "", ("metric", "pcc_masked"): "PCC the thesis's way, hidden vertices as zeros",
    ("metric", "pcc_tasks"): "PCC between tasks", ("metric", "distance"): "distance (nearest, which favours many "
    "centres)", ("metric", "distance_mean"): "distance (mean of all pairs)",
    ("task", CHOSEN): "mean of the four tasks that are fused,", ("task", OURS[1]): "ours, learned on the other meshes,",
    ("task", AVERAGE): "equal weights,", ("task", NOISE[1]): "noise",
    **{("task", one): f"{name}," for one, name in MODELS.items()},
    **{("task", one): f"{label(one)}," for one in ("level_3", "convexity")},
    **{("task", one): label(one) for one in (LEE[1], PRIOR[1])},
    **{("method", each): network_text(each) for one in NETWORKS for each in (one, with_random_weights(one))},
}  # fmt: skip
claim = partial(Claim, stage="fixation", dataset="gaze", over=("item",), scale=1, unit="PCC", phrases=PHRASES)


def of(method, task):
    """The side of a claim that is one detector."""
    return {"task": task, "method": method}


def agrees(key, sentence, first, second, section="T3.3.6", metric="pcc", **further):
    """A claim that one detector's correlation with people is higher than another's."""
    return claim(key=key, section=section, sentence=sentence, where={"metric": metric, "view": VIEWS},
                 first=of(*first), second=of(*second), **further)  # fmt: skip


def each_network(key, sentence, other):
    """The claim for each of NETWORKS. other(method): the (method, task) that it is compared with."""
    return [agrees(f"{key}_{one.partition('-')[0]}", sentence, (one, FUSED), other(one)) for one in NETWORKS]


def nearer(key, sentence, near, far):
    """The claim that the centres of `near` are nearer: the mean of all pairs, and the nearest, the thesis's measure."""
    pairs = agrees(key, sentence, far, near, metric="distance_mean", scale=100, unit=DIAMETER)
    said, where = f"{sentence[:-1]}, each by its nearest.", pairs.where | {"metric": "distance"}
    return [pairs, replace(pairs, key=f"{key}_least", sentence=said, where=where)]


def same_place(nearer, sentence, note):
    """The claim that the maxima of two views lie nearer to each other than other places."""
    key = f"same_place_over_{nearer.__name__.rpartition('_')[2]}"
    return Claim(key=key, section="T3.3.3", sentence=sentence, stage="fixation",
                 over=("item",), unit=DIAMETER, statistic=nearer.__name__,
                 note=f"level 3, frozen networks: distance of {note} minus that of their maxima")  # fmt: skip


CLAIMS = [
    *each_network("ewigc_over_lee", "Fused Grad-CAM predicts gaze better than Lee's mesh saliency.", lambda _: LEE),
    *each_network("ewigc_over_random_weights", "What a network learned from photographs makes its attention like "
                  "people's.", lambda method: (with_random_weights(method), FUSED)),
    *each_network("ewigc_over_centre", "Fused Grad-CAM predicts gaze better than the middle of the picture.",
                  lambda _: PRIOR),
    *nearer("ewigc_nearer_than_lee", "Fused Grad-CAM finds centres nearer to fixations than mesh saliency does.",
            (FROZEN, FUSED), LEE),
    *nearer("ewigc_nearer_than_noise", "Fused Grad-CAM finds centres nearer to fixations than noise does.",
            (FROZEN, FUSED), NOISE),
    agrees("level_3_least", "Attention is less like people's where a network names the object itself than in the tasks "
           "that are fused.", (FROZEN, CHOSEN), (FROZEN, "level_3"), "T3.3.3", within=("method",)),
    agrees("convexity_least", "Attention is less like people's where a network names the convexity than in the tasks "
           "that are fused.", (FROZEN, CHOSEN), (FROZEN, "convexity"), "T3.3.3", within=("method",)),
    claim(key="resnet_more_alike", section="T3.3.3", where={"metric": "pcc_tasks"},
          sentence="The tasks' maps of ResNet are more alike than those of VGG16.",
          first={"method": RESNET}, second={"method": VGG}),
    same_place(nearer_than_chance, "Changing the viewpoint moves the most salient place less than chance would.",
               "random places that two views see"),
    same_place(nearer_than_middle, "Changing the viewpoint moves the most salient place less than the middle of the "
               "picture.", "what two views show in the middle"),
    agrees("entropy_over_average", "Weighing maps by their entropy beats averaging them.",
           (FROZEN, FUSED), (FROZEN, AVERAGE), "T3.3.4", within=("method",)),
    agrees("resnet_over_vgg", "Fused Grad-CAM of ResNet predicts gaze better than that of VGG16.",
           (RESNET, FUSED), (VGG, FUSED)),
    *nearer("resnet_nearer_than_vgg", "Fused Grad-CAM of ResNet finds centres nearer to fixations than that of VGG16.",
            (RESNET, FUSED), (VGG, FUSED)),
    agrees("fused_over_narrowed", "The whole map correlates more with gaze than its highest levels alone.",
           (FROZEN, FUSED), (FROZEN, NARROWED), within=("method",)),
    *nearer("fused_nearer_than_narrowed", "The whole map's centres lie nearer than those of its highest levels.",
            (FROZEN, FUSED), (FROZEN, NARROWED)),
    agrees("fused_over_narrowed_masked", "The whole map correlates more with gaze than its highest levels, hidden "
           "vertices counted as zero.", (FROZEN, FUSED), (FROZEN, NARROWED), metric="pcc_masked", within=("method",)),
    agrees("ewigc_over_lee_masked", "Fused Grad-CAM predicts gaze better than Lee's mesh saliency, hidden vertices "
           "counted as zero.", (FROZEN, FUSED), LEE, metric="pcc_masked"),
    agrees("ours_over_ewigc", "Our model of gaze predicts where people look better than fused Grad-CAM.",
           OURS, (FROZEN, FUSED), "ours"),
]  # fmt: skip
