"""How the array touches the object: standing at the place, or resting on its first contact (T4.3.1).

"Obviously when working with a real sensor such cases will prevent a direct contact of the sensor with object at
interest point and the point with maximum negative distance will directly touch the object" (T4.3.1). `tangent` is the
thesis's array, which intersects the object there. `rigid` is the plate that the sentence describes.
"""

from collections.abc import Sequence

import numpy as np

from .surface import Surface

CONTACTS = ("tangent", "rigid")


def contact_distances(
    surface: Surface,
    centres: np.ndarray,
    axes: np.ndarray,
    cells: tuple[int, int],
    pitches: np.ndarray,
    max_distances: np.ndarray,
    contact: str,
) -> np.ndarray:
    """(k, rows, cols) distances of the arrays from their position, limited to `max_distances`.

    rigid: the plane starts `max_distance` above the place and moves down along its normal until the column of one of
    its cells, or the place itself, touches the object. Distances count from there, 0 to `max_distance`. Where a cell is
    inside the object at the start (in a cup narrower than the array and deeper than `max_distance`), the array cannot
    enter. It stays at the start, such cells touch (0) and the others measure from there. Where the array touches
    nothing, every cell reports `max_distance`.

    After `normalise` both are equal as long as one surface covers the array's footprint, since both are shifted by the
    least distance. They differ where something overhangs the place (a handle, a rim, the far side of a fold): the
    tangent plane is below it or intersects it and does not measure it, a rigid one rests on it. They also differ in the
    depth limit, which for a rigid array counts from where it rests.
    """
    check_contact(contact)
    limit = max_distances[:, None, None]
    if contact == "tangent":
        distances = surface.measure(centres, axes, cells, pitches)
        return np.clip(distances, -limit, limit, out=distances)
    distances = surface.measure(centres + max_distances[:, None] * axes[:, 2], axes, cells, pitches)
    np.maximum(distances, 0.0, out=distances)
    distances -= np.minimum(distances.min(axis=(1, 2), keepdims=True), limit)
    return np.minimum(distances, limit, out=distances)


def check_contact(contact: str, known: Sequence[str] = CONTACTS) -> None:
    """Raises ValueError unless `contact` is one of `known`."""
    if contact not in known:
        raise ValueError(f"contact must be one of {', '.join(known)}, got {contact!r}")
