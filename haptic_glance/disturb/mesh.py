"""Disturbances of a mesh: colour, tessellation, scan by depth cameras, pose, holes, winding, noise, order and unit."""

import colorsys
from dataclasses import replace

import numpy as np
from scipy.spatial import KDTree

from haptic_glance.base.extras import from_extra
from haptic_glance.lod import InfeasibleTarget, simplify, smallest_feasible
from haptic_glance.look.camera import Viewpoint, pixel_rays
from haptic_glance.look.views import render
from haptic_glance.look.views.shading import GREY
from haptic_glance.mesh import Cloud, surface_of
from haptic_glance.mesh.axes import to_z_up
from haptic_glance.mesh.clouds import normals_of
from haptic_glance.mesh.materials import bake_texture
from haptic_glance.mesh.mesh import Mesh

from .perturbed import Perturbed, in_range

WAVES = 12  # sine waves whose sum decides between the two colours
LENGTH = 0.3  # of a wave, over the diagonal: patches are then the size of an object's parts


def paint(mesh: Mesh, severity: float, generator: np.random.Generator) -> Perturbed:
    """The whole object in one colour with a saturation of `severity`; the hue is drawn at random."""
    colour = _colour(generator.random(), in_range(severity, 0, 1, "saturation"))
    return _painted(mesh, np.tile(colour, (len(mesh.vertices), 1)))


def pattern(mesh: Mesh, severity: float, generator: np.random.Generator) -> Perturbed:
    """Smooth random patches of two complementary colours with a saturation of `severity`."""
    hue, saturation = generator.random(), in_range(severity, 0, 1, "saturation")
    waves = 2 * np.pi / (LENGTH * max(mesh.diagonal, 1e-30)) * _directions(generator)
    height = np.cos(mesh.vertices @ waves.T + generator.uniform(0, 2 * np.pi, WAVES)).sum(axis=1)
    two = np.stack([_colour(hue, saturation), _colour(hue + 0.5, saturation)])
    return _painted(mesh, two[(height > 0).astype(int)])


def grey(mesh: Mesh, severity: float, _generator: np.random.Generator) -> Perturbed:
    """The object's own colours without a share `severity` of their hue; their brightness stays."""
    return _faded(mesh, severity, lambda colors: colors.mean(axis=1, keepdims=True))


def clay(mesh: Mesh, severity: float, _generator: np.random.Generator) -> Perturbed:
    """The object's own colours moved by a share `severity` to the even grey of objects without colours."""
    return _faded(mesh, severity, lambda colors: GREY)


def _faded(mesh, severity, target):
    mesh = bake_texture(mesh)
    if mesh.colors is None:
        raise ValueError("has no colours to take away: run it on a set with meshes.colours=own")
    share, colors = in_range(severity, 0, 1, "the share of colour taken away"), mesh.colors.astype(np.float64)
    faded = np.rint((1 - share) * colors + share * target(colors)).astype(np.uint8)
    return Perturbed(replace(mesh, colors=faded), mesh.vertices)


def _directions(generator):
    vectors = generator.standard_normal((WAVES, 3))
    return vectors / np.linalg.norm(vectors, axis=1, keepdims=True)


def _colour(hue, saturation):
    """(3,) f8: the factor by which the paint multiplies red, green and blue underneath."""
    return np.array(colorsys.hsv_to_rgb(hue % 1, saturation, 1.0))


def _painted(mesh, coat):
    mesh = bake_texture(mesh)
    under = np.full((len(mesh.vertices), 3), GREY) if mesh.colors is None else mesh.colors
    return Perturbed(replace(mesh, colors=np.rint(under * coat).astype(np.uint8)), mesh.vertices)


# pymeshlab comes without types:
# pyright: reportAttributeAccessIssue=false


# All parameters are given: pymeshlab sets one that is left out to its value in the call before, not to its default.
SETTINGS = {
    "iterations": 5,
    "adaptive": False,
    "selectedonly": False,
    "featuredeg": 30.0,  # degrees; sharper edges stay
    "checksurfdist": True,
    "splitflag": True,
    "collapseflag": True,
    "swapflag": True,
    "smoothflag": True,
    "reprojectflag": True,
}
FARTHEST = 1.0  # from the surface, percent of the diagonal


