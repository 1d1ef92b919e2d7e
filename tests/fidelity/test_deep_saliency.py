"""T3.3: Grad-CAM, the shapes of objects, their classes, the fusion of maps, clusters of fixations."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import torch
import trimesh
from scipy import ndimage
from skimage.filters import threshold_multiotsu

from haptic_glance.deep.cam import grad_cam
from haptic_glance.look.weights.convexity import convexity, nearest_convexity
from haptic_glance.mesh.mesh import Mesh
from stages.fixation.fusion import fuse, highest_level, subtractive_clusters
from stages.fixation.places import FLAT, curvature_shares, eccentricity, gaussian_curvature
from stages.fixation.tasks import CLUSTERS, FUSED_TASKS, SHAPE_MEASURES, assign_classes

pytestmark = pytest.mark.slow

ROOT = Path(__file__).parents[2]


def test_grad_cam(agreement):
    """eq. 3.18 and 3.19, map by map and cell by cell: ReLU of the sum of alpha_k A^k, relative to its maximum."""
    torch.manual_seed(1)
    maps = torch.rand(2, 6, 4, 5, requires_grad=True)
    head = torch.nn.Sequential(torch.nn.Flatten(), torch.nn.Linear(120, 8), torch.nn.Tanh(), torch.nn.Linear(8, 4))
    scores = head(maps)
    literal = []
    for image in range(2):
        score = scores[image, int(scores[image].argmax())]
        gradient = torch.autograd.grad(score, maps, retain_graph=True)[0][image]
        total = torch.zeros(4, 5)
        for k in range(6):
            alpha = sum(float(gradient[k, i, j]) for i in range(4) for j in range(5)) / 20
            total = total + alpha * maps[image, k].detach()
        literal.append(torch.relu(total).numpy())
    heat, _ = grad_cam(maps.detach(), head)
    assert np.max(literal) > 0
    agreement("difference", float(np.abs(heat - literal).max() / np.max(literal)))


def test_convexity(agreement):
    """eq. 3.20: the volume of the object over that of its convex hull."""
    solids = [
        trimesh.creation.icosphere(subdivisions=2),
        trimesh.creation.torus(0.4, 0.1),
        trimesh.creation.annulus(0.1, 0.3, 0.5),
        trimesh.creation.box((0.2, 0.4, 0.6)),
    ]
    apart = [abs(convexity(Mesh(s.vertices, s.faces)) - s.volume / s.convex_hull.volume) for s in solids]
    agreement("difference", max(apart))


def test_nearest_convexity(agreement):
    """End of T3.2.9.2: a new object takes the SVM of the object with the closest convexity."""
    random = np.random.default_rng(0)
    cases = [(random.random(), dict(zip("abcdef", random.random(6), strict=True))) for _ in range(20)]
    literal = [min(others, key=lambda name: abs(others[name] - value)) for value, others in cases]
    held = [nearest_convexity(*case) == name for case, name in zip(cases, literal, strict=True)]
    agreement("settings", (sum(held), len(held)))


def test_tasks_of_shape(agreement):
    """T3.3.2.1: "three classification problems respectively based on each of these characteristics"."""
    random, names = np.random.default_rng(0), [f"o{k}" for k in range(12)]
    clumps = {task: random.permutation(np.arange(12) // 4) for task in ("convexity", "curvature", "eccentricity")}
    values = {task: 0.4 * clump + 0.01 * random.random(12) for task, clump in clumps.items()}
    shares = {"positive": values["curvature"], "negative": 1 - values["curvature"], "zero": np.zeros(12)}
    measures = {name: {key: column[k] for key, column in (values | shares).items()} for k, name in enumerate(names)}
    tasks, _ = assign_classes(measures, "none", 0, ROOT / "data/reference/semantics.csv")
    held = [[tasks[task][name] for name in names] == [*map(str, clump)] for task, clump in clumps.items()]
    agreement("settings", (sum(held), len(held)))


def torus(count=96, tube=48):
    """(Mesh, (n,) the determinant of its shape operator): cos v / (r (R + r cos v))."""
    big, small = 0.35, 0.12
    mesh = trimesh.creation.torus(big, small, major_sections=count, minor_sections=tube)
    out = np.hypot(*mesh.vertices[:, :2].T)
    return Mesh(mesh.vertices, mesh.faces), ((out - big) / small) / (small * out)


def test_gaussian_curvature(agreement):
    """eq. 3.21 and 3.22 on a torus, whose shape operator is known."""
    mesh, literal = torus()
    agreement("r", float(np.corrcoef(gaussian_curvature(mesh), literal)[0, 1]))


def test_curvature_shares(agreement):
    """T3.3.2.1: the shares of vertices with positive, negative and zero curvature, in percent apart at most."""
    mesh, curvature = torus()
    relative = curvature * mesh.diagonal**2
    literal = [(relative > FLAT).mean(), (relative < -FLAT).mean(), (np.abs(relative) <= FLAT).mean()]
    agreement("share", float(100 * np.abs(np.array(curvature_shares(mesh)) - literal).max()))


def test_eccentricity(dromedary, agreement):
    """eq. 3.23 with the means of the 10 % largest and smallest distances to the centre of gravity."""
    solid = trimesh.Trimesh(dromedary.vertices, dromedary.faces, process=False)
    vertices = dromedary.vertices[np.unique(dromedary.faces)]
    distances = np.sort(np.linalg.norm(vertices - solid.centroid, axis=1))
    tenth = round(0.1 * len(distances))
    literal = np.sqrt(1 - distances[:tenth].mean() ** 2 / distances[-tenth:].mean() ** 2)
    agreement("difference", abs(eccentricity(dromedary) - literal))


def test_classes(agreement):
    """Figure 3.28 and T3.3.2.2: three measures, 2 to 10 clusters; living or not, and the seven printed categories."""
    categories = {"mechanical parts", "creatures", "full human body", "sectional human body", "familiar objects",
                  "transportation means", "furniture and dishes"}  # fmt: skip
    table = pd.read_csv(ROOT / "data/reference/semantics.csv")
    objects = table[table["dataset"] == "gaze"]
    held = [
        set(SHAPE_MEASURES) == {"convexity", "curvature", "eccentricity"},
        list(CLUSTERS) == list(range(2, 11)),
        set(objects["living"]) == {"yes", "no"},
        set(objects["category"]) == categories,
        set(FUSED_TASKS) == {"curvature", "eccentricity", "level_1", "level_2"},
    ]
    agreement("settings", (sum(held), len(held)))


def bits(image):
    shares = np.bincount(np.rint(image * 255).astype(int).ravel(), minlength=256) / image.size
    return -sum(share * np.log2(share) for share in shares if share > 0)


def smooth_maps():
    maps = [ndimage.gaussian_filter(np.random.default_rng(k).random((56, 56)), 3 + k) for k in range(4)]
    return np.stack([(values - values.min()) / np.ptp(values) for values in maps])


def test_fusion(agreement):
    """eq. 3.24: the maps weighted by the entropy of each."""
    maps = smooth_maps()
    entropies = [bits(image) for image in maps]
    literal = sum(e * m for e, m in zip(entropies, maps, strict=True)) / sum(entropies)
    agreement("difference", np.abs(fuse(maps) - literal).max())


def test_fusion_of_the_highest_level(agreement):
    """eq. 3.25: the same of what lies above the highest of Otsu's thresholds of four levels."""
    maps = smooth_maps()
    kept = np.stack([np.where(image > threshold_multiotsu(image, 4)[-1], image, 0) for image in maps])
    entropies = [bits(image) for image in kept]
    literal = sum(e * m for e, m in zip(entropies, kept, strict=True)) / sum(entropies)
    agreement("r", float(np.corrcoef(fuse(highest_level(maps)).ravel(), literal.ravel())[0, 1]))


def test_subtractive_clustering(agreement):
    """T3.3.6, T [243]: potentials in the unit cube, and their reduction about each centre; how many centres agree."""
    generator = np.random.default_rng(2)
    points = np.concatenate([generator.normal(place, 0.04, (30, 3)) for place in np.eye(3)])
    unit = (points - points.min(axis=0)) / np.ptp(points, axis=0)
    potential = [sum(np.exp(-4 * ((p - q) ** 2).sum() / 0.5**2) for q in unit) for p in unit]
    first, literal = max(potential), []
    while max(potential) > 0.5 * first:
        best = int(np.argmax(potential))
        literal.append(best)
        height = potential[best]
        potential = [
            value - height * np.exp(-4 * ((p - unit[best]) ** 2).sum() / (1.25 * 0.5) ** 2)
            for value, p in zip(potential, unit, strict=True)
        ]
    centres = subtractive_clusters(points)[: len(literal)]
    assert len(literal) == 3
    agreement("settings", (int((centres == literal).sum()), 3))
