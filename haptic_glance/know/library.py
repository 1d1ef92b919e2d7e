"""A library of objects known by touch, and the belief over the objects after some touches.

The library stores imprints of each object at places of the array (a vertex, or a point of a face with its normal), and
tells how likely a new imprint is under each object.
"""

import hashlib
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property, lru_cache
from pathlib import Path

import numpy as np
from scipy.spatial import KDTree

from haptic_glance.base.extras import MissingExtra
from haptic_glance.base.files import read_mesh
from haptic_glance.base.lazy import trimesh
from haptic_glance.base.rng import rng
from haptic_glance.base.warner import warn_caller
from haptic_glance.base.weak_cache import weak_cache
from haptic_glance.mesh import MeshError, normalise, rotate_to_z_up
from haptic_glance.mesh.files import FORMATS, MeshLike, names_of, with_known_up
from haptic_glance.mesh.mesh import Mesh, unit
from haptic_glance.mesh.repair import area_share
from haptic_glance.mesh.sampling import along_curve, sample_surface
from haptic_glance.touch import Skin, Surface, press_at, sensor_axes
from haptic_glance.touch.places import Places
from haptic_glance.touch.skin import as_shares
from haptic_glance.touch.surface import CANCELLED, mean_vertex_normals, turned

from .belief import (
    BLOCK,
    FLOOR,
    LAST,
    ORDERS,
    STOPS,
    Calibration,
    calibrate,
    calibrate_to_stop,
    feature_kernel,
    log_likelihood,
    nearest_outcomes,
    place_kernel,
)
from .components import COMPONENTS, Components
from .features import FEATURES, features
from .planner import State, by_gain
from .unknown import NONE, Verifier, check_unknown, log_pooled

SURE = 0.95  # belief in one object at which it is known


@dataclass(frozen=True)
class Belief:
    """log_likelihoods (classes,): sums over the touches so far under each object of the library.

    components (touches, 12): of the imprints so far; pooled: the sum of their log likelihoods under all objects pooled.
    """

    library: "Library"
    log_likelihoods: np.ndarray
    touches: int = 0
    components: np.ndarray = field(default_factory=lambda: np.zeros((0, COMPONENTS)))
    pooled: float = 0.0

    def after(self, image: np.ndarray, position: np.ndarray) -> "Belief":
        """The Belief after one more touch: an imprint (rows, cols) of the library's array at a position (3,).

        image: bytes, or numbers in 0..1; 0 where the array meets the surface first. position: in units of the
        normalised object, in which its centre is the origin. Raises ValueError for others, and,
        if the objects are `placed`, for a position more than one unit from all learned touches.
        """
        place = np.asarray(position, dtype=np.float64)
        if place.shape != (3,) or not np.isfinite(place).all():
            raise ValueError(f"a touch needs a position of three finite numbers, got {position}")
        self.library.check_near(place)
        components = self.library.components(np.asarray(image)[None])
        evidence = self.library.evidence(components, place[None])[0]
        return Belief(
            self.library,
            self.log_likelihoods + evidence,
            self.touches + 1,
            np.concatenate([self.components, components]),
            self.pooled + float(log_pooled(evidence)),
        )

    @cached_property
    def among_known(self) -> np.ndarray:
        """(classes,) probabilities if the object is one of the library's, in the order of its names."""
        touches = max(self.touches, 1)
        return np.exp(self.library.calibration.log_belief(self.log_likelihoods, touches))

    @cached_property
    def none(self) -> float:
        """The probability that the object is none of the library's: 0 unless it was learned with `unknown`."""
        if (verifier := self.library.verifier) is None:
            return 0.0
        return 1 - verifier.probability(self.log_likelihoods, self.pooled, self.components)

    @cached_property
    def values(self) -> np.ndarray:
        """(classes,) probabilities, in the order of the library's names; equal before the first touch."""
        return self.among_known * (1 - self.none)

    @property
    def probabilities(self) -> dict[str, float]:
        """{name: probability}, the likeliest first; with "none of these" if the library was learned with `unknown`."""
        by_name = dict(zip(self.library.names, self.values.tolist(), strict=True))
        if self.library.verifier is not None:
            by_name[NONE] = self.none
        return dict(sorted(by_name.items(), key=lambda item: -item[1]))

    @property
    def known(self) -> str:
        """The name of the object that is known: its probability is at least SURE; else empty.

        It is "none of these" where that has this probability.
        """
        name, probability = next(iter(self.probabilities.items()))
        return name if probability >= SURE else ""


