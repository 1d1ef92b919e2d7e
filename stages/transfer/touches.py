"""The data: imprints of every object of every class, as many of each, by a fine array and by a coarse one (T5.1.3)."""

from dataclasses import dataclass

import numpy as np

from stages.classes import read_object
from stages.imprints import press_many
from stages.kit.files import read_arrays, write_arrays
from stages.kit.rng import rng
from stages.kit.run import DATA


@dataclass(frozen=True, eq=False)
class Touches:
    """Imprints of classes of objects: images (k, r, c) u1, labels (k,) i8 into classes, vertices (k,) i8.

    ranks (k,) i8: which object of its class a touch is of, 0 the first.
    """

    images: np.ndarray
    labels: np.ndarray
    ranks: np.ndarray
    vertices: np.ndarray
    classes: list[str]

    @property
    def objects(self):
        """(k,) i8: which object of all a touch is of."""
        return self.labels * (self.ranks.max() + 1) + self.ranks


def arrays(settings):
    """{data: sensels a side} of all arrays that press; the first is the one of the thesis's table 5.4."""
    return {f"imprints{cells}": cells for cells in (settings.cells, *settings.coarse_cells)}


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
    mesh, _ = read_object(DATA / "classes" / f"{name}.npz")
    return len(np.unique(mesh.faces[mesh.face_areas > 0]))


def press_touches(mesh, vertices, cells, pitch):
    """(k, cells, cells) u1: the imprints at k vertices in 256 grey values, as an image file has."""
    pressed = np.asarray(press_many(mesh, vertices, cells=(cells, cells), pitch=pitch))
    return np.round(np.clip(pressed, 0, 1) * 255).astype(np.uint8)


def process(name, folder, settings, seed):
    """Presses the touches of one object with every array and writes them to imprints/NAME.npz.

    Returns no rows: what pressing costs is the imprints stage's to say.
    """
    mesh, salient = read_object(DATA / "classes" / f"{name}.npz")
    if settings.detector not in salient:
        raise ValueError(f"transfer.detector={settings.detector}: not among classes.methods: {', '.join(salient)}")
    vertices = choose_vertices(mesh, salient[settings.detector], settings.touches, rng(seed, f"touches {name}"))
    width = settings.cells * settings.pitch
    images = {data: press_touches(mesh, vertices, cells, width / cells) for data, cells in arrays(settings).items()}
    write_arrays(folder / "imprints" / f"{name}.npz", vertices=vertices, **images)
    return []


def read_touches(folder, members, data):
    """The touches of members {class: its objects} by the array `data`, in their order. folder: data/transfer."""
    images, labels, ranks, vertices = [], [], [], []
    for label, objects in enumerate(members.values()):
        for rank, name in enumerate(objects):
            stored = read_arrays(folder / "imprints" / f"{name}.npz")
            images.append(stored[data])
            vertices.append(stored["vertices"])
            labels += [label] * len(stored["vertices"])
            ranks += [rank] * len(stored["vertices"])
    parts = np.concatenate(images), np.array(labels), np.array(ranks), np.concatenate(vertices)
    return Touches(*parts, list(members))
