"""The methods `glance`, `glance_any_pose` and `glance_deep`: the fixation density of small cells of the surface.

`glance_deep` adds maps of a network for photographs: MobileNetV2 (Sandler et al., MobileNetV2: Inverted Residuals and
Linear Bottlenecks, CVPR 2018) with the weights of ImageNet looks at pictures from around the object. It needs the extra
`deep`; the weights are fetched once.
"""

from abc import ABC, abstractmethod
from collections.abc import Callable
from functools import cache
from typing import Any, NamedTuple

import numpy as np
from scipy import ndimage
from scipy.spatial import KDTree

from haptic_glance.base.extras import from_extra
from haptic_glance.mesh.mesh import Mesh

from ..camera import Viewpoint, project
from ..glance import Samples, samples_of_mesh, standardised
from ..rivals.maxima import local_maxima
from ..views import render
from ..weights import fixation_density
from ..weights.attention import standardise
from ..weights.weights import MAPS
from .detectors import scaled
from .fuse import continue_on_surface
from .options import ROUNDING, Detection, Options, by_place, tied, visited

CORNERS = 8  # vertices that may be equally near to a sample: the corners of a face or a box around its middle
NO_FACES = np.zeros((0, 3), dtype=np.int64)
Features = Callable[[Mesh, Samples], dict[str, np.ndarray]]


def cell_features(mesh: Mesh, samples: Samples) -> dict[str, np.ndarray]:
    """dict name -> (s,) f8: the features of haptic_glance.look.glance."""
    return standardised(samples)


def deep_features(mesh: Mesh, samples: Samples) -> dict[str, np.ndarray]:
    """dict name -> (s,) f8: the features of haptic_glance.look.glance and the maps of a network; needs the extra
    `deep`.
    """
    return standardised_maps(mesh, samples) | standardised(samples)


class Seen(NamedTuple):
    """A mesh as a SampledDetector sees it, the same for every count.

    smooth (s,): of the samples. saliency, smoothed (n,) f8 in 0..1: the values and the smooth values at the vertices.
    """

    samples: Samples
    smooth: np.ndarray
    saliency: np.ndarray
    smoothed: np.ndarray


class SampledDetector(ABC):
    """A detector that looks at cells of the surface, so that neither the faces nor noise decide what it finds."""

    channels: tuple[str, ...] = ()
    required_weights: str | None = None

    @abstractmethod
    def _values(self, mesh: Mesh, options: Options) -> tuple[Samples, np.ndarray]:
        """(samples, their values (s,), above 0)."""

    def _smooth(self, samples: Samples, values: np.ndarray, _options: Options) -> np.ndarray:
        """(s,) the smooth values whose peaks are the points."""
        return values

    def _vertices(self, mesh: Mesh, samples: Samples, ids: np.ndarray) -> np.ndarray:
        """(k,) the vertices that stand for the samples of these ids (k,)."""
        return nearest_vertices(mesh, mesh.vertices[mesh.used], samples.points[ids])

    def saliency(self, mesh: Mesh, view_maps: Any, options: Options) -> np.ndarray:
        """(n,) f8 in 0..1, the largest 1; zeros for a mesh without area."""
        if not mesh.face_areas.sum() > 0:
            return np.zeros(len(mesh.vertices))
        samples, values = self._values(mesh, options)
        return _on_vertices(mesh, samples, values)[0]

    def seen(self, mesh: Mesh, options: Options) -> Seen | None:
        """The samples and values that `find` uses for every count; None without area."""
        if not mesh.face_areas.sum() > 0:
            return None
        samples, values = self._values(mesh, options)
        smooth = self._smooth(samples, values, options)
        return Seen(samples, smooth, *_on_vertices(mesh, samples, values, smooth))

    def find(self, mesh: Mesh, view_maps: Any, options: Options, count: int | None = None) -> Detection:
        """The Detection: strong points are high peaks of the smooth values; a count visits more places.

        view_maps: a Seen of the same mesh and options spares the work of `seen`; anything else is not looked at.
        """
        surface = view_maps if isinstance(view_maps, Seen) else self.seen(mesh, options)
        if surface is None:
            return Detection(np.zeros(0, dtype=np.int64), 0, np.zeros(len(mesh.vertices)))
        samples, smooth = surface.samples, surface.smooth
        is_high = standardise(smooth, samples.areas) > 1
        peaks = local_maxima(Mesh(samples.points, NO_FACES), smooth, options.radius, is_high)
        peaks = peaks[by_place(tied(smooth[peaks]), samples.points[peaks])]
        order = peaks if count is None else visited(samples.points, smooth, options.radius, count)
        is_peak = np.isin(order, peaks)
        vertex_ids = self._vertices(mesh, samples, np.r_[order[is_peak], order[~is_peak]])
        points = vertex_ids[np.sort(np.unique(vertex_ids, return_index=True)[1])]
        if count is not None:
            points = continue_on_surface(mesh, points, surface.smoothed, options.radius, count)
        return Detection(points, min(int(is_peak.sum()), len(points)), surface.saliency)


class GlanceDetector(SampledDetector):
    """The fixation density of a log-linear model that human gaze has taught."""

    def __init__(self, weights: str, features: Features = cell_features) -> None:
        self.required_weights = self._weights = weights  # a key of haptic_glance.look.weights.weights.GLANCES, or DEEP
        self._features = features

    def _values(self, mesh: Mesh, options: Options) -> tuple[Samples, np.ndarray]:
        samples = samples_of_mesh(mesh)
        return samples, fixation_density(self._features(mesh, samples), options.learned.weights[self._weights])

    def _smooth(self, samples: Samples, values: np.ndarray, options: Options) -> np.ndarray:
        # noise moves this less than a mean
        return np.exp(samples.smoothed(np.log(values), options.smoothing))