NEAR = 0.01  # units, one cell of the default array: within it a point belongs to its vertex


def sample_places(surface: Surface, count: int, random: np.random.Generator) -> Places:
    """Places of `count` points, drawn uniformly by area, so that all lie in faces with a normal, in random order.

    The order of vertices, faces and corners has no influence. Raises ValueError for a mesh without area.
    """
    shares = (np.arange(count) + random.random(count)) / count  # one in each of `count` equal parts of the surface
    order, mesh = by_position(surface.mesh)
    points, faces, _ = sample_surface(mesh, shares, random.random((2, count)))
    shuffled = random.permutation(count)  # or places that follow one another would be neighbours
    return place_at(surface, points[shuffled], order[faces[shuffled]])


@weak_cache
def by_position(mesh: Mesh) -> tuple[np.ndarray, Mesh]:
    """(ids (m,), a Mesh) of the faces along a curve that fills space, each from its first corner by place."""
    ranks = np.argsort(np.lexsort(mesh.vertices.T[::-1]))[mesh.faces]
    first = (ranks.argmin(axis=1)[:, None] + np.arange(3)) % 3
    code = along_curve(mesh.vertices[mesh.faces].mean(axis=1))
    order = np.lexsort((*np.take_along_axis(ranks, first, axis=1).T[::-1], code))
    return order, Mesh(mesh.vertices, np.take_along_axis(mesh.faces, first, axis=1)[order])


def place_at(surface: Surface, points: np.ndarray, faces: np.ndarray) -> Places:
    """Places of points (k, 3) that lie in faces (k,).

    A point within NEAR of a corner of its face is moved to this vertex, with the normal that `press` has there. A
    single face of a fine scan is no guide to how an array lies on it. On a large face the normal is the face's own.
    """
    mesh, rows = surface.mesh, np.arange(len(points))
    corners = mesh.faces[faces]
    distances = np.linalg.norm(mesh.vertices[corners] - points[:, None], axis=2)
    nearest = distances.argmin(axis=1)
    vertices = corners[rows, nearest]
    averages = mean_vertex_normals(mesh)[vertices]
    at_vertex = (distances[rows, nearest] <= NEAR) & (np.linalg.norm(averages, axis=1) > CANCELLED)
    return Places(
        np.where(at_vertex, vertices, -1),
        np.where(at_vertex[:, None], mesh.vertices[vertices], points),
        np.where(at_vertex[:, None], unit(averages), mesh.face_normals[faces]),
    )


TOUCHES = 128  # a learned object; twice as many know no more of the household objects
CELLS, PITCH = (16, 16), 0.01  # of the array, T4.3
LONGEST = 20  # touches of each order, for the calibration of the belief
AWAY = np.exp(-3.0)  # weight of no learned touch at a place: of one three widths of `place_kernel` away
FAR = 1.0  # units, a normalised object's size: a place farther from all learned touches is in another unit


