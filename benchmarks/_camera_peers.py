"""Touches by camera, for benchmarks.imprints: TACTO's renderer, or a depth picture a touch, in their own interpreter.

Run by path, never imported: it needs tacto, pyrender and trimesh, and nothing of this project. Reads the path of a job
(.npz) a line from its standard input, answers each with a line of JSON. A renderer a process: EGL on Mesa takes no
second one.
"""

import json
import os
import sys
import time

os.environ.setdefault("PYOPENGL_PLATFORM", "egl")

import numpy as np
import trimesh
from scipy.spatial.transform import Rotation

GEL = np.array([0.022, 0.0, 0.015])  # m, the middle of the gel in TACTO's config_digit.yml
GEL_HEIGHT = 0.03  # m, along which the longer side of the array is laid
PRESSED = 0.004  # m that a place stands in the gel
CHANGED = 1e-6  # m: least change of depth by which the object, and not the gel, is seen


class Tacto:
    """TACTO's own renderer of a DIGIT, without pybullet's steps, noise and background: one `render` a touch."""

    def __init__(self, rows, columns):
        import tacto

        self.renderer = tacto.Renderer(columns, rows, None, tacto.get_digit_config_path())
        self.version = tacto.__version__

    def touch(self, job):
        """(seconds of the process, points (n, 3) that were seen, in units of the mesh)."""
        scale = GEL_HEIGHT / (max(job["cells"]) * job["pitch"])  # m a unit
        name, renderer = "object", self.renderer
        solid = trimesh.Trimesh(scale * job["vertices"], job["faces"], process=False)
        if name in renderer.object_nodes:
            renderer.scene.remove_node(renderer.object_nodes[name])
        renderer.add_object(solid, name)
        right, up, normal = job["axes"].transpose(1, 0, 2)
        turns = np.stack([-normal, -right, up], axis=2)  # the sensor looks along its +x, its +z is up
        places = scale * job["positions"] - turns @ (GEL - [PRESSED, 0, 0])
        angles = Rotation.from_matrix(turns).as_euler("xyz")
        pictures = []
        renderer.update_camera_pose(places[0], angles[0])
        renderer.render(noise=False, calibration=False)  # hands the mesh to GL
        start = time.process_time()
        for place, angle in zip(places, angles, strict=True):
            renderer.update_camera_pose(place, angle)
            _, depths = renderer.render(noise=False, calibration=False)
            pictures.append(depths[0])
        seconds = time.process_time() - start
        return seconds, self._points(pictures[-1]) / scale

    def _points(self, depth):
        """(n, 3) m: where the pixels of the last picture met the object."""
        rows, columns = np.nonzero(self.renderer.depth0[0] - depth > CHANGED)
        node = self.renderer.camera_nodes[0]
        height, width = depth.shape
        slope = np.tan(node.camera.yfov / 2)
        z = depth[rows, columns].astype(np.float64)
        x = ((columns + 0.5) / width * 2 - 1) * slope * width / height * z
        y = (1 - (rows + 0.5) / height * 2) * slope * z
        return np.stack([x, y, -z, np.ones_like(z)], axis=1) @ node.matrix[:3].T


class DepthPicture:
    """One orthographic depth picture a touch by pyrender, a pixel a cell: the least a camera-based simulator does."""

    def __init__(self, rows, columns):
        import pyrender

        self.gl, self.size = pyrender, (rows, columns)
        self.renderer = pyrender.OffscreenRenderer(columns, rows)
        self.version = pyrender.__version__

    def touch(self, job):
        """(seconds of the process, points (n, 3) that were seen, in units of the mesh)."""
        rows, columns = self.size
        reach = max(self.size) * job["pitch"]
        near, far = 0.01 * reach, 2 * reach
        half = rows * job["pitch"] / 2
        camera = self.gl.OrthographicCamera(half * columns / rows, half, near, far)
        scene = self.gl.Scene()
        scene.add(self.gl.Mesh.from_trimesh(trimesh.Trimesh(job["vertices"], job["faces"], process=False)))
        node = scene.add(camera)
        poses = np.tile(np.eye(4), (len(job["axes"]), 1, 1))
        poses[:, :3, :3] = job["axes"].transpose(0, 2, 1)
        poses[:, :3, 3] = job["positions"] + reach * job["axes"][:, 2]
        flags = self.gl.RenderFlags.DEPTH_ONLY
        scene.set_pose(node, poses[0])
        self.renderer.render(scene, flags)
        start = time.process_time()
        for pose in poses:
            scene.set_pose(node, pose)
            depth = self.renderer.render(scene, flags)
        seconds = time.process_time() - start
        down, across = np.nonzero(depth > 0)
        x = (across - (columns - 1) / 2) * job["pitch"]
        y = ((rows - 1) / 2 - down) * job["pitch"]
        # pyrender turns the buffer into depths by the formula of a perspective camera: undone here.
        z = near + far - near * far / depth[down, across].astype(np.float64)
        local = np.stack([x, y, -z, np.ones(len(x))], axis=1)
        return seconds, local @ poses[-1][:3].T


def main():
    """Answers jobs until its input ends."""
    answers, sys.stdout = sys.stdout, sys.stderr  # pybullet greets on standard output
    kind, rows, columns = sys.argv[1], int(sys.argv[2]), int(sys.argv[3])
    peer = {"tacto": Tacto, "depth": DepthPicture}[kind](rows, columns)
    from OpenGL import GL

    for line in sys.stdin:
        with np.load(line.strip()) as stored:
            job = {name: stored[name] for name in stored.files}
        seconds, points = peer.touch(job)
        name = GL.glGetString(GL.GL_RENDERER).decode()
        print(json.dumps({"seconds": seconds, "points": points.tolist(), "gl": name, "version": peer.version}),
              file=answers, flush=True)  # fmt: skip


if __name__ == "__main__":
    main()
