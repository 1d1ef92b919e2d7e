"""The settings of the transfer stage."""

from dataclasses import dataclass


@dataclass
class Params:
    touches: int  # imprints an object: its salient points first, then blind ones
    detector: str  # which salient points come first, one of classes.methods
    cells: int  # sensels a side of the pressure array
    pitch: float  # distance of two sensels; times cells it is the sensor's width, 1 is the object's diameter
    coarse_cells: list[int]  # sensels a side of other arrays, as wide: no control, no range of layers, no stability
    networks: list[str]  # architectures, names of stages.networks.NETWORKS
    weights: list[str]  # start from imagenet, or from random as the control
    source: str  # where ImageNet's weights come from: package (by hash), download (torchvision's) or auto
    modes: list[str]  # frozen: only the new head learns; finetuned: all layers; 18:139: all but those of mobilenet_v2
    splits: list[str]  # random: touches are drawn for testing (T5.1.3); objects: one object of each class is left out
    size: int  # pixels a side of the image that the network sees
    copies: int  # augmented copies of each image whose frozen features are cached
    train_share: float  # part of the touches for training where the split is random, the rest for testing
    validation_share: float  # part of the training touches that chooses the learning rate
    frozen_rates: list[float]  # learning rates tried for the head alone
    finetuned_rates: list[float]  # learning rates tried where convolutions learn
    search_epochs: int  # passes of each tried rate
    epochs: int  # passes of the final training
    batch: int  # images a step
    momentum: float  # of the stochastic gradient descent
    repetitions: int  # trainings of each kind, each with its own split and random numbers
    coarse_repetitions: int  # the same with the coarse arrays
    device: str  # where networks are trained: auto (a CUDA card where there is one), cpu, cuda
    severities: dict[str, list[float]]  # of each perturbation of the test touches, from mild to harsh
    hybrid_middles: list[str]  # layers that both senses share in a hybrid network; damage is tried on the first
    hybrid_repetitions: int  # hybrid networks a split; 0: none
    hybrid_pictures: int  # looks at each object
    hybrid_colour: bool  # pictures in the objects' colours, which may give them away; else grey clay
    hybrid_rate: float  # learning rate of its two networks
    hybrid_onnx: bool  # also write the first network as ONNX
    hybrid_severities: dict[str, list[float]]  # of each perturbation, picture_NAME or imprint_NAME, of one sense
