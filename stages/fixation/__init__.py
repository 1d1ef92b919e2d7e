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

    parallels: int
    azimuths: int
    size: int
    projection: str
    methods: list[str]
    source: str
    device: str
    penalties: list[float]
    folds: int
    rate: float
    rates: list[float]
    epochs: int
    batch: int
    momentum: float
