"""Whether the glance gives one answer for one surface: `python -m benchmarks.invariance [METHOD]`

Meshes: 20 of the household set, of ../shared/data/gaze.zip and psb.zip, the sample, a box and a cylinder. Each mesh is
changed in ways that do not change its surface: faces permuted, corners rolled from (a, b, c) to (c, a, b), faces
subdivided 1 to 4, turned by 37 degrees about the vertical, mirrored. Two further changes do change the surface: noise
of 0.5 % of the diagonal at the vertices, and half of the faces.

Writes reports/bench/invariance.csv. `r`: correlation of the saliency at the vertices with the one before; `largest`:
the largest difference at a vertex, of a range of 1; `ten` and `thirty`: share of 10 places found again within 2 % of
the diagonal, of 30 places within 3 %; `first`: distance of the first place from the old one, or from the nearest of
the ten that is equivalent to it, in units of the diagonal; `seconds` of the processor for saliency and 10 places. The
last rows are the mean and the worst of all objects.
"""

import time
import zipfile
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pandas as pd
import trimesh

from benchmarks import arguments
from haptic_glance.base.fetch import cache_folder
from haptic_glance.base.files import write_table
from haptic_glance.base.rng import rng
from haptic_glance.lod.simplify import simplify
from haptic_glance.look.points import detect
from haptic_glance.mesh import normalise, rotate_to_z_up
from haptic_glance.mesh.files import load_unnamed, parse
from haptic_glance.mesh.mesh import Mesh
from stages.stability.measures import repeatability

OUT, SHARED = Path("reports/bench/invariance.csv"), Path("../shared/data")
NOISE, TURN = 0.005, np.radians(37)
HOUSEHOLD = "elephant", "duck", "hand", "cup", "stapler", "mug"
GAZE = "bunny", "cow", "rockerarm", "carter", "MaxPlanck"
PRINCETON = "Airplane/61", "Bearing/341", "Bird/241", "Chair/101", "Human/1", "Vase/361"
ARCHIVES = [  # (file, its members, axis that points up)
    (cache_folder() / "MyoSuite-2.2.0-py3-none-any.whl",
     [f"myosuite/simhive/object_sim/{name}/{name}.stl" for name in HOUSEHOLD], "z"),
    (SHARED / "gaze.zip", [f"Models_3D/{name}.obj" for name in GAZE], "y"),
    (SHARED / "psb.zip", [f"LabeledDB_new/{name}.off" for name in PRINCETON], "y"),
]  # fmt: skip


def objects() -> Iterator[tuple[str, Mesh]]:
    """(name, normalised Mesh with z up) of each object that this machine has."""
    for shape in ("box", "cylinder"):
        solid = trimesh.creation.box((0.8, 0.5, 0.3)) if shape == "box" else trimesh.creation.cylinder(0.2, 0.9)
        yield shape, normalise(Mesh(solid.vertices, solid.faces))
    yield "dromedary", normalise(rotate_to_z_up(load_unnamed(Path("samples/dromedary.glb"))))
    for archive, members, up in ARCHIVES:
        if archive.exists():
            with zipfile.ZipFile(archive) as files:
                for member in members:
                    mesh = parse(files.read(member), Path(member).suffix)
                    yield "_".join(Path(member).with_suffix("").parts[-2:]), normalise(rotate_to_z_up(mesh, up))


def changed(mesh: Mesh) -> Iterator[tuple[str, Mesh, np.ndarray, np.ndarray | None]]:
    """(change, Mesh, (3, 3) matrix of the change, for its vertices those of the mesh, None where these have moved)."""
    same, turn = np.eye(3), trimesh.transformations.rotation_matrix(TURN, [0, 0, 1])[:3, :3]
    ids, random = np.arange(len(mesh.vertices)), rng(0, "invariance")
    yield "permuted", Mesh(mesh.vertices, random.permutation(mesh.faces)), same, ids
    yield "rolled", Mesh(mesh.vertices, np.roll(mesh.faces, 1, axis=1)), same, ids
    yield "subdivided", Mesh(*trimesh.remesh.subdivide(mesh.vertices, mesh.faces)), same, ids
    yield "turned", Mesh(mesh.vertices @ turn.T, mesh.faces), turn, ids
    yield "mirrored", Mesh(mesh.vertices * [-1, 1, 1], mesh.faces[:, ::-1]), np.diag([-1.0, 1, 1]), ids
    if len(mesh.faces) > 1000:
        moved = mesh.vertices + random.normal(0, NOISE * mesh.diagonal, mesh.vertices.shape)
        yield "noise", Mesh(moved, mesh.faces), same, ids
        yield "half_of_the_faces", simplify(mesh, len(mesh.faces) // 2), same, None


def rows_of(name: str, mesh: Mesh, method: str) -> list[dict]:
    """A row per change."""
    saliency, places, ties, seconds = look(mesh, method)
    rows = [{"object": name, "faces": len(mesh.faces), "change": "none", "seconds": seconds}]
    for change, other, matrix, ids in changed(mesh):
        values, positions, _, seconds = look(other, method)
        back = [points @ matrix for points in positions]
        away = np.linalg.norm(places[0][ties] - back[0][0], axis=1).min() if len(back[0]) else np.nan
        rows.append(
            {"object": name, "faces": len(other.faces), "change": change, "seconds": seconds,
             "r": np.nan if ids is None else np.corrcoef(saliency, values[ids])[0, 1],
             "largest": np.nan if ids is None else np.abs(saliency - values[ids]).max(),
             "ten": repeatability(places[0], back[0], 0.02 * mesh.diagonal),
             "thirty": repeatability(places[1], back[1], 0.03 * mesh.diagonal), "first": away / mesh.diagonal}
        )  # fmt: skip
    return rows


def look(mesh: Mesh, method: str) -> tuple[np.ndarray, list[np.ndarray], np.ndarray, float]:
    """(saliency, positions of 10 and of 30 places, ids of the places that are as good as the first, seconds)."""
    start = time.process_time()
    detection = detect(mesh, method, 10)
    seconds = time.process_time() - start
    assert detection.saliency is not None and detection.ties is not None
    places = [mesh.vertices[ids] for ids in (detection.points, detect(mesh, method, 30).points)]
    return detection.saliency, places, np.flatnonzero(detection.ties == 0), seconds


def main() -> None:
    """Measures and writes the table."""
    chosen = arguments(__doc__, method="glance")
    rows = []
    for name, mesh in objects():
        rows += rows_of(name, mesh, chosen.method)
        print(pd.DataFrame(rows[-8:]).to_string(header=len(rows) < 12), flush=True)
    frame = pd.DataFrame(rows)
    changes = frame[frame.change != "none"].groupby("change", sort=False)
    worst = changes.agg({"r": "min", "largest": "max", "ten": "min", "thirty": "min", "first": "max"})
    mean = changes[list(worst)].mean()
    summaries = [table.reset_index().assign(object=name) for name, table in (("mean", mean), ("worst", worst))]
    write_table(OUT, pd.concat([frame, *summaries]))
    print(*summaries, sep="\n")


if __name__ == "__main__":
    main()