def nearest_vertices(mesh: Mesh, positions: np.ndarray, targets: np.ndarray) -> np.ndarray:
    """(s,) i8: the used vertices, at positions (v, d), that are nearest to targets (s, d).

    Of equally near vertices the first one by place, since rounding would decide.
    """
    count = min(len(positions), CORNERS)
    distances, near = (part.reshape(len(targets), count) for part in KDTree(positions).query(targets, count))
    equal = distances <= distances[:, :1] * (1 + ROUNDING)
    several = np.flatnonzero(equal.sum(axis=1) > 1)
    rows, columns = np.nonzero(equal[several])
    vertex_ids = near[several[rows], columns]
    order = by_place(rows, mesh.vertices[mesh.used[vertex_ids]])
    near[several, 0] = vertex_ids[order[np.unique(rows[order], return_index=True)[1]]]
    return mesh.used[near[:, 0]]


def _on_vertices(mesh, samples, *values):
    """(n,) f8 in 0..1 of each of the values (s,) of the samples: at the vertices, 0 where these have no area."""
    near, weights = samples.interpolation(mesh.vertices, mesh.vertex_normals)
    has_area = mesh.vertex_areas > 0
    return [scaled(np.where(has_area, (column[near] * weights).sum(axis=1), 0)) for column in values]


FINE = 13  # of MobileNetV2's blocks: the last one with maps of a sixteenth of the side of the picture
COARSE = 16  # the last one with 160 maps of half that size
SIZE = 384  # pixels a side: maps of 24 x 24 and 12 x 12
AROUND = tuple(22.5 + 45.0 * k for k in range(8))  # degrees from the longest axis: alike on both sides of its planes
NEAR = 1.5  # spacings behind the surface that a picture shows, up to which a sample is on it
UNSEEN = 0.1  # a place that is seen by views of this sum of cosines is half way to the mean of the object
# Of a map of either block on a typical object: the median over 33 objects, of each map 0.21 to 0.37 and 0.11 to 0.2.
DEVIATIONS = np.repeat([0.29, 0.15], [96, 160])
LIMIT = 4.0  # standard deviations; what lies farther out counts as this


def standardised_maps(mesh: Mesh, samples: Samples) -> dict[str, np.ndarray]:
    """dict name of MAPS -> (s,) f8: the maps with mean 0 and deviation 1, or less where one hardly varies.

    The colours of the mesh are left out. Raises MissingExtra without torch, FetchError without the weights.
    """
    values = maps_on_surface(mesh, samples)
    centred = values - samples.shares @ values
    deviations = np.maximum(np.sqrt(samples.shares @ centred**2), DEVIATIONS / 2)
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
    total, coverage = np.zeros((len(samples.points), len(MAPS)), dtype=np.float32), np.zeros(len(samples.points))
    for azimuth in AROUND:
        viewpoint = Viewpoint(first + azimuth, 0)
        view = render(framed, viewpoint, (SIZE, SIZE), "raster")
        rows, columns, depths = project(points, viewpoint, (SIZE, SIZE))
        nearest = ndimage.maximum_filter(np.where(view.mask, view.depth, 0), 3)
        pixel = np.rint([rows, columns]).astype(np.int64).clip(0, SIZE - 1)
        weight = (samples.normals @ viewpoint.axes[2]).clip(0) * (depths < nearest[*pixel] + NEAR * spacing)
        seen = np.flatnonzero(weight)
        places = torch.from_numpy((np.stack([2 * columns + 1, 2 * rows + 1], axis=1) / SIZE - 1)[seen]).float()
        maps = _maps(trunk, torch.from_numpy(view.rgb))
        sampled = torch.nn.functional.grid_sample(
            maps, places[None, :, None], padding_mode="border", align_corners=False
        )
        total[seen] += weight[seen, None].astype(np.float32) * sampled[0, :, :, 0].T.numpy()
        coverage += weight
    by_area = samples.shares @ total / max(samples.shares @ coverage, 1e-9)
    return (total + UNSEEN * by_area) / (coverage + UNSEEN)[:, None]


def _frame(mesh, samples):
    """(middle (3,) of the box along the object's own axes, distance of the farthest corner of a face from it)."""
    corners = mesh.vertices[mesh.used]
    inside = (corners - samples.middle) @ samples.axes.T
    middle = samples.middle + (inside.min(axis=0) + inside.max(axis=0)) / 2 @ samples.axes
    return middle, np.linalg.norm(corners - middle, axis=1).max()


def _maps(trunk, picture):
    """(1, C, i, j) f4: the mean of the maps of a picture (h, w, 3) u1 and of its mirror image, mirrored back."""
    import torch

    from haptic_glance.deep.images import normalise

    image = normalise(picture.permute(2, 0, 1)[None].float() / 255)
    with torch.inference_mode():
        maps = trunk(torch.cat([image, image.flip(3)]))
    return (maps[:1] + maps[1:].flip(3)) / 2


@cache
def _trunk():
    """A function of images (n, 3, h, w): (n, C, i, j) the maps of FINE and of COARSE, these interpolated to that size.

    The normalisations of the network are folded into the convolutions.
    """
    import torch
    from torch.fx.experimental.optimization import fuse

    from haptic_glance.deep.network import build

    blocks = build("mobilenet_v2", 2, "imagenet", 0).convolutions
    fine, coarse = fuse(blocks[: FINE + 1]), fuse(blocks[FINE + 1 : COARSE + 1])

    def maps(images: Any) -> Any:
        first = fine(images)
        second = torch.nn.functional.interpolate(coarse(first), size=first.shape[2:], mode="bilinear")
        return torch.cat([first, second], dim=1)

    return maps
