"""What one object with ground truth teaches: everything that the ways of learning need, as arrays."""

import numpy as np

from stages.conspicuity import CHANNELS
from stages.conspicuity.storage import read_maps

from .agreement import truth_points
from .euclidean import view_distances
from .features import SEEN, vertex_features
from .similarity import view_similarities
from .svm_pixels import pixel_samples
from .truth import gts_map, spread_on_surface, visible_points

SPREAD = 0.025  # of the diagonal: deviation of the Gaussian that gaze and marks are spread with along the surface
CROWD = 200  # with more places than this the truth is gaze, whose peaks are its points; fewer are the marks themselves


def lesson(name, mesh, sight, path, amounts, seed):
    """dict of arrays that one object of n vertices and v views adds to the learning.

    path: its file in data/conspicuity; amounts (n,): stages.weights.truth.truth_of. Gives amounts, density (n,) per
    unit of area, areas (n,); points (k,) vertex ids and shares (k,), how much of the attention each holds; features
    (n, d) f4 and names (d,); distances and similarities (v, channels), and on_object, the similarities without the
    background, NaN for a view without points; for the SVM pixels (p, channels) f4, labels (p,) and views (p,) drawn on
    the object, and image_pixels and so on drawn from the whole image, the thesis's way. Raises ValueError for a truth
    that is empty.
    """
    density = spread_on_surface(mesh, amounts, SPREAD * mesh.diagonal)
    points, shares = ground_truth_points(mesh, amounts, density)
    maps, mask, viewpoints, stored = read_maps(path)
    channels = [channel for channel in CHANNELS if channel in stored]
    maps = maps[:, [stored.index(channel) for channel in channels]]
    on_vertices = {channel: sight.averaged(sight.maps[channel]) for channel in SEEN}
    features = vertex_features(mesh, sight.viewpoints, sight.facing, on_vertices)
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
        raise ValueError("no view sees a place of its ground truth")
    return {
        "amounts": amounts,
        "density": density,
        "areas": mesh.vertex_areas,
        "points": points,
        "shares": shares,
        "features": np.stack(list(features.values()), axis=1).astype(np.float32),
        "names": np.array(list(features)),
        "channels": np.array(channels),
        **{kind: _table([view[kind] for view in tables], channels) for kind in tables[0]},
        **_rows("", own),
        **_rows("image_", image),
    }


def _table(views, channels):
    return np.array([[view.get(channel, np.nan) for channel in channels] for view in views])


def _rows(prefix, views):
    features, labels = zip(*views, strict=True)
    return {
        f"{prefix}pixels": np.concatenate(features).astype(np.float32),
        f"{prefix}labels": np.concatenate(labels),
        f"{prefix}views": np.repeat(np.arange(len(labels)), [len(view) for view in labels]),
    }


def ground_truth_points(mesh, amounts, density):
    """(vertices (k,), shares (k,)): the marked vertices themselves, or the peaks of a gaze that lies everywhere."""
    marked = np.flatnonzero(amounts)
    if len(marked) > CROWD:
        return truth_points(mesh, density)
    order = marked[np.argsort(-amounts[marked], kind="stable")]
    return order, amounts[order] / amounts.sum()


def _view(name, mesh, viewpoint, maps, mask, points, seed):
    """(dict of tables' rows, SVM rows and labels of the whole image, the same on the object) of one view."""
    rows, columns, _ = visible_points(mesh, points, viewpoint, mask.shape)
    gts = gts_map(rows, columns, mask)
    tables = {
        "distances": view_distances(maps, rows, columns),
        "similarities": view_similarities(maps, gts),
        "on_object": view_similarities(maps, gts, mask) if mask.any() else {},
    }
    return tables, pixel_samples(maps, gts, seed, name), pixel_samples(maps, gts, seed, name, mask, share=1)
