"""How the array meets the object: standing at the place, or resting on what a rigid plate meets first (T4.3.1).

"Obviously when working with a real sensor such cases will prevent a direct contact of the sensor with object at
interest point and the point with maximum negative distance will directly touch the object" (T4.3.1). `tangent` is the
thesis's array, which cuts into the object there; `rigid` is the plate that the sentence describes.
"""

import numpy as np

CONTACTS = ("tangent", "rigid")


def tangent_or_rigid(surface, centres, axes, cells, pitches, reaches, contact):
    """(k, rows, cols) distances of the arrays from where they stand, cut at their reach.

    rigid: the plane starts `reach` above the place and comes down along its normal until the column of one of its
    cells, or the place itself, touches the object; from there all distances count, 0 to `reach`. Where a cell is
    inside the object at the start already (in a cup narrower than the array and deeper than the reach), the array
    cannot get in: it stays at the start, such cells touch (0) and the others measure from there. Where it meets
    nothing at all every cell reports the reach.

    After `normalise` both are alike as long as one surface covers the array's footprint, since the shift by the least
    distance is the same. They differ where something hangs over the place (a handle, a rim, the far side of a fold):
    the tangent plane is under it or cuts through it and does not feel it, a rigid one rests on it; and in the depth
    that is cut off, which counts from where the array rests.
    """
    check_contact(contact)
    limit = reaches[:, None, None]
    if contact == "tangent":
        found = surface.measure(centres, axes, cells, pitches)
        return np.clip(found, -limit, limit, out=found)
    found = surface.measure(centres + reaches[:, None] * axes[:, 2], axes, cells, pitches)
    np.maximum(found, 0.0, out=found)
    found -= np.minimum(found.min(axis=(1, 2), keepdims=True), limit)
    return np.minimum(found, limit, out=found)


def check_contact(contact):
    """ValueError where it is none of CONTACTS."""
    if contact not in CONTACTS:
        raise ValueError(f"contact must be one of {', '.join(CONTACTS)}, got {contact!r}")
