"""One object: the maps of its tasks, fused, on its surface, beside people and rivals."""

import numpy as np

from stages.conspicuity import facing
from stages.kit import Stopwatch
from stages.kit.files import read_arrays, read_mesh, write_arrays
from stages.kit.rng import rng
from stages.kit.run import DATA
from stages.salient_points import read_saliency

from .backbone import read_maps
from .cam import grad_cam, to_size
from .controls import centre_prior, noise
from .fusion import entropy, fuse, narrowed
from .heads import read_head, scores
from .judge import WHOLE, between_tasks, judged
from .options import method_named
from .pictures import read_pictures
from .tasks import FUSED, TASKS
from .vertices import on_vertices, over_views
from .viewpoints import evaluated, sphere

MODELS = {
    "ewigc": fuse,  # T eq. 3.24
    "ewigc_l4": lambda pictures: fuse(narrowed(pictures)),  # T eq. 3.25
    "average": lambda pictures: pictures.mean(axis=0),  # what weighing by entropy must beat
}
RIVALS = ("mesh_saliency", "enhanced", "thesis_ssim", "height")  # of stages.salient_points


def attend(item, folder, settings, methods, tasks, seed):
    """Writes the attention on one object (`object@NAME`) by all methods to NAME.npz, and returns its rows.

    Judged beside them: the rivals of stages.salient_points, the centre prior and noise.
    """
    name = item.partition("@")[2]
    mesh = read_mesh(DATA / "meshes" / f"{name}.npz")
    viewpoints = sphere(settings.parallels, settings.azimuths)
    seen, three = facing(mesh, viewpoints) > 0, evaluated(settings.parallels, settings.azimuths)
    judge = Judge(name, mesh, seen, three)
    stored, rows = {"seen": seen.any(axis=0), "visible": seen[three]}, []
    drawn = read_pictures(folder, name)[1]
    for method in methods:
        with Stopwatch() as watch:
            cams, spent = cams_of(folder, method, name, tasks)
            network = method_named(method).network
            values, bits = projected(cams, mesh, viewpoints, seen, settings.size, network)
            whole = over_views(values, seen)
        names = [*cams, *(MODELS if set(FUSED) & set(cams) else ())]
        seconds = drawn + spent + watch.seconds
        for k, task in enumerate(names):
            stored[f"{method}.{task}"] = whole[k].astype(np.float16)
            stored[f"{method}.{task}.views"] = values[three, k].astype(np.float16)
            rows += judge(method, task, values[three, k], whole[k], seconds)
        stored[f"{method}.maps"] = np.stack([cam[three] for cam in cams.values()], axis=1).astype(np.float16)
        row = {"object": name, "method": method}
        rows += [row | one for one in between_tasks(values[:, : len(cams)], seen, list(cams))]
        rows += [row | {"task": task, "view": WHOLE, "metric": "entropy", "value": bit} for task, bit in bits.items()]
    write_arrays(folder / f"{name}.npz", **stored)
    return rows + others(judge, mesh, viewpoints, settings.size, seed)


def cams_of(folder, method, name, tasks):
    """(dict task -> (v, i, j) f4 Grad-CAM of the winning class, seconds that the network took)."""
    if method_named(method).mode == "finetuned":
        stored = read_arrays(folder / ".cams" / method / f"{name}.npz")
        return {task: stored[task] for task in tasks}, float(stored["seconds"])
    maps, seconds = read_maps(folder, method, name)
    maps = maps.astype(np.float32)
    pooled, found = maps.mean(axis=(2, 3)), {}
    for task in tasks:
        weights, bias, _ = read_head(folder, method, task)
        found[task] = grad_cam(maps, weights, scores(pooled, weights, bias).argmax(axis=1))
    return found, seconds


def projected(cams, mesh, viewpoints, seen, size, network):
    """((v, tasks and models, n) f4 on the vertices of each view, dict task -> mean entropy of its maps in bits)."""
    fused = [k for k, task in enumerate(cams) if task in FUSED]
    values, bits = [], []
    for view, viewpoint in enumerate(viewpoints):
        pictures = to_size(np.stack([cam[view] for cam in cams.values()]), size, network)
        models = [model(pictures[fused]) for model in MODELS.values()] if fused else []
        values.append(on_vertices(np.stack([*pictures, *models]), mesh, viewpoint, seen[view]).astype(np.float32))
        bits.append([entropy(picture) for picture in pictures])
    return np.stack(values), dict(zip(cams, np.mean(bits, axis=0).tolist(), strict=True))


def others(judge, mesh, viewpoints, size, seed):
    """Rows of the rivals and controls, judged the same way."""
    prior = [on_vertices(centre_prior(size)[None], mesh, viewpoint, seen)
             for viewpoint, seen in zip(viewpoints, judge.seen, strict=True)]  # fmt: skip
    prior = np.stack(prior)
    rows = judge("control", "centre_prior", prior[judge.three, 0], over_views(prior, judge.seen)[0], None)
    found = {"random": noise(len(mesh.vertices), rng(seed, f"{judge.name} noise"))}
    saliency = read_saliency(DATA / "salient_points" / f"{judge.name}.npz")
    found |= {rival: saliency[rival].astype(np.float64) for rival in RIVALS if rival in saliency}
    for rival, values in found.items():
        method = "control" if rival == "random" else "rival"
        rows += judge(method, rival, np.stack([values] * len(judge.three)), values, None)
    return rows


class Judge:
    """The people's attention on one object, where there is one: called with a saliency it gives the rows."""

    def __init__(self, name, mesh, seen, three):
        """seen (v, n) boolean; three: the numbers of the views that are judged."""
        self.name, self.mesh, self.seen, self.three = name, mesh, seen, three
        path = DATA / "weights" / "lessons" / f"{name}.npz"
        self.lesson = read_arrays(path) if path.exists() else None

    def __call__(self, method, task, by_view, whole, seconds):
        """Rows of one saliency, (3, n) in the three views and (n,) in all; none without people's attention."""
        if self.lesson is None:
            return []
        row = {"object": self.name, "method": method, "task": task, "seconds": seconds}
        found = judged(self.mesh, self.lesson, self.seen[self.three], by_view, whole, places=task not in TASKS)
        return [row | one for one in found]
