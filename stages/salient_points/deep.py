"""Maps of a network for photographs on the surface: MobileNetV2 looks at pictures from around the object.

They are further features of the method `glance_deep`. The weights of the network are those of ImageNet (Sandler et al.,
MobileNetV2: Inverted Residuals and Linear Bottlenecks, CVPR 2018). Needs the extra `deep`; the weights are
fetched once.
"""

from functools import cache

import numpy as np
from scipy import ndimage

from stages.glance import Samples
from stages.kit import Mesh, Viewpoint
from stages.kit.camera import project
from stages.kit.extras import from_extra
from stages.views import render
from stages.weights.published import MAPS

BLOCK = 13  # of MobileNetV2: the last one with maps of a sixteenth of the side of the picture
SIZE = 384  # pixels a side: maps of 24 x 24
AROUND = tuple(22.5 + 45.0 * k for k in range(8))  # degrees from the longest axis: alike on both sides of its planes
NEAR = 1.5  # spacings behind the surface that a picture shows, up to which a sample is on it
UNSEEN = 0.1  # a place that is seen by views of this sum of cosines is half way to the mean of the object
DEVIATION = 0.29  # of a map on a typical object: the median over 33 objects, of each map 0.21 to 0.37
LIMIT = 4.0  # standard deviations; what lies farther out counts as this


def standardised_maps(mesh: Mesh, samples: Samples) -> dict[str, np.ndarray]:
    """dict name of MAPS -> (s,) f8: the maps with mean 0 and deviation 1, or less where one hardly varies.

    The colours of the mesh are left out. Raises MissingExtra without torch, FetchError without the weights.
    """
    values = maps_on_surface(mesh, samples)
    centred = values - samples.shares @ values
    deviations = np.maximum(np.sqrt(samples.shares @ centred**2), DEVIATION / 2)
    return dict(zip(MAPS, (centred / deviations).clip(-LIMIT, LIMIT).T, strict=True))


def maps_on_surface(mesh: Mesh, samples: Samples) -> np.ndarray:
    """(s, C) f8: the mean of each map over the views that see a sample, by the cosine at which they see it.

    The views and their frame belong to the object's own axes, and each picture is also looked at in a mirror, so that
    neither the place and size of the object nor a turn about the vertical nor a reflection changes the maps.
    """
    with from_extra("glance_deep needs torch, which "):
        import torch

        trunk = _trunk()
    middle, radius = _frame(mesh, samples)
    framed = Mesh((mesh.vertices - middle) / (2 * radius), mesh.faces)
    points, spacing = (samples.points - middle) / (2 * radius), samples.spacing / (2 * radius)
    first = np.degrees(np.arctan2(samples.axes[0, 1], samples.axes[0, 0]))
    total, seen = 0.0, np.zeros(len(samples.points))
    for azimuth in AROUND:
        viewpoint = Viewpoint(first + azimuth, 0)
        view = render(framed, viewpoint, (SIZE, SIZE), "raster")
        rows, columns, depths = project(points, viewpoint, (SIZE, SIZE))
        nearest = ndimage.maximum_filter(np.where(view.mask, view.depth, 0), 3)
        pixel = np.rint([rows, columns]).astype(np.int64).clip(0, SIZE - 1)
        weight = (samples.normals @ viewpoint.axes[2]).clip(0) * (depths < nearest[*pixel] + NEAR * spacing)
        places = torch.from_numpy(np.stack([2 * columns + 1, 2 * rows + 1], axis=1) / SIZE - 1).float()
        maps = _maps(trunk, torch.from_numpy(view.rgb))
        found = torch.nn.functional.grid_sample(maps, places[None, :, None], padding_mode="border", align_corners=False)
        total = total + weight[:, None] * found[0, :, :, 0].T.numpy()
        seen += weight
    by_area = samples.shares @ total / max(samples.shares @ seen, 1e-9)
    return (total + UNSEEN * by_area) / (seen + UNSEEN)[:, None]


def _frame(mesh, samples):
    """(middle (3,) of the box along the object's own axes, distance of the farthest corner of a face from it)."""
    corners = mesh.vertices[mesh.used]
    inside = (corners - samples.middle) @ samples.axes.T
    middle = samples.middle + (inside.min(axis=0) + inside.max(axis=0)) / 2 @ samples.axes
    return middle, np.linalg.norm(corners - middle, axis=1).max()


def _maps(trunk, picture):
    """(1, C, i, j) f4: the mean of the maps of a picture (h, w, 3) u1 and of its mirror image, mirrored back."""
    import torch

    from stages.networks import normalise

    image = normalise(picture.permute(2, 0, 1)[None].float() / 255)
    with torch.inference_mode():
        maps = trunk(torch.cat([image, image.flip(3)]))
    return (maps[:1] + maps[1:].flip(3)) / 2


@cache
def _trunk():
    """The blocks of the network up to BLOCK, their normalisations folded into the convolutions."""
    from torch.fx.experimental.optimization import fuse

    from stages.networks import build

    return fuse(build("mobilenet_v2", 2, "imagenet", 0).convolutions[: BLOCK + 1])
