"""The attention of the networks on one object, compared with human fixations, rivals and controls."""

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path

import numpy as np
import torch

from haptic_glance.base.files import read_arrays, read_mesh, write_arrays
from haptic_glance.base.rng import rng
from haptic_glance.base.timing import Stopwatch
from haptic_glance.deep.cam import grad_cam
from haptic_glance.deep.resize import resize_cams
from haptic_glance.look.camera import Viewpoint
from haptic_glance.look.channels import facing
from haptic_glance.mesh.mesh import Mesh
from stages.salient_points.measure import read_saliency

from . import Params
from .agreement import ALL_VIEWS, agreement_rows, centre_prior, task_correlations
from .backbone import TRAINED, Method, read_maps, read_pictures
from .finetune import read_cams, read_head
from .fusion import entropy, fuse, highest_level
from .places import ITSELF, mean_over_views, nearer, project_by_boxes, project_to_vertices
from .tasks import FUSED_TASKS, TASKS, evaluated_views, viewpoint_sphere

MODELS = {
    "ewigc": fuse,  # T eq. 3.24
    "ewigc_l4": lambda pictures: fuse(highest_level(pictures)),  # T eq. 3.25
    "average": lambda pictures: pictures.mean(axis=0),  # the baseline without weighting by entropy
}
RIVALS = ("mesh_saliency", "leifman", "song", "tasse", "glance", "thesis_ssim", "height")  # of stages.salient_points


def measure_attention(
    name: str,
    folder: Path,
    data: Path,
    made: Path,
    settings: Params,
    methods: Sequence[Method],
    tasks: Mapping[str, Mapping[str, str]],
    seed: int,
) -> list[dict]:
    """Writes the attention of all methods on one object to NAME.npz, and returns its rows.

    made: the folder of the pictures, maps and heads. Rows of the rivals (from stages.salient_points), of the centre
    prior and of random saliency are included.
    """
    mesh = read_mesh(data / "meshes" / f"{name}.npz")
    viewpoints = viewpoint_sphere(settings.parallels, settings.azimuths)
    visible, evaluated = facing(mesh, viewpoints) > 0, evaluated_views(settings.parallels, settings.azimuths)
    ground_truth = GroundTruth(data, name, mesh, visible, evaluated)
    arrays, rows = {"seen": visible.any(axis=0), "visible": visible[evaluated]}, []
    pictures, rendering_seconds = read_pictures(made, name)
    renders = pictures if settings.projection == "boxes" else None
    place = partial(to_surface, mesh=mesh, viewpoints=viewpoints, seen=visible, renders=renders)
    for method in methods:
        with Stopwatch() as watch:
            cams, network_seconds = object_cams(made, method, name, list(tasks))
            values, bits = project_maps(cams, place, settings.size, method.network)
            whole = mean_over_views(values, visible)
        names = [*cams, *(MODELS if set(FUSED_TASKS) & set(cams) else ())]
        seconds = rendering_seconds + network_seconds + watch.seconds
        for k, task in enumerate(names):
            arrays[f"{method.name}.{task}"] = whole[k].astype(np.float16)
            arrays[f"{method.name}.{task}.views"] = values[evaluated, k].astype(np.float16)
            rows += ground_truth.rows(method.name, task, values[evaluated, k], whole[k], seconds)
        arrays[f"{method.name}.maps"] = np.stack([cam[evaluated] for cam in cams.values()], axis=1).astype(np.float16)
        row = {"item": name, "method": method.name}
        if method.mode != "random" and ITSELF in cams:
            looks = values[evaluated, names.index(ITSELF)].astype(np.float16)
            by_metric = nearer(mesh, [viewpoints[view] for view in evaluated], visible[evaluated], looks)
            rows += [row | {"task": ITSELF, "metric": metric, "value": value} for metric, value in by_metric.items()]
        rows.append(row | {"metric": "views", "value": len(viewpoints), "seconds": network_seconds})
        rows += [row | cells for cells in task_correlations(values[:, : len(cams)], visible, list(cams))]
        row["view"] = ALL_VIEWS
        rows += [row | {"task": task, "metric": "entropy", "value": bit} for task, bit in bits.items()]
    write_arrays(folder / f"{name}.npz", **arrays)
    return rows + baseline_rows(ground_truth, data, place, settings.size, seed)


