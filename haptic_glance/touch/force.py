"""Touch in newtons: normal and tangential forces on each taxel of an array below an elastic layer."""

import numpy as np
from numpy.typing import ArrayLike

from haptic_glance.mesh.mesh import Mesh

from .distances import as_places, check_array, check_arrays, check_places
from .kernels.measure import depths_of_loads
from .skin import Layer
from .surface import Surface, as_surface


def press_forces(
    surface: Mesh | Surface,
    centres: ArrayLike,
    axes: ArrayLike,
    layer: Layer,
    cells: tuple[int, int] = (16, 16),
    pitch: float = 0.001,
    load: ArrayLike | None = None,
    depth: ArrayLike | None = None,
    unit: float = 1.0,
) -> np.ndarray:
    """Normal forces on the cells of arrays that are pressed on an object under a layer.

    Parameters
    ----------
    surface : Surface, Mesh or any input of `as_mesh`
        The object.
    centres : (k, 3) array_like
        Centres of the arrays, in units of the mesh.
    axes : (k, 3, 3) array_like
        Unit vectors right, up and normal of each array, see `sensor_axes`.
    layer : Layer
        The layer on the array.
    cells : tuple of 2 ints
        Rows and columns.
    pitch : float or str
        Distance of neighbouring cells, in units of the mesh, or a text such as "1mm".
    load : float or (k,) array_like, optional
        Newtons on the whole array. Give `load` or `depth`.
    depth : float, str or (k,) array_like, optional
        Approach after the first contact in metres, or a text such as "2mm".
    unit : float or str
        Metres that a unit of the mesh is long; `haptic_glance.press_forces` also takes a name such as "mm".

    Returns
    -------
    (k, rows, cols) array of float
        Newtons.

    Raises
    ------
    ValueError
        As `forces` does, and for invalid arrays.

    Notes
    -----
    The array starts above the place at a height of its longer side, as in `gaps_at`, and presses on the first surface
    in its way. For a place in a hole narrower than the array, this is another wall, and the least gap is far below 0.

    Examples
    --------
    >>> import numpy as np, trimesh
    >>> from haptic_glance import Layer, press_forces, sensor_axes
    >>> ball = trimesh.creation.icosphere(4, radius=0.02)  # metres
    >>> axes = sensor_axes([[0, 0, 1]])
    >>> newtons = press_forces(ball, [[0, 0, 0.02]], axes, Layer(), cells=(8, 8), pitch=0.002, load=2.0)
    >>> newtons.shape, float(newtons.sum().round(6))
    ((1, 8, 8), 2.0)
    """
    if (load is None) == (depth is None):
        raise ValueError("give either load, in newtons, or depth, in metres")
    surface, (centres, axes) = as_surface(surface), as_places(centres, axes)
    cells, pitch, _ = check_array(cells, pitch)
    check_unit(unit)
    area, count = (pitch * unit) ** 2, len(centres)
    if not 0 < area < np.inf:
        _check_areas(area)
    depths = np.empty(count) if depth is None else _per_touch("depth", depth, count)
    loads = np.empty(0) if load is None else _per_touch("load", load, count)
    felt = surface.press(centres, axes, cells, pitch, unit, layer.stiffness * area, layer.thickness, loads, depths)
    if not (depths <= layer.thickness).all():  # the kernel has refused a touch: say why
        check_places(centres, axes)
        if depth is not None:
            checked_depths(depth, count)
        else:
            _checked_loads(load, count)
            _check_contact(np.isfinite(depths))
        _check_thickness(depths, layer)
    return felt


def gaps_at(
    surface: Mesh | Surface,
    centres: ArrayLike,
    axes: ArrayLike,
    within: float,
    cells: tuple[int, int] = (16, 16),
    pitch: float = 0.001,
    unit: float = 1.0,
) -> np.ndarray:
    """Distances that each cell of an array can still approach until its layer touches the object.

    Parameters
    ----------
    surface : Surface, Mesh or any input of `as_mesh`
        The object.
    centres : (k, 3) array_like
        Centres of the arrays, in units of the mesh.
    axes : (k, 3, 3) array_like
        Unit vectors right, up and normal of each array.
    within : float or str
        Metres after the first contact within which a surface counts, or a text such as "2mm"; a smaller value is
        faster.
    cells : tuple of 2 ints
        Rows and columns.
    pitch : float or str
        Distance of neighbouring cells, in units of the mesh, or a text such as "1mm".
    unit : float or str
        Metres that a unit of the mesh is long; `haptic_glance.gaps_at` also takes a name such as "mm".

    Returns
    -------
    (k, rows, cols) array of float
        Metres; below 0 where the object is in the layer of an array that stands at its centre, inf where a cell meets
        nothing within `within`. The array starts above the place at a height of its longer side, so that it meets
        overhangs.

    Raises
    ------
    ValueError
        For invalid arrays, and for lengths that are none.
    """
    check_unit(unit)
    if not isinstance(within, int | float | np.number) or not within >= 0:  # NaN fails as well
        raise ValueError(f"within must be 0 m or more, got {within}")
    centres, axes = check_places(centres, axes)
    cells, pitches, reaches = check_arrays(cells, pitch, None, len(centres))
    starts = centres + reaches[:, None] * axes[:, 2]
    gaps = as_surface(surface).first_below(starts, axes, cells, pitches, within / unit)
    gaps -= reaches[:, None, None]
    gaps *= unit
    return gaps