def learn(
    meshes: Mapping[str, MeshLike],
    placed: bool = True,
    seed: int = 0,
    turned: bool = False,
    skin: Skin | None = None,
    unknown: bool = False,
) -> "Library":
    """Learns objects by touch; a mesh that was learned before costs nothing.

    Parameters
    ----------
    meshes : mapping of str to Mesh or any input of `as_mesh`
        Two or more meshes by name. They are rotated so that z is up. A Mesh must be scaled by `normalise`; any other
        input is scaled here.
    placed : bool
        True: the objects stand where they were learned. False: they stand upright at an unknown place.
    seed : int
        Seed of the places that are touched.
    turned : bool
        Whether each array is turned at random about its normal, as it lies on an object that may also be turned. A pose
        of which nothing is known needs placed=False and turned=True.
    skin : Skin, optional
        The sensor by whose imprints the objects are learned, and by which an `Exploration` touches. Where a real array
        has dead cells or noise, a belief that was learned with an ideal array is sure too soon, and often wrong.
    unknown : bool
        Whether an object may be none of these, which is then an answer of its own with a probability. False: an object
        that was never learned gets the name of a learned one, and often a sure one. True needs three meshes or more; a
        known object needs more touches, and stays undecided more often.

    Returns
    -------
    Library
        The objects, with a calibrated belief.

    Raises
    ------
    ValueError
        For fewer than two meshes, three with `unknown`; for a mesh that cannot be touched or has another scale, and for
        a mesh called "none of these" with `unknown`; the message names the mesh.
    TypeError
        For meshes that are no mapping, for names that are no texts, and for a skin that is none.

    Warns
    -----
    UserWarning
        For a mesh that does not say which axis points up, and for two equal meshes.

    Examples
    --------
    >>> import numpy as np
    >>> from haptic_glance.know import Exploration, learn, primitives
    >>> shapes = primitives()
    >>> library = learn({name: shapes[name] for name in ("box", "cylinder")}, placed=False)
    >>> Exploration(library, shapes["cylinder"], np.random.default_rng(0)).finish()
    'cylinder'

    A torus that was never learned, with its probability to be none of five other shapes:

    >>> others = {name: shape for name, shape in shapes.items() if name != "torus"}
    >>> exploration = Exploration(learn(others, unknown=True), shapes["torus"], np.random.default_rng(0))
    >>> exploration.finish()
    'none of these'
    >>> round(exploration.belief.none, 2)
    0.97
    """
    check_names(meshes)
    if len(meshes) < 2:
        raise ValueError("at least two objects are needed: with one there is nothing to tell apart")
    if unknown:
        check_unknown(len(meshes), TOUCHES)
    if skin is not None and not callable(skin):
        raise TypeError(f"skin must be a Skin such as Skin(noise=0.02), got {skin!r}")
    upright = {name: upright_named(name, meshes[name]) for name in sorted(meshes)}
    upright = {name: mesh if isinstance(meshes[name], Mesh) else normalise(mesh) for name, mesh in upright.items()}
    objects = tuple(_Named(name, mesh, seed, turned, skin) for name, mesh in upright.items())
    _warn_of_equal(objects)
    return _library(objects, placed, unknown)


def _warn_of_equal(objects):
    """Warns of each mesh that was given under an earlier name, too."""
    middles = [item.mesh.vertices[item.mesh.faces].mean(axis=1) for item in objects]
    centres = np.array([points.mean(axis=0) for points in middles])
    for late, item in enumerate(objects):
        near = np.flatnonzero(np.abs(centres[:late] - centres[late]).max(axis=1) < SAME)
        name = next((objects[early].name for early in near if _are_equal(middles[early], middles[late])), "")
        if name:
            warn_caller(
                f"{name} and {item.name} are the same mesh, which no touch tells apart: a name of one of the two may "
                "be wrong, so leave one out"
            )


SAME = 1e-5  # units: two formats of one mesh round its vertices by less


def _are_equal(first: np.ndarray, second: np.ndarray) -> bool:
    """Whether two meshes have the same faces to rounding, by the middles (f, 3) of these in any order."""
    if len(first) != len(second):
        return False
    return bool(np.isfinite(KDTree(first).query(second, distance_upper_bound=SAME)[0]).all())


