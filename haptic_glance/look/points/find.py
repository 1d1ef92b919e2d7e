"""Saliency and salient points of a mesh, in one call each, by the names of the command line."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from numbers import Real
from typing import Any

import numpy as np
from scipy.spatial import KDTree

from haptic_glance.base.warner import warn_caller
from haptic_glance.mesh import MeshError, clean, normalise, rotate_to_z_up
from haptic_glance.mesh.axes import Axis
from haptic_glance.mesh.materials import bake_texture
from haptic_glance.mesh.mesh import Mesh
from haptic_glance.mesh.repair import orient

from ..camera import Viewpoint
from ..channels import ViewMaps, conspicuity
from ..channels.channels import check_channels, mask_at_size
from ..channels.surface import SMOOTHING
from ..views import TWELVE, render
from ..views import best_viewpoints as best_set
from ..weights import LearnedWeights
from ..weights import weights as published
from ..weights.weights import GLANCE
from .fuse import fuse
from .glance import SampledDetector
from .methods import MAIN, METHODS, is_method, meant, method_for, method_named, split_runnable
from .options import RADIUS, Detection, HasSaliency, Options, tied

VIEW_SIZE = (900, 1200)  # rows, columns of the views; T3.2.6
MAP_SIZE = (225, 300)  # rows, columns of the maps: a quarter of the views', so that the channels keep their scales


def saliency(
    mesh: Mesh, method: str = GLANCE, weights: str | Mapping[str, float] | None = None,
    viewpoints: Iterable[Viewpoint] | None = None, smoothing: float = SMOOTHING, up: Axis | None = None,
) -> np.ndarray:  # fmt: skip
    """How much each vertex attracts attention.

    Parameters
    ----------
    mesh : Mesh or any input of `as_mesh`
        The mesh, at any place and of any size.
    method : str
        A name of METHODS that has a saliency (all but `random` and `farthest`). `glance`, the default, is the fixation
        density per unit of area that a log-linear model, fitted to human gaze, predicts from small cells of the
        surface. `glance_any_pose` is the same without the features that need an up axis, for objects in any pose.
        `glance_deep` adds the maps of a network that looks at pictures (extra `deep`); it is more accurate and slower.
        `thesis_ssim` is the thesis's own weighted average (eq. 3.9), `itti` the classical model.
    weights : str or mapping of str to float, optional
        Name of a set of weights (`haptic_glance.look.weights`), or weight of each channel, for a method with weights.
        None: the method's own.
    viewpoints : iterable of Viewpoint, optional
        None: the twelve of T figure 3.2. Only methods of conspicuity maps read this and the next.
    smoothing : float
        Length in units of the normalised mesh, whose bounding sphere has the radius 0.5.
    up : str or (3,) array_like, optional
        The axis that points up: `x`, `-y`, a vector, or `auto`, which chooses y or z by the shape. None: `mesh.up`.
        People look at the upper part of things and walk around them, so `glance` and `height` need the right one.

    Returns
    -------
    (n,) array of float
        Saliency in 0..1, 1 at the maximum.

    Raises
    ------
    ValueError
        For unknown names or invalid weights.

    Examples
    --------
    >>> import trimesh
    >>> from haptic_glance import saliency
    >>> values = saliency(trimesh.creation.capsule(count=(16, 16)), up="z")
    >>> values.shape, float(values.max())
    ((258,), 1.0)
    """
    detector = method_named(method)
    if not isinstance(detector, HasSaliency):
        raise ValueError(f"method {method!r} has no saliency: it only places points")
    mesh = prepared(mesh, up)
    options = Options(_learned(method, weights), smoothing=smoothing)
    return detector.saliency(mesh, compute_maps(mesh, detector.channels, viewpoints), options)


def find_points(
    mesh: Mesh, method: str | int | None = None, count: int | None = None, *, purpose: str = "look",
    weights: str | Mapping[str, float] | None = None, viewpoints: Iterable[Viewpoint] | None = None,
    selection: str = "suppression", radius: float = RADIUS, seed: int = 0, name: str = "", up: Axis | None = None,
) -> np.ndarray:  # fmt: skip
    """Finds the places that attract attention, or that are worth touching.

    Parameters
    ----------
    mesh : Mesh or any input of `as_mesh`
        The mesh.
    method : str or int, optional
        A name of METHODS. `find_points(mesh, 10)` finds ten places by the default method.
    count : int, optional
        Number of points. None: the peaks past the method's own threshold (T3.2.5 for maps). With a count, `glance`
        visits places in turn, as a gaze does, which stays near a strong place: these need not be the first of the
        peaks.
    purpose : {"look", "touch"}
        `look`: places that people look at (method `glance`). `touch`: places whose imprint by the array, 0.16 units
        wide, recurs on the object (method `touch`).
    weights, viewpoints, up
        As of `saliency`.
    selection : {"suppression", "centroid"}
        For methods that select points in each view: T3.2.5 or T3.1.2.
    radius : float
        Least distance between places, in units of the normalised mesh. It shrinks only if `count` places do not fit.
        The vertices nearest to two places may be closer by an edge. Methods of the literature that select points by a
        rule of their own keep that rule, and use the radius for further places alone.
    seed : int
        For `random` alone, whose draw depends on seed and name and not on earlier calls.
    name : str
        For `random` alone.

    Returns
    -------
    (k,) array of int
        Vertex ids, the best first. A mesh with fewer vertices that have a normal gives fewer than `count`.

    Raises
    ------
    ValueError
        For unknown names, an invalid count or radius, a method beside the purpose `touch`, or `random` or `farthest`
        without a count.

    Examples
    --------
    >>> import trimesh
    >>> from haptic_glance import find_points
    >>> find_points(trimesh.creation.capsule(count=(16, 16)), 3, up="z").shape
    (3,)
    """
    return detect(
        mesh, method, count, purpose=purpose, weights=weights, viewpoints=viewpoints, selection=selection,
        radius=radius, seed=seed, name=name, up=up,
    ).points  # fmt: skip


def detect(
    mesh: Mesh, method: str | int | None = None, count: int | None = None, *, purpose: str = "look",
    weights: str | Mapping[str, float] | None = None, viewpoints: Iterable[Viewpoint] | None = None,
    selection: str = "suppression", radius: float = RADIUS, seed: int = 0, name: str = "", up: Axis | None = None,
) -> Detection:  # fmt: skip
    """Finds points and saliency in one look, with the points that are equally good.

    Parameters
    ----------
    mesh, method, count, purpose, weights, viewpoints, selection, radius, seed, name, up
        As of `find_points` and `saliency`.

    Returns
    -------
    Detection
        Points, scores, ties, and the saliency of all vertices.

    Raises
    ------
    ValueError
        As `find_points` and `saliency` do.

    Examples
    --------
    >>> import trimesh
    >>> from haptic_glance import detect
    >>> detect(trimesh.creation.icosphere(2), count=2, up="z").ties.tolist()  # a ball has no better place
    [0, 0]
    """
    if not isinstance(method, str | None):
        if count is not None:
            raise ValueError(f"method {method!r} is not the name of a method")
        method, count = None, method
    method = method_for(purpose, method)
    if not (isinstance(radius, int | float | np.number) and radius >= 0):
        raise ValueError(f"radius is a length in units of the normalised mesh, got {radius!r}")
    options = Options(_learned(method, weights), selection, radius, SMOOTHING, seed, name)
    _check(count)
    return Looked(mesh, method, options, viewpoints, up).detect(count)


class Looked:
    """A mesh that a method has looked at once, so that each number of places is found without another look.

    mesh, method, up, viewpoints: as of `find_points`. Raises ValueError for an unknown method.
    """

    def __init__(
        self, mesh: Mesh, method: str = GLANCE, options: Options | None = None,
        viewpoints: Iterable[Viewpoint] | None = None, up: Axis | None = None,
    ) -> None:  # fmt: skip
        self.detector, self.viewpoints = method_named(method), _chosen(viewpoints)
        self.options = options or Options(_learned(method, None))
        self.mesh = prepared(mesh, up)

    @cached_property
    def view_maps(self) -> Any:
        """The maps, or the samples, that the detector uses for every count."""
        if isinstance(self.detector, SampledDetector):
            return self.detector.seen(self.mesh, self.options)
        return compute_maps(self.mesh, self.detector.channels, self.viewpoints)

    @cached_property
    def _places(self) -> KDTree:
        return KDTree(self.mesh.vertices)

    def detect(self, count: int | None = None) -> Detection:
        """The Detection of `count` points, None for those past the method's own threshold; ValueError below 1."""
        detection = self.detector.find(self.mesh, self.view_maps, self.options, _check(count))
        if detection.saliency is None:
            return detection
        scores = scores_of(self.mesh, detection.points, detection.saliency, self._places)
        return replace(detection, scores=scores, ties=tied(scores))


