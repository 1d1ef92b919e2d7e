"""Trains networks on the touches of a data set (T chapter 5)."""

from dataclasses import dataclass

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


@dataclass
class Params:
    """Section `transfer` of params.yaml."""

    touches: int
    detector: str
    cells: int
    pitch: float
    coarse_cells: list[int]
    networks: dict[str, list[str]]
    weights: list[str]
    uncontrolled: list[str]
    source: str
    splits: dict[str, int]
    size: int
    copies: int
    train_share: float
    validation_share: float
    frozen_rates: list[float]
    finetuned_rates: list[float]
    search_epochs: int
    passes: list[str]
    epochs: int
    patience: int
    most_epochs: int
    batch: int
    momentum: float
    device: str
    hybrid_middles: list[str]
    hybrid_pictures: int
    hybrid_colour: bool
    hybrid_rate: float
    hybrid_passes: str
    hybrid_size: int
    hybrid_onnx: bool
    new_object_touches: list[int]
    hybrid_severities: dict[str, list[float]]
