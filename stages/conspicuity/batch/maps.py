"""The nine conspicuity maps of a batch of views, on one device."""

from collections.abc import Iterable, Sequence

import numpy as np
import torch

from stages.kit import Mesh
from stages.views import View

from ..channels import CHANNELS, REDUCTION, mask_at_size
from ..contrast import FLOOR as CONTRAST_FLOOR
from ..operators import CENTRES, FLOOR, OUTPUT_SCALE, SCALES
from ..surface import FLOOR as SURFACE_FLOOR
from . import pixels, resize, surface
from .peaks import centre_surround, normalise
from .stack import Stack

PYRAMIDS = {"color": pixels.color, "dkl": pixels.dkl, "intensity": pixels.intensity, "orientation": pixels.orientation}
SURFACE = {"curvature": surface.curvature, "symmetry": surface.symmetry}
BATCH = {"cpu": 1, "cuda": 32}  # views: a CPU is faster within its cache, a GPU needs about 0.2 GB per view
LOCAL = {"contrast": pixels.contrast, "edge": pixels.edge, "entropy": pixels.entropy}


@torch.inference_mode()
def conspicuity_batch(
    mesh: Mesh,
    views: Sequence[View],
    channels: Iterable[str] | None = None,
    size: Sequence[int] | None = None,
    device: str | torch.device = "cpu",
) -> dict[str, np.ndarray]:
    """The conspicuity maps of several views of a mesh: {channel: (v, h', w') f4 in 0..1}, zero off the object.

    views: of this mesh, of one image size. channels: names out of CHANNELS, None for all nine. size: (rows, columns)
    of the maps, by default a quarter of the views'. device: "cpu", "cuda" or a torch.device.

    The maps agree with stages.conspicuity.conspicuity to within 1e-3, since sums are taken in another order. N(.)
    counts local maxima: where neighbours are equal up to the last bit, as along the edge of a box, this bit decides
    their number, and the height of the map may differ by more. Intermediate results stay on the device, except one
    boolean per iteration of peaks.one_per_plateau and the number of windows of the entropy.

    Raises ValueError for an unknown channel, views of different sizes or of another mesh, or an unavailable device.
    """
    names = list(CHANNELS) if channels is None else list(channels)
    if set(names) - set(CHANNELS):
        raise ValueError(f"unknown channel in {', '.join(map(str, names))}: choose from {', '.join(CHANNELS)}")
    device, shape = _check_device(device), _check_views(mesh, views)
    size = tuple(max(side // REDUCTION, 1) for side in shape) if size is None else tuple(size)
    if len(size) != 2 or min(size) < 1:
        raise ValueError(f"the size of the maps must be (rows, columns), each at least 1, got {size}")
    maps = np.zeros((len(names), len(views), *size), dtype=np.float32)
    shown = [k for k, view in enumerate(views) if view.mask.any()] if names else []
    for first in range(0, len(shown), BATCH[device.type]):
        some = shown[first : first + BATCH[device.type]]
        stack = Stack([views[k] for k in some], device)
        found = resize.resize_maps(stack, _crop_maps(mesh, stack, names), size).cpu().numpy()
        maps[:, some] = found.transpose(1, 0, 2, 3) * np.stack([mask_at_size(views[k].mask, size) for k in some])
    return dict(zip(names, maps, strict=True))


def _crop_maps(mesh, stack, names):
    """(v, len(names), h, w): the maps of the crops at scale 4, after N(.) of each map as a whole."""
    maps = {name: LOCAL[name](stack) for name in names if name in LOCAL}
    levels = {name: PYRAMIDS[name](stack) for name in names if name in PYRAMIDS}
    if set(names) & set(SURFACE):
        seen = surface.VisibleSurface(stack, mesh)
        levels |= {name: SURFACE[name](seen) for name in names if name in SURFACE}
    maps |= _centre_surround_maps(stack, levels) if levels else {}
    floors = [CONTRAST_FLOOR if name == "contrast" else FLOOR for name in names]
    return normalise(torch.cat([maps[name] for name in names], 1), stack.cover[OUTPUT_SCALE], _floors(stack, floors))


def _centre_surround_maps(stack, levels):
    """{name: (v, 1, h, w)}: centre-surround of all pyramids {name: {2..8: (v, c, h, w)}}, summed by channel."""
    counts = [each[CENTRES[0]].shape[1] for each in levels.values()]
    stacked = {scale: torch.cat([each[scale] for each in levels.values()], 1) for scale in range(CENTRES[0], SCALES)}
    floors = np.repeat([SURFACE_FLOOR if name in SURFACE else FLOOR for name in levels], counts)
    on_centre = torch.tensor(np.repeat([name == "curvature" for name in levels], counts), device=stack.device)
    summed = centre_surround(stack.grid, stacked, stack.cover, _floors(stack, floors), on_centre)
    parts = dict(zip(levels, summed.split(counts, 1), strict=True))
    if "orientation" in parts:  # T eq. 3.2: N(.) of each angle, then the sum
        angles = parts["orientation"]
        parts["orientation"] = normalise(angles, stack.cover[OUTPUT_SCALE], _floors(stack, [FLOOR] * angles.shape[1]))
    return {name: part.sum(1, keepdim=True) for name, part in parts.items()}


def _floors(stack, values):
    return torch.tensor(np.asarray(values, dtype=np.float32), device=stack.device)


def _check_device(device):
    device = torch.device(device)
    if device.type not in ("cpu", "cuda"):
        raise ValueError(f"device must be cpu or cuda, got {device}")
    if device.type == "cuda" and not torch.cuda.is_available():
        raise ValueError("torch finds no CUDA device: use device='cpu', or install a torch built for CUDA")
    return device


def _check_views(mesh, views):
    """The image size (h, w) that the views have in common."""
    if not len(views):
        raise ValueError("no views: give at least one")
    shapes = {view.mask.shape for view in views}
    if len(shapes) > 1:
        raise ValueError(f"the views have different image sizes {sorted(shapes)}: give views of one size")
    highest = max(view.face.max(initial=-1) for view in views)
    if highest >= len(mesh.faces):
        raise ValueError(f"a view shows face {highest}, the mesh has {len(mesh.faces)} faces: render this mesh again")
    return shapes.pop()