def object_cams(folder: Path, method: Method, name: str, tasks: Sequence[str]) -> tuple[dict[str, np.ndarray], float]:
    """(dict task -> (v, i, j) f4 Grad-CAM map of the predicted class, seconds of the network)."""
    if method.mode in TRAINED:
        return read_cams(folder, method.name, name, tasks)
    maps, seconds = read_maps(folder, method.name, name)
    heads = {task: [torch.from_numpy(part) for part in read_head(folder, method.name, task)[:2]] for task in tasks}
    return {
        task: grad_cam(maps, partial(linear_scores, weights=w, bias=b))[0] for task, (w, b) in heads.items()
    }, seconds


def linear_scores(maps: torch.Tensor, weights: torch.Tensor, bias: torch.Tensor) -> torch.Tensor:
    """(b, k): the scores of a head with weights (k, C) on the mean of each map (b, C, i, j)."""
    return maps.mean(dim=(2, 3)) @ weights.T + bias


def project_maps(
    cams: Mapping[str, np.ndarray], place: Callable[[int, np.ndarray], np.ndarray], size: int, network: str
) -> tuple[np.ndarray, dict[str, float]]:
    """((v, tasks and models, n) f4 at the vertices in each view, dict task -> mean entropy of its maps in bits).

    place: to_surface of the number of a view and its pictures.
    """
    fused = [k for k, task in enumerate(cams) if task in FUSED_TASKS]
    values, bits = [], []
    for view in range(len(next(iter(cams.values())))):
        pictures = resize_cams(np.stack([cam[view] for cam in cams.values()]), size, network)
        models = [model(pictures[fused]) for model in MODELS.values()] if fused else []
        values.append(place(view, np.stack([*pictures, *models])).astype(np.float32))
        bits.append([entropy(picture) for picture in pictures])
    return np.stack(values), dict(zip(cams, np.mean(bits, axis=0).tolist(), strict=True))


def to_surface(
    view: int, pictures: np.ndarray, mesh: Mesh, viewpoints: Sequence[Viewpoint], seen: np.ndarray,
    renders: np.ndarray | None,
) -> np.ndarray:  # fmt: skip
    """(t, n): pictures (t, h, w) of a view at the vertices; by bounding boxes where there are renders (v, h, w)."""
    if renders is None:
        return project_to_vertices(pictures, mesh, viewpoints[view], seen[view])
    return project_by_boxes(pictures, mesh, viewpoints[view], seen[view], renders[view])


def baseline_rows(
    ground_truth: "GroundTruth", data: Path, place: Callable[[int, np.ndarray], np.ndarray], size: int, seed: int
) -> list[dict]:
    """Rows of the rivals and controls, compared with the ground truth in the same way; place: as in project_maps."""
    mesh = ground_truth.mesh
    prior = np.stack([place(view, centre_prior(size)[None]) for view in range(len(ground_truth.seen))])
    rows = ground_truth.rows(
        "control", "centre_prior", prior[ground_truth.evaluated, 0], mean_over_views(prior, ground_truth.seen)[0], None
    )
    maps = {"random": rng(seed, f"{ground_truth.name} noise").random(len(mesh.vertices))}
    saliency = read_saliency(data / "salient_points" / f"{ground_truth.name}.npz")
    maps |= {rival: saliency[rival].astype(np.float64) for rival in RIVALS if rival in saliency}
    for rival, values in maps.items():
        method = "control" if rival == "random" else "rival"
        rows += ground_truth.rows(method, rival, np.stack([values] * len(ground_truth.evaluated)), values, None)
    return rows


class GroundTruth:
    """The human fixations on one object, where there are any.

    seen (v, n) boolean: the vertices visible in each view; evaluated: the numbers of the views that are compared.
    """

    def __init__(self, data: Path, name: str, mesh: Mesh, seen: np.ndarray, evaluated: Sequence[int]) -> None:
        self.name, self.mesh, self.seen, self.evaluated = name, mesh, seen, evaluated
        path = data / "weights" / "ground_truth" / f"{name}.npz"
        self.fixations = read_arrays(path) if path.exists() else None

    def rows(self, method: str, task: str, by_view: np.ndarray, whole: np.ndarray, seconds: float | None) -> list[dict]:
        """Rows of a saliency, (3, n) in the evaluated views and (n,) in all; none where there are no fixations."""
        if self.fixations is None:
            return []
        row = {"item": self.name, "method": method, "task": task, "seconds": seconds}
        visible = self.seen[self.evaluated]
        entries = agreement_rows(self.mesh, self.fixations, visible, by_view, whole, distances=task not in TASKS)
        return [row | cells for cells in entries]