def forces(
    gaps: np.ndarray,
    layer: Layer,
    areas: ArrayLike,
    load: ArrayLike | None = None,
    depth: ArrayLike | None = None,
) -> np.ndarray:
    """Forces along the normals of taxels under a layer.

    Parameters
    ----------
    gaps : (k, ...) array of float
        Metres, from anywhere, that the array can approach until a taxel's layer touches the object; inf for never.
    layer : Layer
        The layer on the array.
    areas : float or array_like
        Areas of the taxels in square metres: a number, or one per taxel.
    load : float or (k,) array_like, optional
        Newtons on the whole array along its approach, at which the approach ends (the sum is exact). Give `load` or
        `depth`.
    depth : float, str or (k,) array_like, optional
        Metres of approach after the first contact; `haptic_glance.forces` also takes a text such as "2mm".

    Returns
    -------
    (k, ...) array of float
        Newtons.

    Raises
    ------
    ValueError
        For a load that is not positive, a negative depth, an indentation above the layer's thickness, and a load on an
        array that touches nothing. The message names the touch.

    References
    ----------
    Johnson, Contact Mechanics, 1985, section 4.3: on a fine array, a sphere of radius R at a small depth d in the layer
    gives a load of pi R d^2 layer.stiffness, a flat punch of area A gives A d layer.stiffness.

    Examples
    --------
    >>> import numpy as np
    >>> from haptic_glance import Layer, forces
    >>> forces(np.zeros((1, 2, 2)), Layer(), areas=1e-4, load=4.0).round(6).tolist()  # a flat punch
    [[[1.0, 1.0], [1.0, 1.0]]]
    """
    gaps = np.asarray(gaps, dtype=np.float64)
    if (load is None) == (depth is None):
        raise ValueError("give either load, in newtons, or depth, in metres")
    if gaps.ndim == 0:
        raise ValueError("gaps must have shape (k, ...), a row for each touch, got a number")
    if not (gaps > -np.inf).all():  # NaN fails as well
        raise ValueError("gaps must be numbers of metres, inf where nothing is in range")
    _check_areas(areas := _per_taxel("areas", areas, gaps.shape[1:]))
    least = gaps.min(axis=tuple(range(1, gaps.ndim)), initial=np.inf)
    weights = (layer.stiffness * areas).ravel()
    # From the first contact on: sums with the distance of an array that starts far away would round the depth off.
    near = gaps - np.where(np.isfinite(least), least, 0.0).reshape(-1, *[1] * (gaps.ndim - 1))
    if depth is not None:
        depths = checked_depths(depth, len(gaps))
    else:
        rows = near.reshape(len(gaps), weights.size)
        loads = _checked_loads(load, len(gaps))
        _check_contact(np.isfinite(rows).any(axis=1))
        depths = depths_of_loads(rows, weights, loads, layer.thickness)
    _check_thickness(depths, layer)
    normal_forces = np.subtract(depths.reshape(-1, *[1] * (gaps.ndim - 1)), near, out=near)
    np.maximum(normal_forces, 0.0, out=normal_forces)
    normal_forces *= layer.stiffness * areas
    return normal_forces


