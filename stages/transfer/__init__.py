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
    "passes": "printed: as many as the thesis's captions say; converged: until nothing improves on validation touches",
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

    touches: int  # imprints an object: its salient points first, then blind ones
    detector: str  # which salient points come first, one of salient_points.methods
    cells: int  # sensels a side of the pressure array
    pitch: float  # distance of two sensels; times cells it is the sensor's width, 1 is the object's diameter
    coarse_cells: list[int]  # sensels a side of other arrays, as wide: no control, no range of layers, no stability
    networks: dict[str, list[str]]  # network: what learns, the new head (frozen), all (finetuned), all but a range
    weights: list[str]  # start from imagenet, or as controls from random (statistics of the images) and random_initial
    uncontrolled: list[str]  # networks that are not trained from random weights, for the cost
    source: str  # where ImageNet's weights come from: package (by hash), download (torchvision's) or auto
    splits: dict[str, int]  # how many of random (touches are drawn for testing, T5.1.3) and objects (one of each class)
    size: int  # pixels a side of the image that the network sees
    copies: int  # augmented copies of each image whose frozen features are cached
    train_share: float  # part of the touches for training where the split is random, the rest for testing
    validation_share: float  # part of the training touches that chooses the rate and the best weights
    frozen_rates: list[float]  # learning rates tried for the head alone
    finetuned_rates: list[float]  # learning rates tried where convolutions learn
    search_epochs: int  # passes of each tried rate
    passes: list[str]  # printed: `epochs` passes over all training touches; converged: until nothing improves
    epochs: int  # passes of the final training as printed
    patience: int  # converged: passes without a better validation accuracy after which a training ends
    most_epochs: int  # converged: passes at most
    batch: int  # images a step
    momentum: float  # of the stochastic gradient descent
    device: str  # where networks are trained: auto (a CUDA card where there is one), cpu, cuda
    severities: dict[str, list[float]]  # of each perturbation of the test touches, from mild to harsh
    hybrid_middles: list[str]  # layers that both senses share in a hybrid network; damage is tried on the first
    hybrid_pictures: int  # pictures of each object
    hybrid_colour: bool  # pictures in the objects' colours, which may give them away; else grey clay
    hybrid_rate: float  # learning rate of its two networks
    hybrid_onnx: bool  # also write the first network as ONNX
    new_object_touches: list[int]  # of each new object, which a new head alone learns; less than `touches`
    hybrid_severities: dict[str, list[float]]  # of each perturbation, picture_NAME or imprint_NAME, of one sense