def _check(count):
    is_number = isinstance(count, int | float | np.number) and not isinstance(count, bool)
    if count is not None and not (is_number and float(count).is_integer() and count >= 1):
        raise ValueError(f"count must be a whole number of at least 1, got {count!r}")
    return None if count is None else int(count)


def scores_of(mesh: Mesh, points: np.ndarray, saliency: np.ndarray, places: KDTree | None = None) -> np.ndarray:
    """(k,) f8 in 0..1: how strongly each of the points (k,) draws the eye, in their order; descending.

    It is the mean of the saliency (n,) around a point of the normalised mesh, by area, over the length that smooths the
    saliency before its peaks are taken. Attention inhibits what it has visited, so that a later place may lie beside a
    high peak: its score is never more than that of the place before it. places: the tree of the mesh's vertices, where
    it is known.
    """
    places, radius = places or KDTree(mesh.vertices), 2 * SMOOTHING
    near = [np.union1d(ids, point).astype(np.int64) for ids, point in zip(
        places.query_ball_point(mesh.vertices[points], radius), points, strict=True)]  # fmt: skip
    areas = [mesh.vertex_areas[ids] for ids in near]
    means = [
        np.average(saliency[ids], weights=area) if area.any() else saliency[point]
        for ids, area, point in zip(near, areas, points, strict=True)
    ]
    return np.minimum.accumulate(np.array(means, dtype=np.float64))