def check_names(meshes: object) -> None:
    """Raises TypeError for meshes that are no mapping, and for names that are no texts."""
    if not isinstance(meshes, Mapping):
        raise TypeError(f"meshes must be a mapping from names to meshes, got {type(meshes).__name__}")
    if wrong := [name for name in meshes if not (isinstance(name, str) and name)]:
        raise TypeError(f"meshes must have texts as names, got {wrong[0]!r}")


def upright_named(name: str, mesh: MeshLike) -> Mesh:
    """The Mesh turned to z up; a warning names it where nothing says which axis points up."""
    return rotate_to_z_up(with_known_up(mesh, reason=f"{name} does not say which axis points up"))


def touched(name: str, mesh: Mesh, seed: int = 0) -> np.ndarray:
    """(TOUCHES, 41) features of the touches by which `learn` knows a mesh; ValueError where it cannot be touched."""
    return _learned(_Named(name, mesh, seed, False, None))[0]


@dataclass(frozen=True)
class Expected:
    """The outcomes that touches at k places may have, for each possible object: the planner's prediction.

    predicted (k, classes, outcomes, classes): log likelihoods of possible touches if it is this object;
    probabilities (k, classes, outcomes): of each, if it is this object.
    """

    predicted: np.ndarray
    probabilities: np.ndarray