def remeshing(mesh: Mesh, severity: float, _generator: np.random.Generator) -> Perturbed:
    """Isotropic triangles with edges of `severity` of the diagonal: splits, collapses, flips, smoothing (pymeshlab).

    Colours are those of the nearest vertex. Raises ValueError where the surface collapses at this edge length.
    """
    length, mesh = 100 * in_range(severity, 1e-3, 1, "the edge length over the diagonal"), bake_texture(mesh)
    with from_extra("a mesh is remeshed by pymeshlab, which "):
        import pymeshlab

    work = pymeshlab.MeshSet(verbose=False)
    work.add_mesh(pymeshlab.Mesh(mesh.vertices, mesh.faces))
    try:
        lengths = {"targetlen": length, "maxsurfdist": FARTHEST}
        lengths = {name: pymeshlab.PercentageValue(value) for name, value in lengths.items()}
        work.apply_filter("meshing_isotropic_explicit_remeshing", **lengths, **SETTINGS)
    except pymeshlab.PyMeshLabException as error:
        raise ValueError(f"this mesh cannot be remeshed: {' '.join(str(error).split())}") from None
    vertices, faces = work.current_mesh().vertex_matrix(), work.current_mesh().face_matrix()
    if len(faces) == 0 or not np.isfinite(vertices).all():
        raise ValueError(f"no surface is left at edges of {severity:g} of the diagonal: take shorter ones")
    colors = None if mesh.colors is None else mesh.colors[KDTree(mesh.vertices).query(vertices)[1]]
    return Perturbed(Mesh(vertices, faces, colors, up=mesh.up), vertices)


ELEVATION = 20.0  # degrees above the horizon: the underside is never seen
SIZE = 90, 120  # rows, columns: about 85 pixels across an object
FACES = 10_000  # at most, but where a sheet has so many holes; the reconstruction is finer than the readings
NOISE = 0.001  # sigma along the line of sight, share of the diagonal


def scan(mesh: Mesh, severity: float, generator: np.random.Generator) -> Perturbed:
    """The surface that depth images reconstruct, `severity` degrees apart around the object: 90 are four, 360 is one.

    A camera is as in T3.2.6, its readings are noisy, and what none sees is a hole (haptic_glance.mesh.surface_of).
    Salient points that lay there count as lost. Raises ValueError where no surface is left, and unless z is up.
    """
    if mesh.up != "z":
        raise ValueError(f"is {mesh.up} up, and cameras stand around +z: see haptic_glance.rotate_to_z_up")
    in_range(severity, 10, 360, "the degrees between cameras")
    mesh = bake_texture(mesh)
    azimuths = generator.uniform(0, 360) + np.arange(0, 360, severity)
    views = [_points_seen(mesh, Viewpoint(float(azimuth), ELEVATION), generator) for azimuth in azimuths]
    points, normals = (np.concatenate(parts) for parts in zip(*views, strict=True))
    surface = surface_of(Cloud(points, normals))
    surface = _fewer(surface) if len(surface.faces) > FACES else surface
    colors = None if mesh.colors is None else mesh.colors[KDTree(mesh.vertices).query(surface.vertices)[1]]
    return Perturbed(Mesh(surface.vertices, surface.faces, colors), surface.vertices)


def _fewer(surface):
    """FACES of the faces; the border of a thin sheet, which is ragged, is simplified where it needs more."""
    if smallest_feasible(surface) <= FACES:
        return simplify(surface, FACES)
    try:
        return simplify(surface, FACES, free_borders=True)
    except InfeasibleTarget as error:
        return simplify(surface, error.smallest, free_borders=True)


def _points_seen(mesh, viewpoint, generator):
    """(points (k, 3), their normals (k, 3)) of one depth image."""
    view = render(mesh, viewpoint, SIZE, "raster")
    rows, columns = np.nonzero(view.mask)
    origins, directions = pixel_rays(rows, columns, viewpoint, SIZE)
    away = view.depth[rows, columns] + NOISE * mesh.diagonal * generator.standard_normal(len(rows))
    points = origins + away[:, None] * directions
    return points, normals_of(points, origins.mean(axis=0))


def turn(mesh: Mesh, severity: float, _generator: np.random.Generator) -> Perturbed:
    """Turned by `severity` degrees about the axis that points up: the views show other sides."""
    return _rotated(mesh, severity, np.array([0.0, 0.0, 1.0]))


def tilt(mesh: Mesh, severity: float, generator: np.random.Generator) -> Perturbed:
    """Tilted by `severity` degrees about a random horizontal axis: the object is no longer upright."""
    way = generator.uniform(0, 2 * np.pi)
    return _rotated(mesh, severity, np.array([np.cos(way), np.sin(way), 0.0]))


