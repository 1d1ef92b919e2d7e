"""Image networks: architectures, ImageNet weights, training, Grad-CAM, and the hybrid network of both senses (T5)."""

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .hybrid import HybridNet

__all__ = ["HybridNet"]


def __getattr__(name: str) -> Any:
    """Imports the network when it is first asked for, since not all of this package needs PyTorch."""
    if name == "HybridNet":
        from .hybrid import HybridNet

        return HybridNet
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