class Library:
    """Objects known by touch.

    Parameters
    ----------
    names : tuple of str
        Names of the objects.
    samples : (classes, touches, 41) array of float
        Features of their touches, by `features` of imprints in 0..1.
    positions : (classes, touches, 3) array of float
        Places of the touches, in units of the normalised mesh.
    placed : bool
        Whether the objects stand as they were learned.
    seed : int
        Seed of the calibration.
    skin : Skin, optional
        The sensor by which the objects were touched; None: an ideal one.
    turned : bool
        Whether each array was turned at random about its normal; an `Exploration` then turns its arrays, too.
    unknown : bool
        Whether an object may be none of these, as in `learn`.

    Raises
    ------
    ValueError
        For equal names, for samples and positions that are not finite or do not fit them, for features of bytes, and,
        with `unknown`, for fewer than three objects or four touches of each, or an object called "none of these".

    Notes
    -----
    The likelihood of an imprint is that of T4.2: a kernel density of its components; if the objects are `placed`, of
    the touches near its place. A learned touch is used like a new one when it is compared with all others but itself;
    that calibrates the belief.
    """

    def __init__(
        self, names: tuple[str, ...], samples: np.ndarray, positions: np.ndarray, placed: bool, seed: int = 0,
        skin: Skin | None = None, turned: bool = False, unknown: bool = False,
    ) -> None:  # fmt: skip
        self.names, self.placed, self.skin, self.turned = names, placed, skin, turned
        samples, positions = np.asarray(samples), np.asarray(positions)
        _check_samples(names, samples, positions)
        if unknown:
            check_unknown(*samples.shape[:2])
        if unknown and NONE in names:
            raise ValueError(f"an object is called {NONE!r}, which is the answer where it is unknown: rename it")
        classes, self._touches = samples.shape[:2]
        self._owners = np.repeat(np.arange(classes), self._touches)
        self._reduction = Components(flat := samples.reshape(-1, samples.shape[2]))
        self._components, self._positions = self._reduction.transform(flat), positions.reshape(-1, 3)
        self._evidence = self._of_own_touches()
        self.calibration: Calibration = self._calibrate(seed)
        self.verifier: Verifier | None = self._verifier(rng(seed, "unknown")) if unknown else None

    def belief(self) -> Belief:
        """The Belief before the first touch: all objects alike."""
        return Belief(self, np.zeros(len(self.names)))

    def check_near(self, position: np.ndarray) -> None:
        """Raises ValueError if the objects are `placed` and a position (3,) is more than FAR from all their touches."""
        distance = np.linalg.norm(self._positions - position, axis=1).min()
        if self.placed and distance > FAR:
            raise ValueError(
                f"the touch at {position.tolist()} is {distance:.3g} units from all touches that were learned: give "
                "its position in units of the normalised object, whose centre is the origin, or learn with placed=False"
            )

    def log_likelihoods(self, images: np.ndarray, positions: np.ndarray) -> np.ndarray:
        """(k, classes) log likelihoods of imprints (k, *CELLS) at positions (k, 3) under each object, to a constant.

        images: bytes, or numbers in 0..1; ValueError for others.
        If the objects are `placed`, a touch counts less the farther it is from all learned touches: there none of them
        says what an object feels like.
        """
        return self.evidence(self.components(images), np.asarray(positions))

    def components(self, images: np.ndarray) -> np.ndarray:
        """(k, 12) principal components of the features of imprints (k, *CELLS); as in `log_likelihoods`."""
        if np.shape(images)[1:] != CELLS:
            raise ValueError(f"this library was learned with {CELLS} cells, the imprints have {np.shape(images)[1:]}")
        return self._reduction.transform(features(as_shares(np.asarray(images))))

    def evidence(self, components: np.ndarray, positions: np.ndarray) -> np.ndarray:
        """`log_likelihoods` of imprints by their components (k, 12)."""
        kernel = feature_kernel(components, self._components)
        evidence = self._log_likelihood(kernel, positions, np.arange(len(self._owners)))
        if not self.placed:
            return evidence
        near = place_kernel(positions, self._positions).sum(axis=1, keepdims=True)
        return evidence * (1 - (AWAY / (near + AWAY)) ** 2)  # 0 away from all objects, 1 at one of them

    def expect(self, places: Places) -> Expected:
        """The possible findings of touches at places: on object c, one of the learned touches of c near the place.

        Near in the frame in which c was learned, even where the objects are not `placed`, as in the stage exploration.
        """
        distances = np.linalg.norm(places.positions[:, None] - self._positions[None], axis=2)
        outcomes, probabilities = nearest_outcomes(distances, self._owners)
        if not self.placed:
            return Expected(self._evidence[outcomes], probabilities)
        predicted = [self._at_place(*place) for place in zip(places.positions, outcomes, strict=True)]
        return Expected(np.stack(predicted), probabilities)

    def gains(self, belief: Belief, expected: Expected) -> np.ndarray:
        """(k,) nats by which the entropy of the belief is expected to fall with a touch at each of k places.

        The belief is that among the known objects.
        """
        random_scores = np.zeros((1, len(expected.predicted)))
        parts = random_scores, expected.predicted[None], expected.probabilities[None], self.calibration
        beliefs = belief.among_known[belief.among_known > 0]
        return by_gain(State(belief.log_likelihoods[None], belief.touches, *parts))[0] - beliefs @ np.log(beliefs)

    def _log_likelihood(self, kernel, positions, ids):
        """(k, classes) of touches at positions (k, 3) whose kernel (k, n) with the learned touches `ids` is given.

        The kernel is 0 for a learned touch that must not count. If the objects are placed, it is the likelihood of
        what was felt given the place: a person or the planner chose it, which says nothing of the object.
        """
        owners = self._owners[ids]
        if not self.placed:
            return log_likelihood(kernel, owners, (kernel > 0) @ np.eye(len(self.names))[owners])
        near, of_object = place_kernel(positions, self._positions[ids]) * (kernel > 0), np.eye(len(self.names))[owners]
        return np.log(np.maximum((kernel * near) @ of_object / (near @ of_object + AWAY), FLOOR))

    def _of_own_touches(self):
        """(n, classes) log likelihoods of the learned touches, each without itself."""
        rows, parts = np.arange(len(self._components)), []
        for block in np.split(rows, rows[BLOCK::BLOCK]):
            kernel = feature_kernel(self._components[block], self._components)
            kernel[np.arange(len(block)), block] = 0
            parts.append(self._log_likelihood(kernel, self._positions[block], rows))
        return np.concatenate(parts)

    def _at_place(self, position, outcomes):
        """(classes, outcomes, classes) log likelihoods of touches like the `outcomes` (classes, outcomes), all here."""
        ids = outcomes.ravel()  # of farther touches the place kernel is next to nothing
        kernel = feature_kernel(self._components[ids], self._components[ids])
        np.fill_diagonal(kernel, 0)
        evidence = self._log_likelihood(kernel, position[None], ids)
        return evidence.reshape(*outcomes.shape, len(self.names))

    def _verifier(self, random):
        shape = len(self.names), self._touches, -1
        evidence, components = self._evidence.reshape(shape), self._components.reshape(shape)
        return Verifier(evidence, components, self.calibration, SURE, random)

    def _calibrate(self, seed):
        touches = self._evidence.reshape(len(self.names), self._touches, -1)

        def sequences(orders, longest, random):
            truth = np.repeat(np.arange(len(self.names)), orders)
            order = np.array([random.permutation(self._touches)[:longest] for _ in truth])
            return touches[truth[:, None], order], truth

        average = calibrate(*sequences(ORDERS, LONGEST, rng(seed, "calibration")))
        orders = max(STOPS // len(self.names), ORDERS)
        return calibrate_to_stop(*sequences(orders, LAST, rng(seed, "stops")), SURE, average)


def _check_samples(names, samples, positions):
    if repeated := [name for name in dict.fromkeys(names) if names.count(name) > 1]:
        raise ValueError(f"names must differ, {repeated[0]!r} occurs twice")
    shapes = (len(names), *samples.shape[1:2])
    if not all(shapes) or samples.shape != (*shapes, len(FEATURES)) or positions.shape != (*shapes, 3):
        raise ValueError(
            f"samples and positions must have shapes (classes, touches, {len(FEATURES)}) and (classes, touches, 3) "
            f"with {len(names)} classes, one per name, got {samples.shape} and {positions.shape}"
        )
    for kind, values in (("samples", samples), ("positions", positions)):
        if len(wrong := np.argwhere(~np.isfinite(values))):
            raise ValueError(f"{kind} must be finite, got {values[tuple(wrong[0])]} in touch {wrong[0][1]} of "
                             f"{names[wrong[0][0]]}")  # fmt: skip
    if len(wrong := np.argwhere(samples[..., FEATURES.index("max")] > 1)):
        raise ValueError(f"samples must be features of imprints in 0..1, those of {names[wrong[0][0]]} are of larger "
                         "numbers: divide bytes by 255")  # fmt: skip


class _Named:
    """A mesh under a name; equal where name, seed, content, `turned` and skin are."""

    def __init__(self, name: str, mesh: Mesh, seed: int, turned: bool, skin: Skin | None) -> None:
        self.content = hashlib.sha256(mesh.vertices.tobytes() + mesh.faces.tobytes()).hexdigest()
        self.name, self.mesh, self.key = name, mesh, (name, seed, self.content, turned, skin)
        self.seed, self.turned, self.skin = seed, turned, skin

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Named) and self.key == other.key

    def __hash__(self) -> int:
        return hash(self.key)


