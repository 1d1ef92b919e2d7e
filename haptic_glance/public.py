"""The public functions: they take a mesh in any form, and lengths and face counts as text."""

from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from dataclasses import replace
from functools import wraps
from importlib import import_module
from inspect import signature
from pathlib import Path
from typing import Any

import numpy as np
from scipy.spatial import KDTree

from haptic_glance.base.warner import warn_caller
from haptic_glance.base.weak_cache import weak_cache
from haptic_glance.lod.export import face_count
from haptic_glance.lod.feasibility import InfeasibleTarget, SimplifyError
from haptic_glance.lod.task import repaired
from haptic_glance.mesh.axes import AUTO, AXES, Axis, axis_named
from haptic_glance.mesh.files import WITH_UP, MeshLike, as_mesh, as_stated, with_known_up
from haptic_glance.mesh.headers import MeshError
from haptic_glance.mesh.mesh import Mesh
from haptic_glance.mesh.repair import RADIUS, centre_and_radius, rotate_to_z_up
from haptic_glance.touch.skin import METRES, Layer, Metres, length

PATH_ARGUMENTS = {  # public function: its arguments that may be a path, or another form of a mesh
    **dict.fromkeys(
        ("clean", "conspicuity", "detect", "find_points", "normalise", "press", "press_many", "render",
         "rotate_to_z_up", "saliency", "sensor_normals", "simplify", "to_trimesh", "write_any"), ("mesh",)
    ),
    **dict.fromkeys(("gaps_at", "press_forces"), ("surface",)),
    **dict.fromkeys(("metro", "perceptual"), ("reference", "mesh")),
    "as_mesh": ("source",),
    "forces": (),
    "follow": ("mesh_or_surface",),
}  # fmt: skip
# Lengths that are shares of the diameter, or texts such as "1mm"; and the one length in metres, or such a text.
LENGTH_ARGUMENTS = {
    "press": ("pitch", "max_distance"), "press_many": ("pitch", "max_distance"), "follow": ("pitch",),
}  # fmt: skip
METRE_ARGUMENTS = {"press_forces": "depth", "gaps_at": "within", "forces": "depth"}
# They depend on the axis that is up, or tell it: a warning says where the shape chose it.
DEPENDS_ON_UP = "as_mesh", "detect", "find_points", "saliency", "press", "press_many", "rotate_to_z_up"
KEEPS_UP = "clean", "normalise", "simplify"  # hand an axis that nobody has said on, unknown as it is
TRIES = 8  # lower counts that are tried where one leaves a fold


def accepts_any_mesh(name: str, function: Callable[..., Any]) -> Callable[..., Any]:
    """The public function of a name, made of the one of its package: it takes meshes in any form, and lengths as text.

    Functions of LENGTH_ARGUMENTS also take `unit`, what the coordinates of the mesh are in.
    """
    function = simplify if name == "simplify" else function
    parameters = signature(function)
    convert = as_stated if name in KEEPS_UP else as_mesh
    remedy = "up={!r}" if "up" in parameters.parameters else WITH_UP

    @wraps(function)
    def work(*args: Any, **kwargs: Any) -> Any:
        unit = kwargs.pop("unit", None) if name in LENGTH_ARGUMENTS else None
        bound = parameters.bind(*args, **kwargs)
        bound.apply_defaults()
        values = bound.arguments
        for argument in PATH_ARGUMENTS[name]:
            mesh = values[argument]
            if not isinstance(getattr(mesh, "mesh", mesh), Mesh) or getattr(mesh, "up", "") == AUTO:
                warned = name in DEPENDS_ON_UP and values.get("up") is None
                values[argument] = with_known_up(mesh, remedy) if warned else convert(mesh)
        if name in LENGTH_ARGUMENTS:
            _convert_lengths(values, LENGTH_ARGUMENTS[name], unit)
        if name in METRE_ARGUMENTS:
            _convert_metres(values, METRE_ARGUMENTS[name])
        return function(*bound.args, **bound.kwargs)

    work.__module__ = "haptic_glance"  # where pickle finds it
    return work


