"""Milliseconds a frame of OpenGL beside the faces, for plans of random scenes: `python -m benchmarks.frame_times`

Reads data/household_scenes of a finished `experiment=scenes`. pyrender draws the frames of each scene through
EGL, by whatever OpenGL there is: without a graphics card that is Mesa's software rasteriser, kept to one thread. Full
meshes, uniform levels of our mean displacement, our levels, those of the online planner and those by errors rendered
beforehand take turns in each frame, after one drawing that uploads them. Writes reports/bench/frame_times.csv: a row a
scene and plan, with the mean over its frames of faces and of processor milliseconds (`ms`), and these over those of the
full meshes (`ratio`).
"""

import os

os.environ.setdefault("PYOPENGL_PLATFORM", "egl")
os.environ.setdefault("LP_NUM_THREADS", "0")  # llvmpipe: all in the calling thread

import time
from pathlib import Path

import numpy as np
import pandas as pd

from benchmarks import arguments
from haptic_glance.base.files import read_arrays, read_mesh, write_table
from haptic_glance.lod.scene.camera import world_mesh
from haptic_glance.lod.scene.chain import finest
from stages.engine.parallel import progress
from stages.engine.run import object_names
from stages.engine.settings import Workspace, load_params
from stages.scene import Params
from stages.scene.compare import OURS, read_chain
from stages.scene.measure import PLAN_FILE, Case, scene_of, scenes_of

OUT, SET = Path("reports/bench/frame_times.csv"), "household_scenes"
PLANS = {
    "full": "full", "uniform": "uniform.displacement", "ours": OURS, "online": "online",
    "beforehand": "beforehand.displacement",
}  # fmt: skip
EVERY = 5  # frames: one in so many is drawn
REPEATS = 2  # drawings of a frame beside the one that uploads, of which the faster counts


class Renderer:
    """pyrender on the screen of a scene."""

    def __init__(self, camera):
        import pyrender

        self.pyrender, (h, w) = pyrender, camera.size
        self.offscreen = pyrender.OffscreenRenderer(w, h)

    @property
    def device(self):
        """The name of what draws."""
        from OpenGL import GL

        self.offscreen._platform.make_current()
        return GL.glGetString(GL.GL_RENDERER).decode()

    def scene(self, camera, meshes):
        """The meshes, in world coordinates, before a camera with a light at it."""
        scene, pose = self.pyrender.Scene(), np.eye(4)
        right, up, forward = camera.axes
        pose[:3] = np.stack([right, up, -forward, camera.eye], axis=1)
        for mesh in meshes:
            positions, normals = mesh.vertices.astype(np.float32), vertex_normals(mesh).astype(np.float32)
            primitive = self.pyrender.Primitive(positions, normals, indices=mesh.faces.astype(np.uint32))
            scene.add(self.pyrender.Mesh([primitive]))
        scene.add(self.pyrender.PerspectiveCamera(np.radians(camera.angle), znear=0.05), pose=pose)
        scene.add(self.pyrender.DirectionalLight(intensity=3.0), pose=pose)
        return scene

    def seconds(self, scene):
        """Processor seconds of one drawing."""
        start = time.process_time()
        self.offscreen.render(scene)
        return time.process_time() - start


def vertex_normals(mesh):
    """(n, 3) the mean of the normals of the faces at each vertex, by their areas."""
    a, b, c = mesh.vertices[mesh.faces].transpose(1, 0, 2)
    normals, across = np.zeros_like(mesh.vertices), np.cross(b - a, c - a)
    for corner in mesh.faces.T:
        np.add.at(normals, corner, across)
    return normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)


def measured(settings, names, data, renderer):
    """Rows of one scene: the mean over its frames of each plan."""
    scene, _ = scene_of(settings, names)
    meshes = {placed.name: read_mesh(data / f"meshes/{placed.name}.npz") for placed in scene.objects}
    chains = [read_chain(data / "scene/levels" / placed.name, OURS, finest(meshes[placed.name]))
              for placed in scene.objects]  # fmt: skip
    poses, plans = scene.poses(meshes), read_arrays(data / "scene" / PLAN_FILE.format(Case(settings).name))
    taken, faces = {plan: [] for plan in PLANS}, {plan: [] for plan in PLANS}
    for frame in range(0, len(scene.cameras), EVERY):
        drawn = {}
        for plan, key in PLANS.items():
            levels = [chain[k] for chain, k in zip(chains, plans[key][frame], strict=True)]
            placed = [world_mesh(level.mesh, pose) for level, pose in zip(levels, poses, strict=True)]
            drawn[plan] = renderer.scene(scene.cameras[frame], placed)
            renderer.seconds(drawn[plan])  # uploads
            faces[plan].append(sum(level.faces for level in levels))
        times = [{plan: renderer.seconds(drawing) for plan, drawing in drawn.items()} for _ in range(REPEATS)]
        for plan in PLANS:
            taken[plan].append(min(seconds[plan] for seconds in times))
    mean = {plan: 1000 * float(np.mean(values)) for plan, values in taken.items()}
    return [{"scene": settings.name, "method": plan, "rows": scene.cameras[0].size[0], "faces": np.mean(faces[plan]),
             "ms": value, "ratio": value / mean["full"]} for plan, value in mean.items()]  # fmt: skip


def main():
    """Measures every scene and writes the table, anew after each."""
    arguments(__doc__)
    workspace, rows = Workspace(Path(), SET), []
    settings, names = workspace.settings(Params), object_names(workspace)
    scenes = scenes_of(settings, names, workspace.data, load_params()["seed"])
    camera = scene_of(scenes[0], names)[0].cameras[0]
    renderer = Renderer(camera)
    device = renderer.device
    for scene in progress(scenes, "frame_times"):
        rows += [row | {"device": device} for row in measured(scene, names, workspace.data, renderer)]
        write_table(OUT, pd.DataFrame(rows))


if __name__ == "__main__":
    main()