def prepared(mesh: Mesh, up: Axis | None = None) -> Mesh:
    """The mesh as the detectors take it; one that cannot be repaired is only turned outwards, with a warning."""
    mesh = bake_texture(mesh)  # views show the colours of vertices
    try:
        mesh = clean(mesh)[0]
    except MeshError as error:
        warn_caller(f"the saliency may be wrong: {error}")
        mesh = orient(mesh)[0]
    return normalise(rotate_to_z_up(mesh, up))


def compute_maps(
    mesh: Mesh, channels: Iterable[str], viewpoints: Iterable[Viewpoint] | None = None, renderer: str = "raster"
) -> ViewMaps | None:
    """The ViewMaps of a normalised mesh: rendered from the viewpoints, with the channels' maps; None without channels.

    renderer: that of haptic_glance.look.views.render.
    """
    channels, viewpoints = tuple(channels), _chosen(viewpoints)
    if not channels:
        return None
    per_view, masks = [], []
    for viewpoint in viewpoints:
        view = render(mesh, viewpoint, VIEW_SIZE, renderer)
        per_view.append(conspicuity(mesh, view, channels, MAP_SIZE))
        masks.append(mask_at_size(view.mask, MAP_SIZE))
    maps = {channel: np.stack([maps[channel] for maps in per_view]) for channel in channels}
    return ViewMaps(mesh, viewpoints, maps, np.stack(masks))


def _chosen(viewpoints):
    viewpoints = TWELVE if viewpoints is None else tuple(viewpoints)
    if not viewpoints:
        raise ValueError("no viewpoints: give at least one, or None for the twelve of T figure 3.2")
    if strange := [viewpoint for viewpoint in viewpoints if not isinstance(viewpoint, Viewpoint)]:
        raise ValueError(f"viewpoints must be of the class Viewpoint, got {strange[0]!r}")
    return viewpoints


def _learned(method, weights):
    """The published weights, those of the method replaced by the caller's."""
    required, learned = method_named(method).required_weights, LearnedWeights()
    if required is not None and required.startswith("svm"):
        raise ValueError(f"method {method!r} needs an SVM that the stage `weights` trains: run the pipeline for it")
    if weights is None:
        if required not in {None, *learned.weights}:
            raise ValueError(
                f"method {method!r} needs weights that the stage `weights` learns: pass weights, or choose another"
            )
        return learned
    if required is None:
        raise ValueError(f"method {method!r} has no weights")
    if isinstance(weights, str):
        return LearnedWeights(learned.weights | {required: published(weights)})
    if not isinstance(weights, Mapping) or not all(isinstance(weight, Real) for weight in weights.values()):
        raise ValueError(f"weights must be a dict of channels and their weights as numbers, got {weights!r}")
    return LearnedWeights(learned.weights | {required: dict(weights)})


HELP = (
    "glance, our model of human gaze (default); thesis_ssim, the thesis's attention; itti, plain visual attention; "
    "haptic_glance.METHODS has the rest"
)


def check_name(method: str, first: Sequence[str] = (), points_alone: bool = False) -> None:
    """Raises ValueError for a method that does not run on a mesh outside the pipeline's data sets, with one that does.

    first: names that the command adds. points_alone: also methods that place points and have no saliency.
    """
    runs, _ = split_runnable(METHODS, LearnedWeights())
    runs.remove("random")  # which no command needs: touch has --at random
    usable = [*first, *(name for name in runs if points_alone or hasattr(METHODS[name], "saliency"))]
    if method in usable:
        return
    spelling = method.lower().replace("-", "_").replace(" ", "_")
    hint = meant(spelling, usable)
    reason = f"there is no such method{hint}"
    if is_method(method):
        learned = method_named(method).required_weights
        reason = "its weights are learned in the pipeline" if learned else "it has no saliency"
    advice = "" if hint and not is_method(method) else f"; choose one of {', '.join([*first, *MAIN])}"
    raise ValueError(f"--method {method}: {reason}{advice}")


SCORED_SIZE = (300, 400)  # rows, columns of the 62 views: a third of the thesis's, enough for a sum over all pixels


def best_viewpoints(mesh: Mesh, method: str = "thesis_ssim", seed: int = 0) -> list[Viewpoint]:
    """Four to eight Viewpoints: of 18 sets of four perpendicular views the most salient one, and added views.

    mesh: normalised. A view's level of saliency is the sum over its saliency map (T eq. 3.10), fused with the published
    weights named by method (T eq. 3.9). Raises ValueError for an unknown method, one that weighs no channels, or a mesh
    without area.
    """
    factors = published(method)
    check_channels(factors)

    def level(viewpoint: Viewpoint) -> float:
        view = render(mesh, viewpoint, SCORED_SIZE)
        return float(fuse(conspicuity(mesh, view, list(factors)), factors).sum())

    return best_set(mesh, level, seed)