@lru_cache(maxsize=4)
def _library(objects: tuple[_Named, ...], placed: bool, unknown: bool) -> Library:
    samples, positions = zip(*map(_learned, objects), strict=True)
    names = tuple(item.name for item in objects)
    _, seed, _, turned, skin = objects[0].key
    return Library(names, np.stack(samples), np.stack(positions), placed, seed, skin, turned, unknown)


SCALE = 0.87, 2.0  # the diagonal of a normalised object is 1 to 1.74; no object of half or double the size passes


def check_scale(mesh: Mesh) -> None:
    """Raises ValueError for a mesh of another scale than that of `normalise`: the array would feel something else."""
    if not SCALE[0] < mesh.diagonal < SCALE[1]:
        raise ValueError(f"the object's diagonal is {mesh.diagonal:.3g}, not 1 to 1.74 as in the library: normalise it")


@lru_cache(maxsize=256)
def _learned(item: _Named) -> tuple[np.ndarray, np.ndarray]:
    """(features (TOUCHES, 41), positions (TOUCHES, 3)) of an object."""
    try:
        surface = Surface(item.mesh)
        places = sample_places(surface, TOUCHES, rng(item.seed, item.name))
        check_scale(item.mesh)
        axes = sensor_axes(places.normals)
        if item.turned:
            axes = turned(axes, 360 * rng(item.seed, f"{item.name} turned").random(TOUCHES))
        images = press_at(surface, places.positions, axes, CELLS, PITCH)
        images = images if item.skin is None else item.skin(images, item.name)
    except ValueError as error:
        raise ValueError(f"{item.name}: {error}") from None
    return features(images), places.positions


