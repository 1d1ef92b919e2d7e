"""Attention of networks: Grad-CAM maps fused over tasks, projected to the surface, compared with human gaze (T3.3)."""

from dataclasses import dataclass

from stages.engine.settings import setting

COLUMNS = {
    "task": "what the networks name: a group of shapes, a level of meaning, a fusion of several (ewigc), or two tasks",
    "view": "the number of one of the three evaluated views, or all",
    "clusters": "of metric ssd: the number of clusters tried",
    "chosen": "of metric ssd: whether the task has this number of classes",
    "label": "of metric class: the name of the item's class in the task",
}


def _projection():
    from stages.fixation.places import PROJECTIONS

    return PROJECTIONS


def _methods():
    from stages.fixation.backbone import method_named

    return method_named


@dataclass
class Params:
    """From where the networks look at the objects, which networks, and how they learn."""

    parallels: int = setting(
        3,
        "circles of viewpoints between the poles, an odd number; the thesis's 9 are in profile=paper (T3.3.2)",
        least=1,
    )
    azimuths: int = setting(
        9,
        "viewpoints on each circle, a multiple of three; the thesis's 24 are in profile=paper",
        least=1,
    )
    size: int = setting(224, "pixels a side of the pictures", least=1)
    projection: str = setting(
        "camera",
        "of maps to vertices: camera (to a fraction of a pixel) or boxes (as T3.3.5 prints)",
        names=_projection,
    )
    methods: list[str] = setting(
        ["mobilenet_v2-frozen", "mobilenet_v2-random"],
        "NETWORK-MODE; modes: frozen (a new head alone learns), last_block, finetuned (all), or random as the control",
        names=_methods,
    )
    source: str = setting(
        "package",
        "ImageNet's weights: package (by hash), download (torchvision's own) or auto (a package where there is one)",
    )
    device: str = setting("cpu", "what the networks run on: cpu, cuda, or auto (a CUDA card where there is one)")
    penalties: list[float] = setting(
        [0.001, 0.1],
        "inverse strengths of regularisation tried for the heads on the validation views",
        above=0,
    )
    folds: int = setting(5, "parts into which whole objects are held out", least=2)
    rate: float = setting(0.003, "learning rate of mode finetuned", above=0)
    rates: list[float] = setting(
        [0.001, 0.003, 0.01],
        "learning rates of mode last_block, tried on the validation views",
        above=0,
    )
    epochs: int = setting(2, "passes of modes last_block and finetuned", least=1)
    batch: int = setting(32, "images a step of these modes (T3.3.2)", least=1)
    momentum: float = setting(0.9, "of their stochastic gradient descent", least=0, most=1)
