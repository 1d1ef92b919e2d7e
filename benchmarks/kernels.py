"""Is a kernel slower than it was? `python -m benchmarks.kernels [--check]`, on one core, about a minute and a half.

Times each kernel and a named peer in turns, in one process: the ratio of both is nearly the same on a busy machine.
Appends to reports/bench/history.csv a row a kernel: commit (HEAD, or HEAD+DIGEST of changed code), its date, what,
peer, ratio (ours over the peer's processor time, the median of the pairs), low and high (their quartiles), limit (what
the ratio may be from here on), seconds (of ours) and machine. Rows of the same commit and machine are replaced. The row
`reference loop` has processor seconds alone, of a fixed loop: seconds over these can be compared between machines.

--check writes nothing: it compares with the last committed rows of this model of machine, or, with a wider band, of
others, measures again what looks slow, and exits 1 with the names of the kernels that became slower.
"""

import io
import os
import sys
import time
import warnings
from collections.abc import Callable

import cv2
import numpy as np
import trimesh
from threadpoolctl import threadpool_limits

from benchmarks import arguments, reference_seconds
from haptic_glance.base.files import write_table
from haptic_glance.look.camera import Viewpoint
from haptic_glance.mesh.mesh import Mesh

from ._history import HISTORY, TOLERANCE, committed, machine, slower, updated, version
from ._simplify_peers import fresh

SECONDS = 1.0  # of the processor for the pairs of a kernel
PAIRS = (7, 25)  # but at least and at most so many

# A function makes a case: it prepares the data of both sides and returns two calls without arguments, ours and the
# peer's. Each call of ours gets a new copy of a mesh whose results the library would cache.
Call = Callable[[], object]


def nine_maps() -> tuple[Call, Call]:
    """All channels of one view; the peer is the slowest of the nine in a common library, 9 x 9 and 256 levels."""
    from skimage.filters.rank import entropy

    from haptic_glance.look.channels import conspicuity
    from haptic_glance.look.views import render

    mesh = ball(5)
    view = render(mesh, Viewpoint(30, 20))
    return lambda: conspicuity(mesh, view), lambda: entropy(view.rgb[..., 0], np.ones((9, 9), dtype=np.uint8))


def saliency_of_a_mesh() -> tuple[Call, Call]:
    """From the mesh to a value a vertex, by our gaze model and by curvature at five scales."""
    from haptic_glance.look.points import saliency

    mesh = ball(3)
    return lambda: saliency(fresh(mesh)), lambda: saliency(fresh(mesh), "mesh_saliency")


def simplification() -> tuple[Call, Call]:
    """A tenth of the faces, nothing kept; both by quadric edge collapse."""
    import fast_simplification

    from haptic_glance.lod import simplify

    mesh = ball(5)
    target, faces = len(mesh.faces) // 10, mesh.faces.astype(np.int32)
    peer = fast_simplification.simplify
    return lambda: simplify(fresh(mesh), target), lambda: peer(mesh.vertices, faces, target_count=target)


def hausdorff(reference, mesh, samples, vertices):
    """A function that asks pymeshlab for the mean error, over the diagonal; the meshes are in its memory already."""
    import pymeshlab

    work = pymeshlab.MeshSet(verbose=False)
    for side in (reference, mesh):
        work.add_mesh(pymeshlab.Mesh(side.vertices, side.faces))

    def ask():
        sides = [
            work.apply_filter(
                "get_hausdorff_distance", sampledmesh=k, targetmesh=1 - k, savesample=False, samplevert=vertices,
                sampleedge=False, samplefauxedge=False, sampleface=True, samplenum=samples,
                maxdist=pymeshlab.PercentageValue(50),
            )
            for k in (0, 1)
        ]  # fmt: skip
        return max(side["mean"] for side in sides) / reference.diagonal

    return ask


