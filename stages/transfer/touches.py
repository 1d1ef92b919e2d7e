"""The data: high resolution imprints of each class's object (T5.1.3)."""

from dataclasses import dataclass

import numpy as np

from stages.imprints import press_many
from stages.kit.files import read_arrays, read_mesh, write_arrays
from stages.kit.rng import rng
from stages.salient_points import read_points


@dataclass(frozen=True, eq=False)
class Touches:
    """Imprints with their class: images (k, r, c) u1, labels (k,) i8 into classes, vertices (k,) i8."""

    images: np.ndarray
    labels: np.ndarray
    vertices: np.ndarray
    classes: list[str]


def choose_vertices(mesh, salient, count, generator):
    """(count,) i8 distinct vertex ids: the salient ones first, then blind ones spread evenly over the area.

    Every object gives an equal number of touches (T5.1.3), and their detectors do not find equally many points.
    Raises ValueError where the mesh has too few vertices.
    """
    salient = np.asarray(salient, dtype=np.int64)[:count]
    area = np.zeros(len(mesh.vertices))
    np.add.at(area, mesh.faces, mesh.face_areas[:, None] / 3)
    area[salient] = 0
    left = count - len(salient)
    if (area > 0).sum() < left:
        raise ValueError(f"{count} touches wanted, but only {len(salient) + (area > 0).sum()} vertices can be touched")
    blind = generator.choice(len(area), size=left, replace=False, p=area / area.sum()) if left else salient[:0]
    return np.concatenate([salient, blind])


def touchable_vertices(name):
    """How many vertices of an object's mesh lie on a surface."""
    mesh = read_mesh(f"data/meshes/{name}.npz")
    return len(np.unique(mesh.faces[mesh.face_areas > 0]))


def press_touches(mesh, vertices, cells, pitch):
    """(k, cells, cells) u1: the imprints at k vertices in 256 grey values, as an image file has."""
    pressed = np.asarray(press_many(mesh, vertices, cells=(cells, cells), pitch=pitch))
    return np.round(np.clip(pressed, 0, 1) * 255).astype(np.uint8)


def process(name, folder, settings, seed):
    """Presses the touches of one object and writes them to imprints/NAME.npz.

    Returns no rows: what pressing costs is the imprints stage's to say.
    """
    mesh = read_mesh(f"data/meshes/{name}.npz")
    salient = read_points(f"data/salient_points/{name}.npz")
    if settings.detector not in salient:
        raise ValueError(f"transfer.detector={settings.detector}: not among the methods found: {', '.join(salient)}")
    vertices = choose_vertices(mesh, salient[settings.detector], settings.touches, rng(seed, f"touches {name}"))
    images = press_touches(mesh, vertices, settings.cells, settings.pitch)
    write_arrays(folder / "imprints" / f"{name}.npz", images=images, vertices=vertices)
    return []


def read_touches(folder, classes):
    """The touches of all classes, in the order of the classes."""
    stored = [read_arrays(folder / "imprints" / f"{name}.npz") for name in classes]
    counts = [len(part["images"]) for part in stored]
    return Touches(
        images=np.concatenate([part["images"] for part in stored]),
        labels=np.repeat(np.arange(len(classes)), counts),
        vertices=np.concatenate([part["vertices"] for part in stored]),
        classes=list(classes),
    )
