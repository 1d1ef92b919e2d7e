"""The data: equally many imprints of every object, by a fine array and by coarser ones (T5.1.3)."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from haptic_glance.base.files import read_arrays, read_mesh, write_arrays
from haptic_glance.base.rng import rng
from haptic_glance.mesh.mesh import Mesh
from haptic_glance.touch import press_many
from stages.salient_points.measure import read_points

from . import Params


@dataclass(frozen=True, eq=False)
class Touches:
    """Imprints of classes of objects: images (k, r, c) u1; labels (k,) i8 into classes.

    vertices (k,) i8; ranks (k,) i8: the index in its class of each touch's object.
    """

    images: np.ndarray
    labels: np.ndarray
    ranks: np.ndarray
    vertices: np.ndarray
    classes: list[str]

    @property
    def objects(self) -> np.ndarray:
        """(k,) i8: a number for each touch's object, different for all objects."""
        return self.labels * (self.ranks.max() + 1) + self.ranks


def sensor_arrays(settings: Params) -> dict[str, int]:
    """{data: sensels a side} of all sensor arrays; the first is that of the thesis's table 5.4."""
    return {f"imprints{cells}": cells for cells in (settings.cells, *settings.coarse_cells)}


def choose_vertices(mesh: Mesh, salient: np.ndarray, count: int, generator: np.random.Generator) -> np.ndarray:
    """(count,) i8 distinct vertex ids: the salient ones first, then random ones, uniform over the surface.

    Every object gets the same number of touches (T5.1.3), although its detector may find fewer points. Raises
    ValueError where the mesh has too few vertices.
    """
    salient = np.asarray(salient, dtype=np.int64)[:count]
    area = np.zeros(len(mesh.vertices))
    np.add.at(area, mesh.faces, mesh.face_areas[:, None] / 3)
    area[salient] = 0
    missing = count - len(salient)
    if (area > 0).sum() < missing:
        raise ValueError(
            f"{count} touches are needed, but only {len(salient) + (area > 0).sum()} vertices can be touched"
        )
    random = generator.choice(len(area), size=missing, replace=False, p=area / area.sum()) if missing else salient[:0]
    return np.concatenate([salient, random])


def count_touchable_vertices(mesh: Mesh) -> int:
    """The number of vertices of a mesh that are on its surface."""
    return len(np.unique(mesh.faces[mesh.face_areas > 0]))


def press_touches(mesh: Mesh, vertices: np.ndarray, cells: int, pitch: float) -> np.ndarray:
    """(k, cells, cells) u1: the imprints at k vertices in 256 grey values."""
    imprints = np.asarray(press_many(mesh, vertices, cells=(cells, cells), pitch=pitch))
    return np.round(np.clip(imprints, 0, 1) * 255).astype(np.uint8)


def process(name: str, folder: Path, data: Path, settings: Params, seed: int) -> list[dict]:
    """Presses the touches of one object with every array and writes them to imprints/NAME.npz.

    Returns no rows: the imprints stage measures the cost of pressing.
    """
    mesh, salient = read_mesh(data / "meshes" / f"{name}.npz"), read_points(data / "salient_points" / f"{name}.npz")
    if settings.detector not in salient:
        names = ", ".join(salient)
        raise ValueError(f"transfer.detector={settings.detector}: not among salient_points.methods: {names}")
    vertices = choose_vertices(mesh, salient[settings.detector], settings.touches, rng(seed, f"touches {name}"))
    width = settings.cells * settings.pitch
    images = {
        data: press_touches(mesh, vertices, cells, width / cells) for data, cells in sensor_arrays(settings).items()
    }
    write_arrays(folder / "imprints" / f"{name}.npz", vertices=vertices, **images)
    return []


def read_touches(folder: Path, members: Mapping[str, Sequence[str]], data: str) -> Touches:
    """The touches of members {class: its objects} by the array `data`, in their order. folder: data/SET/transfer."""
    images, labels, ranks, vertices = [], [], [], []
    for label, objects in enumerate(members.values()):
        for rank, name in enumerate(objects):
            arrays = read_arrays(folder / "imprints" / f"{name}.npz")
            images.append(arrays[data])
            vertices.append(arrays["vertices"])
            labels += [label] * len(arrays["vertices"])
            ranks += [rank] * len(arrays["vertices"])
    parts = np.concatenate(images), np.array(labels), np.array(ranks), np.concatenate(vertices)
    return Touches(*parts, list(members))
