"""The training data of one object with ground truth: the arrays that all methods of learning need."""

from pathlib import Path

import numpy as np

from haptic_glance.base.files import read_arrays
from haptic_glance.look.agreement import gaze_peaks
from haptic_glance.look.channels import CHANNELS
from haptic_glance.look.glance import samples_of_mesh, standardised
from haptic_glance.look.weights.attention import view_distances, view_similarities
from haptic_glance.look.weights.svm import pixel_samples
from haptic_glance.mesh.mesh import Mesh
from stages.conspicuity.storage import read_maps

from .ground_truth import gts_map, spread_on_surface, visible_points

SPREAD = 0.025  # of the diagonal: deviation of the Gaussian that spreads gaze and marks over the surface
MAX_MARKS = 200  # more vertices than this are gaze, whose peaks are the points; fewer are marks, which are the points


def collect_training_data(
    name: str, mesh: Mesh, path: str | Path, amounts: np.ndarray, seed: int
) -> dict[str, np.ndarray]:
    """The training data of an object with n vertices and v views: dict name -> array.

    path: its file in data/SET/conspicuity; amounts (n,): of ground_truth_amounts. The arrays are amounts, density (n,)
    per unit of area, areas (n,); points (k,) vertex ids and shares (k,) of the attention; glance (s, e) f4, the
    features of s samples, glance_names (e,), glance_amounts and glance_areas (s,); distances, similarities and
    on_object (v, channels), the last being similarities without the background, NaN for a view without points; for the
    SVM pixels (p, channels) f4, labels (p,) and views (p,) drawn on the object, and image_pixels, image_labels and
    image_views drawn from the whole image as in the thesis. Raises ValueError for an empty ground truth.
    """
    density = spread_on_surface(mesh, amounts, SPREAD * mesh.diagonal)
    points, shares = ground_truth_points(mesh, amounts, density)
    maps, mask, viewpoints, stored = read_maps(path)
    channels = [channel for channel in CHANNELS if channel in stored]
    maps = maps[:, [stored.index(channel) for channel in channels]]
    samples = samples_of_mesh(mesh)
    glance = standardised(samples)
    found = [
        _view(
            f"{name} {viewpoint.name}",
            mesh,
            viewpoint,
            dict(zip(channels, maps[k], strict=True)),
            mask[k],
            points,
            seed,
        )
        for k, viewpoint in enumerate(viewpoints)
    ]
    tables, image, own = (list(part) for part in zip(*found, strict=True))
    if not any(view["distances"] for view in tables):
        raise ValueError("no view shows a point of its ground truth")
    return {
        "amounts": amounts,
        "density": density,
        "areas": mesh.vertex_areas,
        "points": points,
        "shares": shares,
        "glance": np.stack(list(glance.values()), axis=1).astype(np.float32),
        "glance_amounts": np.bincount(samples.tree.query(mesh.vertices)[1], amounts, minlength=len(samples.points)),
        "glance_areas": samples.areas,
        "glance_names": np.array(list(glance)),
        "channels": np.array(channels),
        **{kind: _table([view[kind] for view in tables], channels) for kind in tables[0]},
        **_rows("", own),
        **_rows("image_", image),
    }


def read_training_data(folder: Path) -> dict[str, dict[str, np.ndarray]]:
    """{object: arrays of collect_training_data} of the files NAME.npz in a folder, in alphabetical order."""
    files = {path.stem: path for path in folder.glob("*.npz")}
    return {name: read_arrays(files[name]) for name in sorted(files)}


def _table(views, channels):
    return np.array([[view.get(channel, np.nan) for channel in channels] for view in views])


def _rows(prefix, views):
    features, labels = zip(*views, strict=True)
    return {
        f"{prefix}pixels": np.concatenate(features).astype(np.float32),
        f"{prefix}labels": np.concatenate(labels),
        f"{prefix}views": np.repeat(np.arange(len(labels)), [len(view) for view in labels]),
    }


def ground_truth_points(mesh: Mesh, amounts: np.ndarray, density: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(vertices (k,), shares (k,)): the marked vertices, or for gaze the peaks of its density."""
    marked = np.flatnonzero(amounts)
    if len(marked) > MAX_MARKS:
        return gaze_peaks(mesh, density)
    order = marked[np.argsort(-amounts[marked], kind="stable")]
    return order, amounts[order] / amounts.sum()


def _view(name, mesh, viewpoint, maps, mask, points, seed):
    """(dict of channel values, SVM rows and labels of the whole image, the same on the object) of one view."""
    rows, columns, _ = visible_points(mesh, points, viewpoint, mask.shape)
    gts = gts_map(rows, columns, mask)
    tables = {
        "distances": view_distances(maps, rows, columns),
        "similarities": view_similarities(maps, gts),
        "on_object": view_similarities(maps, gts, mask) if mask.any() else {},
    }
    return tables, pixel_samples(maps, gts, seed, name), pixel_samples(maps, gts, seed, name, mask, share=1)