def _rotated(mesh, degrees, axis):
    """Rodrigues' rotation about an axis of length one, named as if z were up."""
    angle, axis = np.radians(degrees), axis @ to_z_up(mesh.up)
    cross = np.cross(np.eye(3), axis)  # rows e_i x axis: vertices @ cross = vertices x axis
    spin = np.eye(3) - np.sin(angle) * cross + (1 - np.cos(angle)) * (np.outer(axis, axis) - np.eye(3))
    return Perturbed(replace(mesh, vertices=mesh.vertices @ spin), mesh.vertices)


PATCHES = 4  # holes per object


def missing_faces(mesh: Mesh, severity: float, generator: np.random.Generator) -> Perturbed:
    """The share `severity` of the faces is missing, in round patches around faces drawn by area.

    A harsher severity widens the same holes. Salient points that lay there count as lost.
    """
    missing_count = int(in_range(severity, 0, 1, "the share of faces missing") * len(mesh.faces))
    if missing_count >= len(mesh.faces) or not mesh.face_areas.sum() > 0:
        raise ValueError(f"{missing_count} of {len(mesh.faces)} faces missing leave no surface: take a smaller share")
    middles = mesh.vertices[mesh.faces].mean(axis=1)
    centres = middles[generator.choice(len(middles), PATCHES, p=mesh.face_areas / mesh.face_areas.sum())]
    distances = np.linalg.norm(middles[:, None] - centres, axis=2).min(axis=1)
    face_ids = np.sort(np.argsort(distances, kind="stable")[missing_count:])
    ids, corners = np.unique(mesh.faces[face_ids], return_inverse=True)
    colors = None if mesh.colors is None else mesh.colors[ids]
    texture = mesh.texture and mesh.texture.of(face_ids)
    return Perturbed(Mesh(mesh.vertices[ids], corners.reshape(-1, 3), colors, texture, mesh.up), mesh.vertices[ids])


def winding(mesh: Mesh, severity: float, generator: np.random.Generator) -> Perturbed:
    """The share `severity` of the faces, drawn at random, is inverted; at 1 the whole mesh is inside out.

    The meshes stage corrects such faces; a caller who computes a saliency directly may still have them.
    """
    flips = generator.random(len(mesh.faces)) < in_range(severity, 0, 1, "the share of faces")
    faces = mesh.faces.copy()
    faces[flips] = faces[flips][:, ::-1]
    return Perturbed(replace(mesh, faces=faces, texture=mesh.texture and mesh.texture.turned(flips)), mesh.vertices)


def noise(mesh: Mesh, severity: float, generator: np.random.Generator) -> Perturbed:
    """Gaussian noise on each coordinate of the vertices, with a sigma of `severity` of the diagonal.

    Vertices at one position move together, so that a seam does not open.
    """
    in_range(severity, 0, 1, "sigma over the diagonal")
    places, place_ids = np.unique(mesh.vertices, axis=0, return_inverse=True)
    steps = severity * mesh.diagonal * generator.standard_normal(places.shape)
    return Perturbed(replace(mesh, vertices=mesh.vertices + steps[place_ids.ravel()]), mesh.vertices)


def vertex_order(mesh: Mesh, severity: float, generator: np.random.Generator) -> Perturbed:
    """The share `severity` of the vertices are shuffled; the surface is unchanged."""
    n = len(mesh.vertices)
    old = np.arange(n)
    shuffled_ids = generator.choice(n, int(round(in_range(severity, 0, 1, "the share of vertices") * n)), replace=False)
    old[np.sort(shuffled_ids)] = shuffled_ids
    colors = None if mesh.colors is None else mesh.colors[old]
    shuffled = replace(mesh, vertices=mesh.vertices[old], faces=np.argsort(old)[mesh.faces], colors=colors)
    return Perturbed(shuffled, mesh.vertices[old])


def decimation(mesh: Mesh, severity: float, _generator: np.random.Generator) -> Perturbed:
    """The mesh with the share `severity` of its faces (Garland and Heckbert 1997)."""
    faces = int(in_range(severity, 1e-6, 1, "the share of faces kept") * len(mesh.faces))
    simplified = simplify(mesh, max(faces, 1))
    return Perturbed(simplified, simplified.vertices)


def scale(mesh: Mesh, severity: float, _generator: np.random.Generator) -> Perturbed:
    """Coordinates multiplied by `severity`. For a smaller object in the image see image_size."""
    factor = in_range(severity, 1e-12, 1e12, "the factor")
    return Perturbed(replace(mesh, vertices=mesh.vertices * factor), mesh.vertices)
