"""Claims of T3.3: where networks look, against where people look."""

import pandas as pd

from stages.report.figures.figure_3_31 import likeness
from stages.report.results import NotRun
from stages.report.style import label
from stages.report.tables._fixation import (
    CHOSEN,
    FUSED,
    LEE,
    NARROWED,
    NOISE,
    OURS,
    PERCENT,
    PRIOR,
    gap,
    scores,
    spoken_network,
    untrained_twin,
)
from stages.report.verdict import Claim

from ._places import anywhere, middle, same_place

# The thesis's, but that ResNet101's weights come with no package; and a small one.
NETWORKS = ("vgg16-frozen", "resnet50-frozen", "mobilenet_v2-frozen")
AVERAGE = "average"  # the same four maps with equal weights
DIAMETER = "% of the bounding sphere's diameter"
GAZE = "meshes with human gaze"
LEAST, PAIRS = "distance", "distance_mean"  # of centres: the nearest, as in the thesis; the mean of all pairs


def gaze_scores(results, metric):
    """Frame of scores on the meshes with human gaze; NotRun where they were not judged."""
    table = scores(results.fixation("gaze").dropna(subset=["value"]), metric)
    if table.empty:
        raise NotRun(f"no {metric} on {GAZE}", "fixation", runnable=False)
    return table


def over(method, other):
    """differences(results): PCC of the fused map of a network minus that of `other`, a (method, task), an object."""

    def differences(results):
        return gap(gaze_scores(results, "pcc"), (method, FUSED), other)

    return differences


def resnet_over_vgg(metric):
    """differences(results): the fused map of ResNet against that of VGG16 by a metric, an object."""
    vgg, resnet = NETWORKS[:2]

    def differences(results):
        gains = gap(gaze_scores(results, metric), (resnet, FUSED), (vgg, FUSED))
        return -PERCENT * gains if metric in (LEAST, PAIRS) else gains

    return differences


def mean_over_networks(pair, metric="pcc"):
    """differences(results): gap(table, *pair(method)) an object, the mean over the frozen networks."""

    def differences(results):
        table = gaze_scores(results, metric)
        gains = pd.concat([gap(table, *pair(method)) for method in frozen(table)], axis=1).mean(axis=1)
        return -PERCENT * gains if metric in (LEAST, PAIRS) else gains

    return differences


def less_than_chosen(task):
    """differences(results): mean PCC of the tasks that are fused minus that of another, mean over the networks."""

    def differences(results):
        table = gaze_scores(results, "pcc")
        ran = [method for method in frozen(table) if (method, task) in table]
        if not ran:
            raise NotRun(f"no map of {label(task)}", "fixation", runnable=False)
        chosen = {method: [(method, name) for name in CHOSEN if (method, name) in table] for method in ran}
        gains = [table[names].mean(axis=1) - table[method, task] for method, names in chosen.items()]
        return pd.concat(gains, axis=1).mean(axis=1).dropna()

    return differences


def frozen(table):
    """The frozen networks of a frame of scores; NotRun where there is none."""
    found = [method for method, task in table if task == FUSED and method.endswith("-frozen")]
    if not found:
        raise NotRun(f"no frozen network on {GAZE}", "fixation", runnable=False)
    return found


def more_alike(results):
    """(k,): mean correlation between the tasks' maps of ResNet minus that of VGG, an object."""
    rows, (vgg, resnet) = results.fixation("gaze"), NETWORKS[:2]
    means = {method: likeness(rows.dropna(subset=["value"]), method).mean(axis=1) for method in (resnet, vgg)}
    missing = [spoken_network(method) for method, values in means.items() if values.empty]
    if missing:
        raise NotRun(f"{' and '.join(missing)} not run on {GAZE}", "fixation", runnable=False)
    return (means[resnet] - means[vgg]).dropna()


def each_network(key, sentence, tested, other):
    """The claim for each of NETWORKS. other(method): the (method, task) that it is compared with."""
    for method in NETWORKS:
        where = f"{GAZE}, {spoken_network(method)}: PCC, EWIGC minus {tested}"
        name = f"{key}_{method.partition('-')[0]}"
        yield Claim(name, "T3.3.6", sentence, where, "PCC", "objects", over(method, other(method)))


def by_distance(key, sentence):
    """(key, sentence, metric, what is measured) of a claim that centres are nearer: all pairs, the thesis's measure."""
    yield key, sentence, PAIRS, "distance (mean of all pairs)"
    said = f"{sentence[:-1]}, each by its nearest."
    yield f"{key}_least", said, LEAST, "distance (nearest, which favours many centres)"


def nearer(key, sentence, tested, pair):
    """The claim that EWIGC's centres are nearer, by both distances."""
    for name, said, metric, measure in by_distance(key, sentence):
        words = f"{measure} of {tested} minus that of EWIGC"
        yield pooled(name, "T3.3.6", said, words, mean_over_networks(pair, metric), DIAMETER)


