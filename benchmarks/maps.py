"""Looking, on one core: nine maps of a view, and saliency of a mesh of 40,000 faces: `benchmarks.maps`.

The maps stand beside scikit-image's entropy of the same view.
Prints JSON rows; `benchmarks.pipeline` takes them into its table. The peer is the slowest of the nine in a common
library: what a plain assembly of library calls pays for entropy alone (9 x 9, 256 levels).
"""

import json
import os
import statistics
import subprocess
import sys

from benchmarks import arguments

RUNS = 5


def nine_maps_rows():
    """Rows (what, metric, value, unit, limit) measured in a process of its own that is held to one core."""
    process = subprocess.run([sys.executable, "-m", "benchmarks.maps"], capture_output=True, text=True, check=True)
    return json.loads(process.stdout.splitlines()[-1])


def measure():
    """Times maps and peer in turn, several times, and takes medians."""
    import numpy as np
    from skimage.filters.rank import entropy
    from trimesh.creation import icosphere

    from haptic_glance.base.timing import WallClock
    from haptic_glance.look.camera import Viewpoint
    from haptic_glance.look.channels import conspicuity
    from haptic_glance.look.views import render

    ball = icosphere(5, radius=0.5)  # 20,480 faces
    ours, peer = [], []
    for run in range(RUNS):
        mesh = wavy(ball)
        conspicuity(mesh, render(mesh, Viewpoint(0, 0)))  # what the twelve views of a mesh share is done once
        view = render(mesh, Viewpoint(30 * run, 20))
        with WallClock() as watch:
            conspicuity(mesh, view)
        ours.append(watch.seconds)
        with WallClock() as watch:
            entropy(view.rgb[..., 0], np.ones((9, 9), dtype=np.uint8))
        peer.append(watch.seconds)
    seconds, other = (statistics.median(times) for times in (ours, peer))
    label = "nine maps, 1200 x 900, one core"
    return [
        {"what": label, "metric": "wall time", "value": seconds, "unit": "s", "limit": 0.35},
        {"what": label, "metric": "ratio to scikit-image's rank entropy alone", "value": seconds / other, "unit": ""},
        *saliency_rows(),
    ]


def saliency_rows():
    """Rows of the time from a mesh of 39,600 faces to its saliency, by our model and by mesh saliency (Lee 2005)."""
    from trimesh.creation import uv_sphere

    from haptic_glance.base.timing import WallClock
    from haptic_glance.look.points import saliency

    ball = uv_sphere(radius=0.5, count=[100, 100])
    times = {"glance": [], "mesh_saliency": []}
    for _ in range(RUNS):
        for method, seconds in times.items():
            mesh = wavy(ball)  # anew: nothing that an earlier call worked out is there
            with WallClock() as watch:
                saliency(mesh, method)
            seconds.append(watch.seconds)
    ours, lee = (statistics.median(seconds) for seconds in times.values())
    label = f"saliency(mesh), {len(ball.faces):,} faces, one core"
    return [
        {"what": label, "metric": "wall time", "value": ours, "unit": "s", "limit": 1.0},
        {"what": label, "metric": "ratio to mesh saliency (Lee 2005)", "value": ours / lee, "unit": ""},
    ]


def wavy(ball):
    """A trimesh ball of radius 0.5 as a new Mesh with bumps, which lie inside of the ball: in the camera's frame."""
    import numpy as np

    from haptic_glance.mesh.mesh import Mesh

    return Mesh(ball.vertices * (0.9 + 0.1 * np.sin(20 * ball.vertices).prod(axis=1, keepdims=True)), ball.faces)


if __name__ == "__main__":
    arguments(__doc__)
    os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})
    for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
        os.environ[name] = "1"
    print(json.dumps(measure()))
