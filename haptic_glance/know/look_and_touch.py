"""One object, looked at and touched until it is known, in simulation."""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from haptic_glance.look.camera import Viewpoint
from haptic_glance.look.views import render
from haptic_glance.mesh.files import MeshLike, with_known_up
from haptic_glance.mesh.mesh import Mesh
from haptic_glance.touch import Surface
from haptic_glance.touch.surface import as_surface

from .belief import Belief, Reachable
from .library import SPAN
from .pressure_array import Approach
from .sight import SIDE, board

MOST = 10  # touches after which a person would give up
CAMERA = Viewpoint(0, 35)  # from where the picture is taken
BOARD = 128  # grey value of the board
HIDDEN, MOST_HIDDEN = 0.6, 0.95  # shares of the object's pixels behind the board: by default, and at most


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
    surface = mesh if isinstance(mesh, Surface) else as_surface(with_known_up(mesh))
    for _ in range(most):
        if belief.known:
            return
        approach = belief.next_touch(reachable)
        travel, imprint = approach.feel(surface, random)
        belief = belief.after(approach, travel, imprint)
        yield Step(approach, travel, imprint, belief)


def half_hidden(
    mesh: Mesh, diameter: float, share: float, random: np.random.Generator
) -> tuple[np.ndarray, np.ndarray]:
    """(picture (96, 96) in bytes, mask (96, 96) of what is hidden) of a mesh, a share of it behind a grey board.

    diameter: of the largest known object, `Library.diameter`. The picture cuts a larger object off.
    """
    reach = np.linalg.norm(mesh.vertices[mesh.used], axis=1).max() / diameter
    frames = int(np.ceil(max(2 * reach / SPAN, 1)))  # what is rendered, since it must hold the whole object
    wide = render(replace(mesh, vertices=mesh.vertices / (frames * diameter)), CAMERA, size=(frames * SIDE,) * 2)
    border = (frames - 1) * SIDE // 2
    middle = slice(border, border + SIDE), slice(border, border + SIDE)
    mask = board(wide.mask[middle], share, random)
    return np.where(mask, BOARD, wide.rgb[middle].mean(axis=2)).astype(np.uint8), mask