def pooled(key, section, sentence, tested, differences, unit="PCC"):
    """A claim on the mean of the frozen networks."""
    return Claim(key, section, sentence, f"{GAZE}, mean of the frozen networks: {tested}", unit, "objects", differences)


CLAIMS = [
    *each_network(
        "ewigc_over_lee", "Fused Grad-CAM predicts gaze better than Lee's mesh saliency.", "mesh saliency",
        lambda _: LEE,
    ),
    *each_network(
        "ewigc_over_random_weights", "What a network learned from photographs makes its attention like people's.",
        "that of one draw of random weights", lambda method: (untrained_twin(method), FUSED),
    ),
    *each_network(
        "ewigc_over_centre", "Fused Grad-CAM predicts gaze better than the middle of the picture.", "centre prior",
        lambda _: PRIOR,
    ),
    *nearer(
        "ewigc_nearer_than_lee", "Fused Grad-CAM finds centres nearer to fixations than mesh saliency does.",
        "mesh saliency", lambda method: ((method, FUSED), LEE),
    ),
    *nearer(
        "ewigc_nearer_than_noise", "Fused Grad-CAM finds centres nearer to fixations than noise does.",
        "noise", lambda method: ((method, FUSED), NOISE),
    ),
    pooled(
        "level_3_least", "T3.3.3", "Attention is less like people's where a network names the object itself than in "
        "the tasks that are fused.",
        "PCC, mean of the four tasks that are fused minus level 3", less_than_chosen("level_3"),
    ),
    pooled(
        "convexity_least", "T3.3.3", "Attention is less like people's where a network names the convexity than in "
        "the tasks that are fused.",
        "PCC, mean of the four tasks that are fused minus convexity", less_than_chosen("convexity"),
    ),
    Claim(
        "resnet_more_alike", "T3.3.3", "The tasks' maps of ResNet are more alike than those of VGG16.",
        f"{GAZE}, mean PCC between tasks, ResNet50 minus VGG16", "PCC", "objects", more_alike,
    ),
    Claim(
        "same_place_over_chance", "T3.3.3",
        "Changing the viewpoint moves the most salient place less than chance would.",
        "this run's objects, level 3, frozen networks: distance of random places that two views see minus that of "
        "their maxima", DIAMETER, "objects", same_place(anywhere),
    ),
    Claim(
        "same_place_over_middle", "T3.3.3",
        "Changing the viewpoint moves the most salient place less than the middle of the picture.",
        "this run's objects, level 3, frozen networks: distance of what two views show in the middle minus that of "
        "their maxima", DIAMETER, "objects", same_place(middle),
    ),
    pooled(
        "entropy_over_average", "T3.3.4", "Weighing maps by their entropy beats averaging them.",
        "PCC, EWIGC minus equal weights", mean_over_networks(lambda method: ((method, FUSED), (method, AVERAGE))),
    ),
    Claim(
        "resnet_over_vgg", "T3.3.6", "Fused Grad-CAM of ResNet predicts gaze better than that of VGG16.",
        f"{GAZE}, frozen networks: PCC of EWIGC, ResNet50 minus VGG16", "PCC", "objects", resnet_over_vgg("pcc"),
    ),
    *(
        Claim(key, "T3.3.6", sentence, f"{GAZE}, frozen networks, EWIGC: {measure} of VGG16 minus that of ResNet50",
              DIAMETER, "objects", resnet_over_vgg(metric))
        for key, sentence, metric, measure in by_distance(
            "resnet_nearer_than_vgg", "Fused Grad-CAM of ResNet finds centres nearer to fixations than that of VGG16."
        )
    ),
    pooled(
        "fused_over_narrowed", "T3.3.6", "The whole map correlates more with gaze than its highest levels alone.",
        "PCC, EWIGC minus EWIGC_L4", mean_over_networks(lambda method: ((method, FUSED), (method, NARROWED))),
    ),
    *nearer(
        "fused_nearer_than_narrowed", "The whole map's centres lie nearer than those of its highest levels.",
        "EWIGC_L4", lambda method: ((method, FUSED), (method, NARROWED)),
    ),
    pooled(
        "fused_over_narrowed_masked", "T3.3.6", "The whole map correlates more with gaze than its highest levels, "
        "hidden vertices counted as zero.", "PCC the thesis's way, EWIGC minus EWIGC_L4",
        mean_over_networks(lambda method: ((method, FUSED), (method, NARROWED)), "pcc_masked"),
    ),
    pooled(
        "ewigc_over_lee_masked", "T3.3.6", "Fused Grad-CAM predicts gaze better than Lee's mesh saliency, hidden "
        "vertices counted as zero.", "PCC the thesis's way, EWIGC minus mesh saliency",
        mean_over_networks(lambda method: ((method, FUSED), LEE), "pcc_masked"),
    ),
    pooled(
        "ours_over_ewigc", "ours", "Our model of gaze predicts where people look better than fused Grad-CAM.",
        "PCC, ours, learned from gaze on the other meshes, minus EWIGC, which saw none",
        mean_over_networks(lambda method: (OURS, (method, FUSED))),
    ),
]  # fmt: skip