SIZES = ("medium", "small")  # the household set has its basic shapes in three sizes, which `normalise` makes equal


PRIMITIVES: dict[str, Callable[[], "trimesh.Trimesh"]] = {
    "ball": lambda: trimesh.creation.icosphere(subdivisions=4),
    "box": lambda: trimesh.creation.box((1.0, 0.7, 0.5)),
    "capsule": lambda: trimesh.creation.capsule(height=1.0, radius=0.3),
    "cone": lambda: trimesh.creation.cone(radius=0.4, height=1.0, sections=64),
    "cylinder": lambda: trimesh.creation.cylinder(radius=0.3, height=1.0, sections=64),
    "torus": lambda: trimesh.creation.torus(major_radius=1.0, minor_radius=0.35),
}


def primitives() -> dict[str, Mesh]:
    """{name: normalised mesh} of six basic shapes."""
    shapes = {name: make() for name, make in PRIMITIVES.items()}
    return {
        name: normalise(Mesh(np.asarray(shape.vertices), np.asarray(shape.faces))) for name, shape in shapes.items()
    }


def known_objects(folder: str | Path, most: int = 60) -> tuple[dict[str, Mesh], list[str]]:
    """Reads the meshes of a folder, normalised.

    Parameters
    ----------
    folder : path
        A folder of mesh files, or data/SET/meshes of the pipeline; a folder that is absent holds none.
    most : int
        Number of meshes at most, in alphabetical order.

    Returns
    -------
    meshes : dict of str to Mesh
        Normalised meshes by name.
    left_out : list of str
        Names of the files that were left out, with the reasons.

    Raises
    ------
    ValueError
        For a file in place of a folder.

    Warns
    -----
    UserWarning
        For a mesh that does not say which axis points up.
    """
    if Path(folder).is_file():
        raise ValueError(f"{folder} is a file: give the folder that holds it")
    shown = sorted(path for path in Path(folder).glob("*") if not path.name.startswith("."))
    files = [path for path in shown if path.suffix.lower() in (*FORMATS, ".npz")]
    stems = {path.stem for path in files}
    files = [path for path in files if path.suffix != ".npz" or not _is_another_size(path.stem, stems)]
    meshes, notes = {}, [f"{path.name}: more than {most} objects" for path in files[most:]]
    for path, name in zip(files[:most], names_of(files), strict=False):
        try:
            mesh = read_mesh(path) if path.suffix == ".npz" else normalise(upright_named(path.name, path))
            area_share(mesh)  # or `learn` would refuse all
            meshes[name] = mesh
        except (MeshError, MissingExtra, ValueError, KeyError, OSError) as error:
            notes.append(f"{path.name}: {str(error).removeprefix(f'{path}: ')}")
    return meshes, notes


def _is_another_size(stem, stems):
    return any(stem.endswith(size) and stem.removesuffix(size) + "large" in stems for size in SIZES)