def _convert_lengths(values: dict[str, Any], names: Sequence[str], unit: str | None) -> None:
    """Converts lengths of these names, shares of the object's diameter or texts such as "1mm", to units of the mesh.

    The first of the values is the mesh or its Surface. The diameter is that of the bounding sphere about the middle of
    the bounding box of the upright object, which is 1 for a normalised mesh.
    """
    if unit is not None and not any(isinstance(values[name], str) for name in names):
        raise ValueError(f'unit={unit!r} applies to lengths such as "1mm" of {" and ".join(names)}: leave it out')
    whole = next(iter(values.values()))
    diameter = _diameter(getattr(whole, "mesh", whole))
    for name in names:
        if values[name] is not None:
            text = values[name]
            values[name] = in_units(name, text, diameter, unit)
            if name == "pitch" and isinstance(text, str) and "cells" in values:
                _warn_of_misfit(f"pitch={text!r}", values["cells"], values[name], diameter)


def _convert_metres(values: dict[str, Any], metric: str) -> None:
    """Converts a `unit` such as "mm" to metres, and texts such as "1mm" to numbers.

    A number stays what it is: of metres, of the argument named `metric`; of units of the mesh, of the pitch.
    """
    if isinstance(unit := values.get("unit", 1.0), str):
        if unit not in METRES:
            raise ValueError(f"unit={unit!r}: give a number of metres, or one of {', '.join(METRES)}")
        values["unit"] = unit = METRES[unit]
    for name in ("pitch", metric):
        if isinstance(text := values.get(name), str):
            try:
                amount = length(text)
            except ValueError:
                raise ValueError(f'{name}={text!r}: give a number, or a length such as "1mm"') from None
            real = name == "pitch" and isinstance(amount, Metres)
            values[name] = float(amount) / (values["unit"] if real else 1)
    if not isinstance(layer := values.get("layer", Layer()), Layer):
        raise TypeError(f"layer must be a Layer such as Layer(thickness=0.002), got {layer!r}")
    if "layer" in values and "surface" in values:
        pitch, cells = values["pitch"], values["cells"]
        diameter = _diameter(getattr(values["surface"], "mesh", values["surface"]))
        if diameter > 0 and np.ndim(unit) == 0 and 0 < unit < np.inf:  # the function refuses others
            _warn_of_misfit(f"pitch={pitch:g}, unit={unit:g}", cells, pitch, diameter, layer, unit)


def in_units(name: str, value: float | str, diameter: float, unit: str | None) -> Any:
    """A length in units of the mesh: a share of its diameter, or text such as "1mm" of a mesh whose unit is known."""
    if not isinstance(value, str):
        if name == "pitch" and not (np.ndim(value) == 0 and 0 < value < 1):
            raise ValueError(f"pitch={value}: give a share of the object's diameter between 0 and 1, such as 0.01")
        return value if abs(diameter - 1) < 1e-9 else np.multiply(value, diameter)
    try:
        amount = length(value)
    except ValueError:
        raise ValueError(
            f'{name}={value!r}: give a share of the diameter such as 0.01, or a length such as "1mm"'
        ) from None
    if not isinstance(amount, Metres):
        return amount * diameter
    if unit not in METRES:
        unit_text = "" if unit is None else f", not {unit!r}"
        unit_names = ", ".join(METRES)
        raise ValueError(f"{name}={value!r} needs unit, the unit of its coordinates: {unit_names}{unit_text}")
    return float(amount) / METRES[unit]


def _warn_of_misfit(
    name: str, cells: Sequence[int], pitch: float, diameter: float, layer: Layer | None = None, unit: float = 1.0
) -> None:
    """Warns where the array, its layer or the object has a size that only a wrong unit of length explains.

    name: of the length, as the warning begins. unit: metres that a unit of the mesh is long, for the layer.
    """
    from haptic_glance.touch.distances import check_array  # `press` has imported both, which take a while
    from haptic_glance.touch.quasi_tangent import misfit, misfit_of_layer

    cells, pitch, _ = check_array(cells, pitch)
    wrong = misfit(cells, pitch / diameter)
    if not wrong and layer and (wrong := misfit_of_layer(layer, max(cells) * pitch * unit, diameter * unit)):
        wrong = f"{wrong}; is the unit of length right?"
    if wrong:
        warn_caller(f"{name}: {wrong}")


