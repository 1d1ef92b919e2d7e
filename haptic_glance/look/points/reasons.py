"""Why a glance finds a place salient: what each of its features adds to the log of the fixation density there."""

from functools import lru_cache

import numpy as np

from haptic_glance.mesh.axes import Axis, axis_named
from haptic_glance.mesh.mesh import Mesh

from ..glance import samples_of_mesh, standardised
from ..weights.weights import GLANCE, GLANCES
from .find import prepared

# feature -> what a person calls a place where it is large, and one where it is small
WORDS = {
    "rank": ("high up", "low down"),
    "middle": ("at middle height", "at the top or bottom"),
    "upward": ("faces up", "faces down"),
    "upward_high": ("a top or an underside", "faces the middle"),
    "seen": ("seen from many sides", "seen from few sides"),
    "above": ("seen from above", "hidden from above"),
    "above_high": ("seen from above, high up", "not high and seen from above"),
    "below": ("seen from below", "hidden from below"),
    "log_below": ("faces those below", "turned away from below"),
    "log_side": ("faces those around it", "turned away from those around"),
    "convexity": ("bulges out", "a hollow"),
    "detail": ("fine detail", "smooth"),
    "relief": ("rich in relief", "plain around"),
    "fullness_0.12": ("much surface close by", "little surface close by"),
    "fullness_0.24": ("much surface around", "a tip"),
    "distance": ("far from the middle", "near the middle"),
    "distance_squared": ("at an end", "not at an end"),
    "outward": ("faces outwards", "faces inwards"),
    "off_plane": ("beside the mirror plane", "near the mirror plane"),
    "on_plane": ("on the mirror plane", "off the mirror plane"),
}


def contributions(
    mesh: Mesh, vertices: np.ndarray, method: str = GLANCE, up: Axis | None = None
) -> dict[str, np.ndarray]:
    """dict feature -> (k,) f8: its weight times its standardised value at the vertices (k,).

    method: `glance` or `glance_any_pose`. Their sum is the log of the saliency, up to a constant of the mesh, wherever
    the samples are dense; 0 is an average place. up: as in `saliency`. Raises ValueError for another method.
    """
    if method not in GLANCES:
        raise ValueError(f"method {method!r} is no sum of features: only {' and '.join(GLANCES)} are")
    mesh, samples, values = _seen(mesh, None if up is None else axis_named(up))
    near, shares = samples.interpolation(mesh.vertices[vertices], mesh.vertex_normals[vertices])
    return {name: weight * (values[name][near] * shares).sum(axis=1) for name, weight in GLANCES[method].items()}


@lru_cache(maxsize=2)  # a person asks of one mesh again and again
def _seen(mesh, up):
    """(the mesh as it is looked at, its samples, their standardised features)."""
    mesh = prepared(mesh, up)
    samples = samples_of_mesh(mesh)
    return mesh, samples, standardised(samples)


def reasons(
    terms: dict[str, np.ndarray], method: str = GLANCE, count: int = 3, against: bool = False
) -> list[list[tuple[str, float]]]:  # fmt: skip
    """For each place its `contributions` above 0 in words, the `count` largest first: [(words, contribution), ...].

    against: those below 0 instead, the most negative first.
    """
    names, amounts, sign = list(terms), np.array(list(terms.values())), -1 if against else 1

    def phrase(name: str, amount: float) -> str:
        high_words, low_words = WORDS[name]
        return high_words if amount * GLANCES[method][name] > 0 else low_words

    return [
        [
            (phrase(names[k], column[k]), float(column[k]))
            for k in np.argsort(-sign * column)[:count]
            if sign * column[k] > 0
        ]
        for column in amounts.T
    ]
