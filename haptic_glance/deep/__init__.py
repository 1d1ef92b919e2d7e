"""Image networks: architectures, ImageNet weights, training, Grad-CAM, and the hybrid network of both senses (T5)."""

from typing import TYPE_CHECKING

from haptic_glance.base.lazy import lazy_names

if TYPE_CHECKING:
    from haptic_glance.base.lazy import lazy_names

    from .cam import grad_cam
    from .hybrid import HybridNet
    from .images import augmentation, normalise, to_images
    from .modes import MODES, Task, mode_named
    from .network import NETWORKS, Network, build, count_parameters, imagenet_classifier, recalibrate
    from .training import accuracy, predict_probabilities, search_rate, train_model
    from .weights import available_weights, imagenet_state

_MODULES = {
    "HybridNet": "hybrid",
    "MODES": "modes",
    "NETWORKS": "network",
    "Network": "network",
    "Task": "modes",
    "accuracy": "training",
    "augmentation": "images",
    "available_weights": "weights",
    "build": "network",
    "count_parameters": "network",
    "grad_cam": "cam",
    "imagenet_classifier": "network",
    "imagenet_state": "weights",
    "lazy_names": "lazy",
    "mode_named": "modes",
    "normalise": "images",
    "predict_probabilities": "training",
    "recalibrate": "network",
    "search_rate": "training",
    "to_images": "images",
    "train_model": "training",
}
__all__ = [
    "HybridNet", "MODES", "NETWORKS", "Network", "Task", "accuracy", "augmentation", "available_weights", "build",
    "count_parameters", "grad_cam", "imagenet_classifier", "imagenet_state", "lazy_names", "mode_named",
    "normalise", "predict_probabilities", "recalibrate", "search_rate", "to_images", "train_model",
]  # fmt: skip
__getattr__ = lazy_names(__name__, _MODULES)
