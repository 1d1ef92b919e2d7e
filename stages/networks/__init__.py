"""What the stages with a network for photographs share: architectures, ImageNet's weights, inputs, training.

No stage: like the kit, and apart from it, so that a change here makes only those stages run again that use it.
"""

from importlib import import_module

_HOME = {
    "Network": "network",
    "NETWORKS": "network",
    "build": "network",
    "settle": "network",
    "parameters": "network",
    "imagenet_classifier": "network",
    "MODES": "modes",
    "Task": "modes",
    "mode_named": "modes",
    "imagenet_state": "weights",
    "had": "weights",
    "to_images": "images",
    "normalise": "images",
    "augmentation": "images",
    "learn": "training",
    "search": "training",
    "scores": "training",
    "accuracy": "training",
}
__all__ = list(_HOME)


def __getattr__(name):
    # torch takes seconds to import, and whoever reads only the schema does without it.
    if name in _HOME:
        return getattr(import_module(f".{_HOME[name]}", __name__), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
