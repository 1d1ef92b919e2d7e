"""Force images a second, ours beside MuJoCo's tactile sensor: `python -m benchmarks.tactile [PSB.zip]`

Objects 0.1 m across: spheres of three face counts, and the meshes of the least, the middle and the most faces of
data/household/meshes and of psb.zip. An array of 32 x 32 taxels, 1 mm apart, under 2 mm of foam, pressed
0.5 mm deep at 40 random vertices, the same for all. Methods: `ours`, press_forces to that depth, all touches in one
call; `ours_load`, to the load of that depth; `ours_single`, a call a touch;
`mujoco`, the tactile sensor on a mesh of 32 x 32 vertices, below a box that collides: mj_fwdPosition, mj_fwdVelocity
and mj_sensorVel after each move, which is what a reading needs of a step. It answers with a depth, by an octree of
signed distances of default depth. The methods take turns, and `seconds` is the median of seven rounds on one core.

Writes reports/bench/tactile.csv. Rows `rate`: `value` frames a second, `seconds` one frame's, `ratio` the rate to
mujoco's of the same object. Rows `build`: seconds to prepare the object, once. Rows `error`: `value` is the largest
error of a depth in metres on a sphere, to its own definition: along the normal of the array, or the signed distance.

MuJoCo is no dependency: without `pip install mujoco` its rows say so.
"""

import os
import statistics
import time
from pathlib import Path

import numpy as np
import pandas as pd
import trimesh

from benchmarks import arguments
from haptic_glance.base.files import read_mesh, write_table
from haptic_glance.base.rng import rng
from haptic_glance.mesh import normalise
from haptic_glance.mesh.files import parse
from haptic_glance.mesh.mesh import Mesh
from haptic_glance.touch import (
    Layer,
    Surface,
    gaps_at,
    press_forces,
    sensor_axes,
    sensor_normals,
    touchable,
    warm_up,
)
from stages.meshes.sources import PRINCETON, collection_files

OUT, MESHES, PSB = Path("reports/bench/tactile.csv"), Path("data/household/meshes"), "../shared/data/psb.zip"
SIDE, PITCH, DEPTH, TOUCHES, ROUNDS = 32, 0.001, 0.0005, 40, 7
DIAMETER = 0.1
LAYER = Layer()
SPHERES = {"sphere_4": 4, "sphere_5": 5, "sphere_6": 6}  # subdivisions


class Peer:
    """MuJoCo's tactile sensor on one object; raises ImportError where it is not installed."""

    def __init__(self, mesh):
        import mujoco

        kinds, half, spec = mujoco.mjtGeom, SIDE * PITCH / 2, mujoco.MjSpec()
        solid = spec.add_mesh(name="object", needsdf=True)
        solid.uservert, solid.userface = mesh.vertices.ravel().tolist(), mesh.faces.ravel().tolist()
        solid.inertia = mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL  # it takes open meshes, too
        edge = (SIDE - 1) * PITCH / 2
        spec.add_mesh(name="taxels", scale=[edge, edge, half]).make_plate(resolution=[SIDE, SIDE])
        spec.worldbody.add_geom(name="object", type=kinds.mjGEOM_MESH, meshname="object")
        sensor = spec.worldbody.add_body(name="sensor")
        sensor.add_freejoint()
        sensor.add_geom(name="pad", type=kinds.mjGEOM_BOX, size=[half] * 3, pos=[0, 0, half])
        sensor.add_geom(name="skin", type=kinds.mjGEOM_MESH, meshname="taxels", pos=[0, 0, half], contype=0,
                        conaffinity=0, mass=0)  # fmt: skip
        spec.add_sensor(name="touch", type=mujoco.mjtSensor.mjSENS_TACTILE, objtype=mujoco.mjtObj.mjOBJ_MESH,
                        objname="taxels", reftype=mujoco.mjtObj.mjOBJ_GEOM, refname="skin")  # fmt: skip
        self.mujoco, self.model = mujoco, spec.compile()
        self.data = mujoco.MjData(self.model)

    def touch(self, centres, axes):
        """(k, 1024) depths in metres, in the order of the taxels' vertices."""
        depths, turn = np.empty((len(centres), SIDE * SIDE)), np.empty(4)
        for k, centre in enumerate(centres):
            self.mujoco.mju_mat2Quat(turn, axes[k].T.ravel())
            self.data.qpos[:3], self.data.qpos[3:] = centre, turn
            for step in (self.mujoco.mj_fwdPosition, self.mujoco.mj_fwdVelocity, self.mujoco.mj_sensorVel):
                step(self.model, self.data)
            depths[k] = self.data.sensordata[: SIDE * SIDE]
        return depths

    def taxels(self, centre, axes):
        """(1024, 3): where the taxels are after a touch."""
        self.touch(centre, axes)
        first, geom = self.model.mesh("taxels").id, self.model.geom("skin").id
        start = self.model.mesh_vertadr[first]
        local = self.model.mesh_vert[start : start + SIDE * SIDE]
        return local @ self.data.geom_xmat[geom].reshape(3, 3).T + self.data.geom_xpos[geom]


def objects(archive):
    """(name, Mesh) 0.1 m across: spheres, then real shapes."""
    for name, subdivisions in SPHERES.items():
        ball = trimesh.creation.icosphere(subdivisions)
        yield name, Mesh(ball.vertices * DIAMETER / 2, ball.faces)
    for name, mesh in meshes(archive):
        yield name, Mesh(mesh.vertices * DIAMETER, mesh.faces)


