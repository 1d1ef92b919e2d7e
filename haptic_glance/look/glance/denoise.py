"""Samples of a rough surface, moved onto the smooth one that they scatter about."""

from dataclasses import replace

import numpy as np

from haptic_glance.mesh.mesh import unit

from .samples import Samples, nearest

ROUGH = 0.1  # one minus the cosine of a normal and its neighbours' mean: the median of the roughest of 33 clean objects
AVERAGED = 2  # steps over the graph for the normals that the patches start from
PATCH = 32  # nearest points that a patch is fitted to
WIDTH = 2.5  # deviation of their weights, in units of the spacing
SAME_SIDE = 0.2  # cosine between two normals above which points lie on one sheet
FARTHEST = 2.0  # in units of the spacing: no point moves more
STEEPEST = 1.0  # slope of a patch against the normal that it starts from
RIDGE = 1e-6  # keeps a patch with too few points from being undetermined


def denoised(samples: Samples) -> Samples:
    """The Samples, each moved along its normal onto a paraboloid that is fitted to the points around it.

    Unlike an average this does not shrink what is curved (Cazals and Pouget, Estimating differential quantities using
    polynomial fitting of osculating jets, CAGD 22(2), 2005). Samples that are no rougher than those of a clean surface
    come back as they are.
    """
    normals = samples.average @ samples.normals
    if not samples.rough and np.median(1 - np.einsum("ij,ij->i", normals, samples.normals)) <= ROUGH:
        return samples
    for _ in range(AVERAGED - 1):
        normals = samples.average @ unit(normals)
    return _on_patches(samples, unit(normals))


def _on_patches(samples, normals):
    distance, neighbours = nearest(samples.tree, samples.points, PATCH)
    reference_axis = np.where(np.abs(normals[:, :1]) < 0.9, [1.0, 0.0, 0.0], [0.0, 1.0, 0.0])
    right = unit(np.cross(normals, reference_axis))
    frame = np.stack([right, np.cross(normals, right), normals], axis=1)
    x, y, z = np.einsum("nij,nkj->ink", frame, samples.points[neighbours] - samples.points[:, None]) / samples.spacing
    weight = np.exp(-((distance / (WIDTH * samples.spacing)) ** 2) / 2)
    weight *= np.einsum("nkj,nj->nk", normals[neighbours], normals) > SAME_SIDE
    weight *= np.sqrt(samples.areas[neighbours]) / samples.spacing
    terms = np.stack([np.ones_like(x), x, y, x * x, x * y, y * y], axis=2) * weight[:, :, None]
    inner = np.einsum("nki,nkj->nij", terms, terms) + RIDGE * np.eye(terms.shape[2])
    fit = np.linalg.solve(inner, np.einsum("nki,nk->ni", terms, z * weight)[:, :, None])[:, :, 0]
    steps = fit[:, :1].clip(-FARTHEST, FARTHEST) * samples.spacing
    slopes = np.einsum("ni,nij->nj", fit[:, 1:3].clip(-STEEPEST, STEEPEST), frame[:, :2])
    return replace(samples, points=samples.points + steps * normals, normals=unit(normals - slopes))
