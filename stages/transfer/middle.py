"""The shared middle of two networks, in the layer numbers of Matlab and torchvision (T5.5)."""

from haptic_glance.deep.modes import frozen_modules
from haptic_glance.deep.network import build


def middle_of(layers: str) -> tuple[int, int]:
    """(start, stop) of the parts of torchvision's `features` that a range of Matlab's layers such as `18:139` covers.

    Raises ValueError for a range that divides a part, or that leaves none before or after it: networks cannot be
    stitched there.
    """
    network = build("mobilenet_v2", 2, "random", 0)
    wanted = set(frozen_modules(layers, network))
    parts = sorted({int(name.split(".")[1]) for name in wanted})
    start, stop = (parts[0], parts[-1] + 1) if parts else (0, 0)
    whole = {
        name
        for name, module in network.named_modules()
        if name.startswith("convolutions.") and start <= int(name.split(".")[1]) < stop
        if any(True for _ in module.parameters(recurse=False))
    }
    if wanted != whole or not 0 < start < stop < len(network.convolutions):
        raise ValueError(
            f"layers {layers} are not whole blocks of mobilenet_v2 with layers on both sides, as 18:139 are"
        )
    return start, stop
