"""The door: nine conspicuity maps of many views, on one device."""

import numpy as np
import torch

from ..channels import CHANNELS, SHARE, coverage
from ..contrast import FLOOR as CONTRAST_FLOOR
from ..operators import CENTRES, COMMON, FLOOR, SCALES
from ..surface import FLOOR as SURFACE_FLOOR
from . import frame, pixels, surface
from .peaks import centre_surround, normalise
from .stack import Stack

PYRAMIDS = {"color": pixels.color, "dkl": pixels.dkl, "intensity": pixels.intensity, "orientation": pixels.orientation}
SURFACE = {"curvature": surface.curvature, "symmetry": surface.symmetry}
AT_ONCE = {"cpu": 1, "cuda": 32}  # views: a CPU is faster within its cache, a GPU has some 0.2 GB a view to spare
LOCAL = {"contrast": pixels.contrast, "edge": pixels.edge, "entropy": pixels.entropy}


@torch.inference_mode()
def conspicuity_batch(mesh, views, channels=None, size=None, device="cpu"):
    """The conspicuity maps of several views of a mesh: {channel: (v, h', w') f4 in 0..1}, zero off the object.

    mesh: stages.kit.Mesh; views: list of stages.views.View of it, of one image size; channels: names out of CHANNELS,
    None for all nine; size: (rows, columns) of the maps, by default a quarter of the views'; device: "cpu", "cuda" or
    a torch.device. The same maps as stages.conspicuity.conspicuity, view by view, to within 1e-3; they differ where
    sums are taken in another order (see below). Between the views and the maps nothing comes back to the host, but for
    one yes or no a round while plateaus are counted (peaks.one_of_each) and the number of windows of the entropy.

    N(.) counts local maxima, and where neighbours are as high to the last bit, as along the edge of a box, that bit
    decides how many there are: there the height of the map may differ by more.
    Raises ValueError for an unknown channel, views of different sizes or of another mesh, a device that is not there.
    """
    names = list(CHANNELS) if channels is None else list(channels)
    if set(names) - set(CHANNELS):
        raise ValueError(f"the batch works out {', '.join(CHANNELS)}, got {', '.join(map(str, names))}")
    device, shape = _check_device(device), _check_views(mesh, views)
    size = tuple(max(side // SHARE, 1) for side in shape) if size is None else tuple(size)
    if len(size) != 2 or min(size) < 1:
        raise ValueError(f"the size of the maps must be (rows, columns), each at least 1, got {size}")
    maps = np.zeros((len(names), len(views), *size), dtype=np.float32)
    shown = [k for k, view in enumerate(views) if view.mask.any()] if names else []
    for first in range(0, len(shown), AT_ONCE[device.type]):
        some = shown[first : first + AT_ONCE[device.type]]
        stack = Stack([views[k] for k in some], device)
        found = frame.fit(stack, _crop_maps(mesh, stack, names), size).cpu().numpy()
        maps[:, some] = found.transpose(1, 0, 2, 3) * np.stack([coverage(views[k].mask, size) for k in some])
    return dict(zip(names, maps, strict=True))


def _crop_maps(mesh, stack, names):
    """(v, len(names), h, w): the maps of the crops at scale 4, through N(.) as a whole."""
    maps = {name: LOCAL[name](stack) for name in names if name in LOCAL}
    levels = {name: PYRAMIDS[name](stack) for name in names if name in PYRAMIDS}
    if set(names) & set(SURFACE):
        seen = surface.Seen(stack, mesh)
        levels |= {name: SURFACE[name](seen) for name in names if name in SURFACE}
    maps |= _surrounded(stack, levels) if levels else {}
    floors = [CONTRAST_FLOOR if name == "contrast" else FLOOR for name in names]
    return normalise(torch.cat([maps[name] for name in names], 1), stack.cover[COMMON], _floors(stack, floors))


def _surrounded(stack, levels):
    """{name: (v, 1, h, w)}: centre-surround of all pyramids {name: {2..8: (v, c, h, w)}} at once, summed by channel."""
    counts = [each[CENTRES[0]].shape[1] for each in levels.values()]
    stacked = {scale: torch.cat([each[scale] for each in levels.values()], 1) for scale in range(CENTRES[0], SCALES)}
    floors = np.repeat([SURFACE_FLOOR if name in SURFACE else FLOOR for name in levels], counts)
    on_centre = torch.tensor(np.repeat([name == "curvature" for name in levels], counts), device=stack.device)
    summed = centre_surround(stack.grid, stacked, stack.cover, _floors(stack, floors), on_centre)
    parts = dict(zip(levels, summed.split(counts, 1), strict=True))
    if "orientation" in parts:  # T eq. 3.2: every angle goes through N(.) before they add up
        angles = parts["orientation"]
        parts["orientation"] = normalise(angles, stack.cover[COMMON], _floors(stack, [FLOOR] * angles.shape[1]))
    return {name: part.sum(1, keepdim=True) for name, part in parts.items()}


def _floors(stack, values):
    return torch.tensor(np.asarray(values, dtype=np.float32), device=stack.device)


def _check_device(device):
    device = torch.device(device)
    if device.type not in ("cpu", "cuda"):
        raise ValueError(f"device must be cpu or cuda, got {device}")
    if device.type == "cuda" and not torch.cuda.is_available():
        raise ValueError("torch finds no CUDA device here: use device='cpu', or a torch built for CUDA")
    return device


def _check_views(mesh, views):
    """The image size (h, w) that the views have in common."""
    if not len(views):
        raise ValueError("no views: hand in at least one")
    shapes = {view.mask.shape for view in views}
    if len(shapes) > 1:
        raise ValueError(f"the views have different image sizes {sorted(shapes)}: map those of one size at a time")
    highest = max(view.face.max(initial=-1) for view in views)
    if highest >= len(mesh.faces):
        raise ValueError(f"a view shows face {highest}, the mesh has {len(mesh.faces)} faces: render this mesh again")
    return shapes.pop()
