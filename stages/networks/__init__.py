"""What the stages that use image networks share: architectures, ImageNet weights, inputs and training.

This is not a stage. It is separate from the kit so that a change here affects only the stages that use it.
"""

from stages.kit.lazy import lazy_names

_MODULES = {  # public name -> its module
    "Network": "network",
    "NETWORKS": "network",
    "build": "network",
    "recalibrate": "network",
    "count_parameters": "network",
    "imagenet_classifier": "network",
    "MODES": "modes",
    "Task": "modes",
    "mode_named": "modes",
    "imagenet_state": "weights",
    "available_weights": "weights",
    "to_images": "images",
    "normalise": "images",
    "augmentation": "images",
    "train_model": "training",
    "search_rate": "training",
    "predict_probabilities": "training",
    "accuracy": "training",
}
__all__ = list(_MODULES)  # pyright: ignore[reportUnsupportedDunderAll]
__getattr__ = lazy_names(__name__, _MODULES)