@weak_cache
def _diameter(mesh: Mesh) -> float:
    upright = mesh if mesh.up in (*AXES, AUTO) else rotate_to_z_up(mesh)  # another axis turns the box
    return float(centre_and_radius(upright)[1] / RADIUS)


def load(path: str | Path, up: Axis | None = None) -> Mesh:
    """Reads a mesh file: STL, OBJ, PLY, OFF, GLB or glTF, and with the extra `pipeline` a point cloud.

    Parameters
    ----------
    path : path
        The file, see `haptic_glance.mesh.files`.
    up : str or (3,) array_like, optional
        The axis that points up: `x`, `-y`, `Z`, or a vector such as (0, 1, 1). None: the axis that the file states, as
        every GLB does; else y or z by the shape, with a warning that states the probability. "auto": always by the
        shape.

    Returns
    -------
    Mesh
        The mesh in the units of the file.

    Raises
    ------
    MeshError
        For a file that cannot be read, with the reason and the remedy.
    ValueError
        For an axis that is none.

    Examples
    --------
    >>> import trimesh
    >>> from haptic_glance import load
    >>> _ = trimesh.creation.box().export("box.stl")
    >>> load("box.stl", up="z").faces.shape
    (12, 3)
    """
    if up is None:
        return with_known_up(path, "load(path, up={!r})")
    mesh = replace(as_stated(path), up=axis_named(up))
    return with_known_up(mesh, "load(path, up={!r})", f"by the shape of {Path(path).name}") if mesh.up == AUTO else mesh


def simplify(
    mesh: Mesh, faces: int | float | str, keep: Sequence[int] | np.ndarray | None = None, rings: Any = 3,
    backend: str = "fast", shrink: bool = False, weights: np.ndarray | None = None, attributes: Any = None,
    free_borders: bool | Sequence[bool] | np.ndarray | None = None,
) -> Mesh:  # fmt: skip
    """Simplifies a mesh, with chosen neighbourhoods kept or with more detail where weights are high.

    Parameters
    ----------
    mesh : Mesh or any input of `as_mesh`
        The mesh.
    faces : int, float or str
        Most faces of the result: a count, a share of the mesh's own such as 0.25, or a text, "25%" or "1500". A float
        of at most 1 is a share, so that 1.0 asks for the mesh itself, and 1 for one face.
    keep : int or sequence of int, optional
        Vertex ids, most salient first, whose neighbourhoods stay unchanged (T3.1.3).
    rings : int or (k,) array_like
        Edges from each kept vertex to the rim of its neighbourhood.
    backend : {"fast", "qslim", "pymeshlab"}
        `fast` fits the vertices to the surface; `qslim` does not; `pymeshlab` is the reference.
    shrink : bool
        Whether neighbourhoods shrink, the least salient first, if the count needs it.
    weights : (n,) array_like, optional
        Weights in 0..1, such as a saliency: the error counts more where they are high.
    attributes : mapping of str to float, optional
        Weights of `colors`, `normals` and `uv` in the error.
    free_borders : bool or (n,) array of bool, optional
        Whether the boundary is simplified, too. None: only if the count is infeasible without.

    Returns
    -------
    Mesh
        A mesh of at most `faces` faces, with the colours, texture and up axis of the given one.

    Raises
    ------
    InfeasibleTarget
        If the frozen faces leave too few; its `smallest` is a feasible count.
    SimplifyError
        If every attempt leaves a fold.
    ValueError
        For invalid arguments.

    Notes
    -----
    If the count is infeasible, the function first merges coincident vertices and orients faces, as `repair` does, and
    simplifies the borders. If the result has a fold, the function tries a few faces fewer. Without kept points it also
    tries counts near which the surface loses its shape. `haptic_glance.lod.simplify` does the simplification alone.

    References
    ----------
    Garland and Heckbert, Surface simplification using quadric error metrics, SIGGRAPH 1997 (T [222]).

    Examples
    --------
    >>> import trimesh
    >>> from haptic_glance import simplify
    >>> len(simplify(trimesh.creation.icosphere(3), "25%").faces)
    320
    """
    work = import_module("haptic_glance.lod").simplify
    target = str(faces)
    keep = None if keep is None else np.atleast_1d(keep)
    if isinstance(faces, float | np.floating) and 0 < faces <= 1:
        target = f"{100 * float(target):.12f}%" if faces < 1 else str(len(mesh.faces))
    count = face_count(target, len(mesh.faces), "faces")
    arguments = dict(keep=keep, weights=weights, rings=rings, backend=backend, shrink=shrink, attributes=attributes)
    borders = [False if free_borders is None else free_borders]
    if free_borders is None and not attributes and backend != "pymeshlab":
        borders.append(True)
    failures = []
    for whole, settings, free in _attempts(mesh, arguments, borders):
        try:
            return _around_folds(work, whole, count, free_borders=free, **settings)
        except (InfeasibleTarget, SimplifyError) as error:
            failures.append(error)
    if len(borders) > 1 and keep is None:
        with suppress(InfeasibleTarget, SimplifyError):
            return work(whole, count, free_borders=True, below=True, **settings)
    infeasible = [error for error in failures if isinstance(error, InfeasibleTarget)]
    raise min(infeasible, key=lambda error: error.smallest) if infeasible else failures[0]