def meshes(archive):
    """(name, Mesh): the least, middle and most faces of the household objects and of psb."""
    groups = [{path.stem: read_mesh(path) for path in sorted(MESHES.glob("*.npz"))}]
    if Path(archive).exists():
        files = collection_files(archive, *PRINCETON)
        first = {path.split("/")[1]: path for path in reversed(sorted(files)) if path.endswith(".off")}
        groups.append({name: normalise(parse(files[path](), ".off")) for name, path in sorted(first.items())})
    for named in groups:
        by_size = sorted(named, key=lambda name: len(named[name].faces))
        for place in dict.fromkeys((0, len(by_size) // 2, len(by_size) - 1)) if by_size else ():
            yield by_size[place], named[by_size[place]]


def timed(work):
    """The processor seconds of the work."""
    start = time.process_time()
    work()
    return time.process_time() - start


def object_rows(name, mesh):
    """Rows `build` and `rate` of one object."""
    vertices = rng(0, name).permutation(np.flatnonzero(touchable(mesh, np.arange(len(mesh.vertices)))))[:TOUCHES]
    axes, cells = sensor_axes(sensor_normals(mesh, vertices)), (SIDE, SIDE)
    built, peer, note = {"ours": timed(lambda: Surface(mesh))}, None, ""
    surface, centres = Surface(mesh), mesh.vertices[vertices]
    gaps = gaps_at(surface, centres, axes, DEPTH, cells, PITCH)
    centres = centres - (gaps.min(axis=(1, 2)) + DEPTH)[:, None] * axes[:, 2]
    loads = press_forces(surface, centres, axes, LAYER, cells, PITCH, depth=DEPTH).sum(axis=(1, 2))
    try:
        kept = []
        built["mujoco"] = timed(lambda: kept.append(Peer(mesh)))
        peer = kept[0]
    except (ImportError, ValueError) as error:
        note = f"not run: {error}"

    def one_by_one():
        for k in range(len(centres)):
            press_forces(surface, centres[k : k + 1], axes[k : k + 1], LAYER, cells, PITCH, depth=DEPTH)

    works = {
        "ours": lambda: press_forces(surface, centres, axes, LAYER, cells, PITCH, depth=DEPTH),
        "ours_load": lambda: press_forces(surface, centres, axes, LAYER, cells, PITCH, load=loads),
        "ours_single": one_by_one,
    }
    if peer:
        works["mujoco"] = lambda: peer.touch(centres, axes)
    taken = {method: [] for method in works}
    for turn in range(ROUNDS + 1):
        for method, work in works.items():
            seconds = timed(work) / len(centres)
            taken[method] += [seconds] if turn else []  # the first round warms up
    common = {"object": name, "faces": len(mesh.faces), "taxels": SIDE * SIDE, "touches": len(centres)}
    rows = [common | {"what": "build", "method": method, "seconds": seconds} for method, seconds in built.items()]
    reference = statistics.median(taken["mujoco"]) if peer else None
    for method in [*works, *([] if peer else ["mujoco"])]:
        row = common | {"what": "rate", "method": method, "note": "" if method in works else note}
        if method in works:
            seconds = statistics.median(taken[method])
            row |= {"value": 1 / seconds, "seconds": seconds, "ratio": reference / seconds if reference else None}
        rows.append(row)
    return rows


def error_rows(name, mesh):
    """Rows `error` on a sphere, the array level above its middle."""
    radius, centre, axes = DIAMETER / 2, np.array([[0.0, 0, DIAMETER / 2 - DEPTH]]), np.eye(3)[None]
    felt = press_forces(mesh, centre, axes, LAYER, (SIDE, SIDE), PITCH, depth=DEPTH)[0]
    line = (np.arange(SIDE) - (SIDE - 1) / 2) * PITCH
    x, y = (part.ravel() for part in np.meshgrid(line, -line))
    known = np.maximum(np.sqrt(radius**2 - x**2 - y**2) - centre[0, 2], 0)
    errors = {"ours": np.abs(felt.ravel() / (LAYER.stiffness * PITCH**2) - known).max()}
    try:
        peer = Peer(mesh)
        away = radius - np.linalg.norm(peer.taxels(centre, axes), axis=1)
        errors["mujoco"] = np.abs(peer.touch(centre, axes)[0] - np.maximum(away, 0)).max()
    except ImportError:
        pass
    common = {"what": "error", "object": name, "faces": len(mesh.faces), "taxels": SIDE * SIDE, "touches": 1}
    return [common | {"method": method, "value": value} for method, value in errors.items()]


def main():
    """Measures and writes the table."""
    chosen = arguments(__doc__, archive=PSB)
    os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})
    warm_up()
    rows = []
    for name, mesh in objects(chosen.archive):
        rows += object_rows(name, mesh)
        rows += error_rows(name, mesh) if name in SPHERES else []
    columns = ["what", "object", "faces", "taxels", "method", "touches", "value", "seconds", "ratio", "note"]
    frame = pd.DataFrame(rows, columns=columns).sort_values("what", kind="stable")
    write_table(OUT, frame)
    rate = frame[frame["what"] == "rate"]
    print(rate.pivot_table("value", ["faces", "object"], "method").round().to_string())
    print(frame[frame["what"] == "error"].to_string())


if __name__ == "__main__":
    main()
