"""The channels by name, and their conspicuity maps of a view, all at one size."""

from collections.abc import Iterable, Sequence
from functools import partial

import numpy as np

from haptic_glance.base.lazy import cv2
from haptic_glance.base.weak_cache import weak_cache
from haptic_glance.mesh.mesh import Mesh

from ..views import View
from .colour import color, dkl, intensity
from .curvature import curvature
from .operators import OUTPUT_SCALE
from .printed import OURS, Channel, check_formulas, printed_channels
from .symmetry import symmetry
from .texture import contrast, edge, entropy, fine_grained, orientation, spectral_residual

CHANNELS = {
    "color": color,
    "contrast": contrast,
    "curvature": curvature,
    "dkl": dkl,
    "edge": edge,
    "entropy": entropy,
    "intensity": intensity,
    "orientation": orientation,
    "symmetry": symmetry,
}
# In addition to the nine of T table 3.1: each kind of symmetry alone (T3.1.5), and two saliency maps of OpenCV.
OTHERS = {
    "symmetry_lateral": partial(symmetry, kinds=("lateral",)),
    "symmetry_radial": partial(symmetry, kinds=("radial",)),
    "spectral_residual": spectral_residual,
    "fine_grained": fine_grained,
}
MAPS = CHANNELS | OTHERS
# In place of the channels of symmetry where `conspicuity.symmetry` is `strongest`.
STRONGEST = {
    "symmetry": partial(symmetry, strongest=True),
    "symmetry_lateral": partial(symmetry, kinds=("lateral",), strongest=True),
    "symmetry_radial": partial(symmetry, kinds=("radial",), strongest=True),
}
PERCEIVED = "perceived"
SYMMETRIES = {PERCEIVED: {}, "strongest": STRONGEST}  # setting: the channels that it replaces
REDUCTION = 4  # the default size of a map is the view's over this


def conspicuity(
    mesh: Mesh,
    view: View,
    channels: str | Iterable[str] | None = None,
    size: Sequence[int] | None = None,
    filled: bool = True,
    symmetry: str = PERCEIVED,
    formulas: str = OURS,
) -> dict[str, np.ndarray]:
    """The conspicuity maps of a view (T3.1.1, T3.2).

    Parameters
    ----------
    mesh : Mesh or any input of `as_mesh`
        The normalised mesh.
    view : View
        A view of this mesh, from `render`.
    channels : str or iterable of str, optional
        A name or names out of CHANNELS and `haptic_glance.look.channels.OTHERS`. None: the nine of CHANNELS.
    size : sequence of 2 ints, optional
        Rows and columns of the maps. None: a quarter of the view's.
    filled : bool
        True keeps the background out of the filters (`haptic_glance.look.channels.cropped_view`), False leaves it in,
        for comparison. The two maps of OpenCV use the image as rendered in either case.
    symmetry : {"perceived", "strongest"}
        `perceived`: only symmetries that people see. `strongest`: the best plane and axis of each object, however weak.
    formulas : {"ours", "printed", "mended", "zero_mean"}
        All but `ours` are readings of the thesis's formulas, and need the background
        (`haptic_glance.look.channels.printed`).

    Returns
    -------
    dict of str to (h, w) array of float
        Map of each channel in 0..1, zero off the object.

    Raises
    ------
    ValueError
        For an unknown channel, a size without pixels, formulas that do not go with the background, or a view of another
        mesh.

    Notes
    -----
    With `ours`, N(.) is finally applied to each map as a whole, as Itti 1998 brings channels to one scale before their
    sum, so that the highest value of a map says how much it stands out.

    References
    ----------
    Itti, Koch and Niebur, A model of saliency-based visual attention for rapid scene analysis, IEEE Transactions on
    Pattern Analysis and Machine Intelligence 20(11), 1998.

    Examples
    --------
    >>> import trimesh
    >>> from haptic_glance import Viewpoint, conspicuity, normalise, render
    >>> cube = normalise(trimesh.creation.box())
    >>> view = render(cube, Viewpoint(30, 20), size=(90, 120))
    >>> {name: image.shape for name, image in conspicuity(cube, view, ["edge"]).items()}
    {'edge': (22, 30)}
    """
    check_formulas(formulas, filled)
    if symmetry not in SYMMETRIES:
        raise ValueError(f"unknown symmetry {symmetry!r}: choose one of {', '.join(SYMMETRIES)}")
    names = list(CHANNELS) if channels is None else check_channels(channels)
    size = tuple(max(side // REDUCTION, 1) for side in view.mask.shape) if size is None else tuple(size)
    if len(size) != 2 or min(size) < 1:
        raise ValueError(f"the size of the maps must be (rows, columns), each at least 1, got {size}")
    maps: dict[str, Channel] = MAPS | SYMMETRIES[symmetry]
    if not view.mask.any():
        return {name: np.zeros(size, dtype=np.float32) for name in names}
    inside = mask_at_size(view.mask, size)
    maps = maps if formulas == OURS else printed_channels(maps, formulas)
    return {name: resize_map(maps[name](mesh, view, filled), view.mask.shape, size) * inside for name in names}


def check_channels(names: str | Iterable[str]) -> list[str]:
    """The names, or the single one, as a list; ValueError for a name that is not in MAPS."""
    names = [names] if isinstance(names, str) else list(names)
    unknown = [name for name in names if name not in MAPS]
    if unknown:
        raise ValueError(f"unknown channel {', '.join(map(str, unknown))}: choose from {', '.join(MAPS)}")
    return names


@weak_cache  # the channels of a view share its mask
def mask_at_size(mask: np.ndarray, size: tuple[int, int]) -> np.ndarray:
    """A mask (h, w) at another size (rows, columns): boolean, at least half of the pixel's area is on the object."""
    return cv2.resize(mask.astype(np.float32), size[::-1], interpolation=cv2.INTER_AREA) >= 0.5


def resize_map(values: np.ndarray, shape: tuple[int, int], size: tuple[int, int]) -> np.ndarray:
    """A channel's map, on a pyramid level of a view of `shape`, interpolated to another size (h', w').

    Pixel k of the map lies on pixel k * 2**scale of the view. The pixels of the result divide the view evenly.
    """
    sides = [tuple(-(-side // 2**s) for side in shape) for s in range(OUTPUT_SCALE + 1)]
    scale = max(s for s in range(OUTPUT_SCALE + 1) if sides[s] == values.shape)
    for finer in range(scale - 1, 1, -1):
        values = cv2.pyrUp(values, dstsize=sides[finer][::-1])
    step = 2 ** min(scale, 2)
    ratio = np.array(shape[::-1]) / np.array(size[::-1])
    ahead = (ratio - 1) / 2 / step
    matrix = np.array([[ratio[0] / step, 0, ahead[0]], [0, ratio[1] / step, ahead[1]]])
    flags = cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP
    return cv2.warpAffine(values, matrix, size[::-1], flags=flags, borderMode=cv2.BORDER_REPLICATE)