def surface_error() -> tuple[Call, Call]:
    """10,000 samples and the vertices against the other surface, both ways; the reference is known."""
    from haptic_glance.lod import metro, simplify

    mesh = ball(5)
    small = simplify(mesh, len(mesh.faces) // 10)
    return lambda: metro(mesh, fresh(small)), hausdorff(mesh, small, 10_000, True)


def picture_error() -> tuple[Call, Call]:
    """Two meshes in four views of 225 x 300, rendered and compared; the peer casts the same rays and no more."""
    from haptic_glance.lod import perceptual, simplify
    from haptic_glance.look.camera import pixel_rays
    from haptic_glance.look.views import VIEWPOINTS

    mesh = ball(4)
    small = simplify(mesh, len(mesh.faces) // 4)
    down, across = np.mgrid[:225, :300].reshape(2, -1)
    casters = [trimesh.Trimesh(surface.vertices, surface.faces, process=False).ray for surface in (mesh, small)]
    views = VIEWPOINTS["four"]
    rays = [pixel_rays(down, across, viewpoint, (225, 300)) for viewpoint in views]
    return (
        lambda: perceptual(fresh(mesh), fresh(small), views),
        lambda: [caster.intersects_first(*ray) for caster in casters for ray in rays],
    )


def by_trimesh(rays, positions, axes, cells, pitch):
    """(k, rows, cols) distances by trimesh: rays from the reach above, one call for all."""
    rows, columns = cells
    right, up, normal = axes.transpose(1, 0, 2)[:, :, None, None]
    down = (((rows - 1) / 2 - np.arange(rows)) * pitch)[:, None, None]
    along = ((np.arange(columns) - (columns - 1) / 2) * pitch)[None, :, None]
    reach = max(cells) * pitch
    starts = (positions[:, None, None] + down * up + along * right + reach * normal).reshape(-1, 3)
    ways = np.broadcast_to(-normal, (len(axes), rows, columns, 3)).reshape(-1, 3)
    places, ray, _ = rays.intersects_location(starts, ways, multiple_hits=False)
    distances = np.full(len(starts), reach)
    distances[ray] = np.einsum("ij,ij->i", places - starts[ray], ways[ray]) - reach
    return np.clip(distances, -reach, reach).reshape(len(axes), rows, columns)


def imprints() -> tuple[Call, Call]:
    """100 imprints of 32 x 32 cells on a mesh that is ready to be touched."""
    from haptic_glance.touch import Surface, press_many, sensor_axes, sensor_normals

    mesh = ball(5)
    vertices = np.arange(100) * (len(mesh.vertices) // 100)
    axes = sensor_axes(sensor_normals(mesh, vertices))
    rays, surface = trimesh.Trimesh(mesh.vertices, mesh.faces, process=False).ray, Surface(mesh)
    return (
        lambda: press_many(surface, vertices, (32, 32), 0.01),
        lambda: by_trimesh(rays, mesh.vertices[vertices], axes, (32, 32), 0.01),
    )


def touch_map() -> tuple[Call, Call]:
    """The map on which several touches become one sample; the peer is given as many centres and passes."""
    from sklearn.cluster import KMeans

    from haptic_glance.know.self_organising_map import PASSES, SelfOrganisingMap

    samples = np.random.default_rng(0).normal(size=(3000, 41))
    peer = KMeans(100, init="random", n_init=1, max_iter=PASSES, tol=0, random_state=0)
    return lambda: SelfOrganisingMap(2, 100).fit(samples), lambda: peer.fit(samples)


def training() -> tuple[Call, Call]:
    """Two hidden layers of 50 units, one epoch, a step a sample."""
    from sklearn.neural_network import MLPClassifier

    from haptic_glance.know.network import FeedForward

    samples = np.random.default_rng(0).normal(size=(500, 12))
    labels = np.arange(500) % 6
    peer = MLPClassifier((50, 50), batch_size=1, max_iter=1, random_state=0)
    return lambda: FeedForward(epochs=1).fit(samples, labels), lambda: _quiet(peer.fit, samples, labels)


def network() -> tuple[Call, Call]:
    """MobileNetV2, eight images of 96 x 96; the peer runs the same network exported to ONNX."""
    import onnxruntime
    import torch

    from haptic_glance.deep.network import build

    ours, images, written = build("mobilenet_v2", 10, "random", 0), torch.rand(8, 3, 96, 96), io.BytesIO()
    _quiet(torch.onnx.export, ours, (images,), written, input_names=["images"], dynamo=False)
    options = onnxruntime.SessionOptions()
    options.intra_op_num_threads = 1
    peer = onnxruntime.InferenceSession(written.getvalue(), options, providers=["CPUExecutionProvider"])
    batch = images.contiguous(memory_format=torch.channels_last)
    return torch.no_grad()(lambda: ours(batch)), lambda: peer.run(None, {"images": images.numpy()})


CASES: dict[str, tuple[str, Callable[[], tuple[Call, Call]]]] = {  # what -> (peer, case)
    "nine maps": ("scikit-image's rank entropy", nine_maps),
    "saliency": ("mesh saliency (Lee 2005)", saliency_of_a_mesh),
    "simplify": ("fast-simplification", simplification),
    "metro": ("pymeshlab's Hausdorff distance", surface_error),
    "perceptual": ("trimesh's rays on embree", picture_error),
    "press_many": ("trimesh's rays on embree", imprints),
    "touch map": ("scikit-learn's k-means", touch_map),
    "feed-forward training": ("scikit-learn's MLP", training),
    "MobileNetV2": ("onnxruntime", network),
}


def ball(subdivisions: int) -> Mesh:
    """A ball of 20 * 4^subdivisions faces with bumps, which lie inside of radius 0.5: in the camera's frame."""
    smooth = trimesh.creation.icosphere(subdivisions, radius=0.5)
    bumps = np.sin(20 * smooth.vertices).prod(axis=1, keepdims=True)
    return Mesh(smooth.vertices * (0.9 + 0.1 * bumps), smooth.faces)


def _quiet(call, *arguments, **named):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return call(*arguments, **named)


def measured(kernel: str) -> dict:
    """The row of one kernel, without commit and machine."""
    peer, case = CASES[kernel]
    ours, theirs = case()
    with threadpool_limits(1):  # after the case has loaded its libraries
        seconds = in_pairs(ours, theirs)
    low, ratio, high = np.quantile(seconds[:, 0] / seconds[:, 1], [0.25, 0.5, 0.75])
    print(f"kernels: {kernel}: {ratio:.3g} [{low:.3g}, {high:.3g}] of the time of {peer}", flush=True)
    row = {"what": kernel, "peer": peer, "ratio": ratio, "low": low, "high": high, "limit": TOLERANCE * high}
    return row | {"seconds": np.median(seconds[:, 0])}


def in_pairs(*calls) -> np.ndarray:
    """(pairs, 2) processor seconds of two calls in turns, which goes first alternating; kernels are compiled before."""
    for call in 2 * calls:
        call()
    pairs = []
    while len(pairs) < PAIRS[0] or (np.sum(pairs) < SECONDS and len(pairs) < PAIRS[1]):
        pair = np.empty(2)
        for place in (0, 1) if len(pairs) % 2 else (1, 0):
            start = time.process_time()
            calls[place]()
            pair[place] = time.process_time() - start
        pairs.append(pair)
    return np.array(pairs)


def main() -> None:
    """Writes the rows, or checks against the committed ones."""
    check = arguments(__doc__, **{"--check": False}).check
    os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})
    cv2.setNumThreads(1)
    if check:
        lines = slower(committed(), machine(), CASES, measured)
        if lines:
            sys.exit("\n".join(f"kernels: {line}" for line in lines))
        print(f"kernels: none is slower than in {HISTORY}")
        return
    where = version() | {"machine": machine()}
    rows = [*map(measured, CASES), {"what": "reference loop", "seconds": reference_seconds()}]
    write_table(HISTORY, updated([where | row for row in rows]))


if __name__ == "__main__":
    main()
