"""One object, looked at and touched until it is known, in simulation."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from haptic_glance.mesh.files import MeshLike
from haptic_glance.touch import Surface
from haptic_glance.touch.surface import as_surface

from .belief import Belief, Reachable
from .pressure_array import Approach

MOST = 10  # touches after which a person would give up


@dataclass(frozen=True)
class Step:
    """One touch: the line, the travel and the imprint in the unit of the meshes, and the belief after it."""

    approach: Approach
    travel: float
    imprint: np.ndarray
    belief: Belief


def touch_until_known(
    belief: Belief,
    mesh: "MeshLike | Surface",
    most: int = MOST,
    reachable: Reachable | None = None,
    random: np.random.Generator | None = None,
) -> Iterator[Step]:
    """Touches a mesh where a touch is expected to tell most, until it is known.

    Parameters
    ----------
    belief : Belief
        The belief to begin with, of `Library.belief` or `Library.look`.
    mesh : Mesh, Surface or any input of `as_mesh`
        The object as it stands, in the unit of the library; see `stand`.
    most : int
        Touches at most.
    reachable : callable, optional
        As of `Belief.next_touch`.
    random : numpy.random.Generator, optional
        As of `Approach.feel`.

    Returns
    -------
    iterator of Step
        Each touch, with the belief after it.

    Examples
    --------
    >>> from haptic_glance.know import learn, primitives, stand, touch_until_known
    >>> shapes = primitives()
    >>> *_, last = touch_until_known(learn(shapes).belief(), stand(shapes["box"], turn=20))
    >>> last.belief.known
    'box'
    """
    surface = as_surface(mesh)
    for _ in range(most):
        if belief.known:
            return
        approach = belief.next_touch(reachable)
        travel, imprint = approach.feel(surface, random)
        belief = belief.after(approach, travel, imprint)
        yield Step(approach, travel, imprint, belief)