def _around_folds(work: Callable[..., Mesh], mesh: Mesh, count: int, **options: Any) -> Mesh:
    """The Mesh of at most `count` faces; where just that many leave a fold, of a few fewer, by other collapses."""
    try:
        return work(mesh, count, **options)
    except SimplifyError:
        for fewer in range(count - 2, max(count - 2 * TRIES, 1) - 1, -2):
            with suppress(SimplifyError):
                return work(mesh, fewer, **options)
        raise


def _attempts(
    mesh: Mesh, arguments: dict[str, Any], borders: Sequence[Any]
) -> Iterator[tuple[Mesh, dict[str, Any], Any]]:
    """(mesh, arguments, borders that may move) of each attempt: the mesh as given, repaired, and with free borders.

    The repair comes before the free borders, since it closes seams, which free borders would tear open. A mesh is not
    repaired where borders or rings are given vertex by vertex, since the repair renumbers vertices.
    """
    yield mesh, arguments, borders[0]
    mended = mesh
    if not np.ndim(borders[0]) and not np.ndim(arguments["rings"]):
        with suppress(MeshError):  # the errors of the other attempts say which count is feasible
            mended = repair(mesh)
    loses_colors = mended.colors is None and "colors" in (arguments["attributes"] or ())  # they became a texture
    if mended != mesh and not loses_colors:
        nearest = KDTree(mesh.vertices).query(mended.vertices)[1]
        weights, keep = arguments["weights"], arguments["keep"]
        if weights is not None:
            weights = np.asarray(weights)[nearest]
        if keep is not None:
            keep = KDTree(mended.vertices).query(mesh.vertices[np.asarray(keep, dtype=np.int64)])[1]
        mesh, arguments = mended, arguments | {"weights": weights, "keep": keep}
        yield mesh, arguments, borders[0]
    for free in borders[1:]:
        yield mesh, arguments, free


def repair(mesh: MeshLike) -> Mesh:
    """Removes repeated and degenerate faces, turns the other faces outwards, and merges coincident vertices.

    Parameters
    ----------
    mesh : Mesh or any input of `as_mesh`
        The mesh.

    Returns
    -------
    Mesh
        The repaired mesh. Vertices are merged only where that closes the boundary; their ids change then.

    Raises
    ------
    MeshError
        If nothing is left.

    Examples
    --------
    >>> import trimesh
    >>> from haptic_glance import repair
    >>> soup = trimesh.creation.box()
    >>> soup.unmerge_vertices()  # 36 corners, as an STL file stores them
    >>> len(repair(soup).vertices)
    8
    """
    return repaired(as_stated(mesh))[0]
