"""Attention of networks: Grad-CAM maps fused over tasks, projected to the surface, compared with human gaze (T3.3)."""

from dataclasses import dataclass

COLUMNS = {
    "task": "what the networks name: a group of shapes, a level of meaning, a fusion of several (ewigc), or two tasks",
    "view": "the number of one of the three evaluated views, or all",
    "clusters": "of metric ssd: the number of clusters tried",
    "chosen": "of metric ssd: whether the task has this number of classes",
    "label": "of metric class: the name of the item's class in the task",
}


@dataclass
class Params:
    """From where the networks look at the objects, which networks, and how they learn."""

    parallels: int  # circles of viewpoints between the poles, an odd number (T3.3.2: 9)
    azimuths: int  # viewpoints on each circle, a multiple of three (T3.3.2: 24)
    size: int  # pixels a side of the pictures
    projection: str  # of maps to vertices: camera (to a fraction of a pixel) or boxes (as T3.3.5 prints)
    methods: list[str]  # NETWORK-MODE; modes: frozen (a new head alone learns), last_block, finetuned (all), random
    source: str  # where ImageNet's weights come from: package (by hash), download (torchvision's) or auto
    device: str  # what the networks run on: cpu, cuda, or auto (a CUDA card where there is one)
    penalties: list[float]  # inverse strengths of regularisation tried for the heads on the validation views
    folds: int  # parts into which whole objects are held out
    rate: float  # learning rate of mode finetuned
    rates: list[float]  # learning rates of mode last_block, tried on the validation views
    epochs: int  # passes of modes last_block and finetuned
    batch: int  # images a step of these modes (T3.3.2: 32)
    momentum: float  # of their stochastic gradient descent