def shear(normal: np.ndarray, slips: ArrayLike, layer: Layer, areas: ArrayLike) -> np.ndarray:
    """Tangential forces on taxels after the object has slipped sideways.

    Parameters
    ----------
    normal : (...) array of float
        Normal forces in newtons.
    slips : (..., 2) array_like
        Metres that the object has moved along the array's right and up, in one direction since the contact; (k, 2) is
        one slip for all taxels of a touch.
    layer : Layer
        The layer on the array.
    areas : float or array_like
        Areas of the taxels in square metres, as of `forces`.

    Returns
    -------
    (..., 2) array of float
        Newtons along the array's right and up.

    Notes
    -----
    The layer sticks and shears until a taxel's force is friction times its normal force, where it slides. So contacts
    begin to slide at their rim, as those of Cattaneo and Mindlin do.

    References
    ----------
    Johnson, Contact Mechanics, 1985, section 7.2.

    Examples
    --------
    >>> import numpy as np
    >>> from haptic_glance import Layer, shear
    >>> shear(np.array([1.0]), [[1.0, 0.0]], Layer(friction=0.6), areas=1e-6).tolist()  # a metre: it slides
    [[0.6, 0.0]]
    """
    normal, slips = np.asarray(normal, dtype=np.float64), np.asarray(slips, dtype=np.float64)
    if normal.ndim == 0:
        raise ValueError("normal must hold the forces of one or more taxels, as `forces` gives them, got a number")
    if not isinstance(layer, Layer):
        raise TypeError(f"layer must be a Layer such as Layer(friction=0.6), got {layer!r}")
    if slips.shape not in ((len(normal), 2), (*normal.shape, 2)) or not np.isfinite(slips).all():
        raise ValueError(f"slips must be finite and of shape (k, 2) or {(*normal.shape, 2)}, got {slips.shape}")
    if not ((normal >= 0) & np.isfinite(normal)).all():
        raise ValueError("normal must hold newtons of 0 or more, as `forces` gives them")
    _check_areas(areas := _per_taxel("areas", areas, normal.shape))
    slips = slips.reshape(len(normal), *(normal.shape[1:] if slips.ndim > 2 else [1] * (normal.ndim - 1)), 2)
    distance = np.hypot(slips[..., 0], slips[..., 1])
    magnitude = np.minimum(layer.shear_stiffness * areas * distance, layer.friction * normal)
    return magnitude[..., None] * np.divide(slips, distance[..., None], out=np.zeros_like(slips), where=slips != 0)


def _per_taxel(name, values, shape):
    values = np.asarray(values, dtype=np.float64)
    try:
        return np.broadcast_to(values, shape)
    except ValueError:
        raise ValueError(f"{name} must be a number, or one per taxel: {shape}, got shape {values.shape}") from None


def _check_areas(areas):
    if not np.all((areas > 0) & np.isfinite(areas)):
        raise ValueError(f"areas must be above 0 m2, got {np.min(areas)}")


def checked_depths(depth: ArrayLike, count: int) -> np.ndarray:
    """(count,) depths in metres; raises ValueError if one is invalid."""
    depths = _check_finite("depth", _per_touch("depth", depth, count))
    if (depths < 0).any():
        raise ValueError(f"depth must be 0 m or more, got {depths.min():g}: it counts from the first contact")
    return depths


def _checked_loads(load, count):
    loads = _check_finite("load", _per_touch("load", load, count))
    if len(wrong := np.flatnonzero(loads <= 0)):
        raise ValueError(f"load must be above 0 N, got {loads[wrong[0]]:g}: give newtons, or a depth in metres")
    return loads


def _check_contact(facing):
    if not facing.all():
        remedy = "move the array over the object, or take more cells"
        raise ValueError(f"touch {np.argmin(facing)} touches nothing, so no load can be reached: {remedy}")


def _check_thickness(depths, layer):
    if (depths > layer.thickness).any():
        deep, remedy = np.argmax(depths > layer.thickness), "press less, or take a thicker or stiffer layer"
        raise ValueError(f"touch {deep} needs more than the layer's thickness of {layer.thickness:g} m: {remedy}")


def check_unit(unit: float) -> None:
    """Raises ValueError for a unit that is no number of metres above 0."""
    if not 0 < unit < np.inf:
        raise ValueError(f"unit must be a positive number of metres, got {unit}")


def _per_touch(name, values, count):
    try:
        values = np.asarray(values, dtype=np.float64)
    except (TypeError, ValueError):
        raise ValueError(
            f"{name} must be a number in {'newtons' if name == 'load' else 'metres'}, got {values!r}"
        ) from None
    if values.shape not in ((), (count,)):
        raise ValueError(f"{name} must be a number or have shape ({count},), one per touch, got {values.shape}")
    return np.full(count, values)


def _check_finite(name, values):
    if not np.isfinite(values).all():
        raise ValueError(f"{name} must be finite, got {values[~np.isfinite(values)][0]}")
    return values
