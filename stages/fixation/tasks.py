"""The six tasks of the networks with each object's class, the division of pictures and objects, and the viewpoints.

Tasks are in T3.3.2.1 and T3.3.2.2, the division and the viewpoints in T3.3.2.
"""

import sys
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
from sklearn.cluster import KMeans
from threadpoolctl import threadpool_limits

from haptic_glance.base.files import read_table
from haptic_glance.look.camera import Viewpoint

SHAPE_MEASURES = {  # task -> the measures by which its objects are clustered into classes
    "convexity": ["convexity"],
    "curvature": ["positive", "negative", "zero"],
    "eccentricity": ["eccentricity"],
}
LEVELS = ("level_1", "level_2", "level_3")  # living or not, category, the object itself
TASKS = (*SHAPE_MEASURES, *LEVELS)
FUSED_TASKS = ("curvature", "eccentricity", "level_1", "level_2")  # T eq. 3.24; the other two agree least with gaze
CLUSTERS = range(2, 11)  # numbers of clusters tried (T3.3.2.1)
SEMANTICS = Path("data/reference/semantics.csv")  # in the repository root


def cluster_objects(values: Sequence | np.ndarray, seed: int = 0) -> tuple[np.ndarray, dict[int, float]]:
    """(labels (k,), dict clusters -> SSD): k-means with the number of clusters at the elbow (T3.3.2.1).

    values (k, d). The thesis chooses the elbow by eye. Here it is the point farthest below the line from the first to
    the last point of the curve of the sums of squared distances over 2..10 clusters, both axes scaled to 0..1 (Satopaa,
    Albrecht, Irwin and Raghavan 2011, Finding a kneedle in a haystack). Fewer numbers are tried where there are fewer
    distinct values. Labels are ordered by the first value of the cluster centres; all 0, and no curve, where the values
    cannot be clustered.
    """
    values = np.asarray(values, dtype=np.float64)
    distinct = len(np.unique(values.round(9), axis=0))
    numbers = [k for k in CLUSTERS if k < distinct]
    if not numbers:
        return np.zeros(len(values), dtype=np.int64), {}
    with threadpool_limits(1):
        # scikit-learn's default of n_init is a string, from which its type is inferred
        fits = {k: KMeans(k, n_init=10, random_state=seed).fit(values) for k in numbers}  # pyright: ignore
    curve = {k: float(np.asarray(fit.inertia_)) for k, fit in fits.items()}
    clustering = fits[elbow(curve)]
    rank = np.argsort(np.lexsort(clustering.cluster_centers_.T[::-1]))
    return rank[clustering.labels_].astype(np.int64), curve


def elbow(curve: Mapping[int, float]) -> int:
    """The number of clusters at the elbow of dict clusters -> SSD; the first where the curve has no elbow."""
    k, ssd = np.array(list(curve), dtype=np.float64), np.array(list(curve.values()))
    if len(k) < 3 or ssd[0] <= ssd[-1]:
        return int(k[0])
    along, down = (k - k[0]) / (k[-1] - k[0]), (ssd[0] - ssd) / (ssd[0] - ssd[-1])
    return int(k[(down - along).argmax()])


def semantic_classes(dataset: str, objects: Sequence[str], path: str | Path) -> dict[str, list[str | None]]:
    """dict level -> list of class names, one per object, None for an object that the table does not contain.

    dataset: the source of the meshes; path: CSV of dataset, object, living (yes or no), category. Level 3 needs no
    table. Raises ValueError for a table with other columns or a repeated object.
    """
    table = read_table(path)
    if list(table) != ["dataset", "object", "living", "category"]:
        raise ValueError(f"{path} must have the columns dataset, object, living, category, got {', '.join(table)}")  # type: ignore[arg-type]
    rows = table[table["dataset"] == dataset].set_index("object")
    if rows.index.has_duplicates:
        raise ValueError(f"{path}: {rows.index[rows.index.duplicated()][0]} appears twice in {dataset}: remove one row")
    columns = {"level_1": rows["living"].to_dict(), "level_2": rows["category"].to_dict()}
    classes = {level: [names.get(name) for name in objects] for level, names in columns.items()}
    return classes | {"level_3": list(objects)}


def assign_classes(
    measures: Mapping[str, Mapping[str, float]], dataset: str, seed: int, path: str | Path
) -> tuple[dict[str, dict[str, str]], dict[str, tuple[dict[int, float], int]]]:
    """(dict task -> {object: class name}, dict task -> (curve, chosen)): tasks with two classes or more.

    measures: dict object -> dict of the measures that SHAPE_MEASURES names; dataset, path: as in semantic_classes.
    Objects without a class in a level, and tasks with one class alone, are left out with a message.
    """
    objects, tasks, curves = list(measures), {}, {}
    for task, names in SHAPE_MEASURES.items():
        labels, curve = cluster_objects([[measures[name][key] for key in names] for name in objects], seed)
        tasks[task] = {name: f"{label}" for name, label in zip(objects, labels, strict=True)}
        if curve:
            curves[task] = (curve, labels.max() + 1)
    for level, names in semantic_classes(dataset, objects, path).items():
        tasks[level] = {name: label for name, label in zip(objects, names, strict=True) if label is not None}
        if len(tasks[level]) < len(objects):
            missing = [name for name in objects if name not in tasks[level]]
            print(f"fixation: {level} leaves out {len(missing)} objects that {SEMANTICS} does not contain: "
                  f"{', '.join(missing[:5])}{', ...' if len(missing) > 5 else ''}", file=sys.stderr)  # fmt: skip
    for task in [task for task, classes in tasks.items() if len(set(classes.values())) < 2]:
        print(f"fixation: task {task} is left out, it has fewer than two classes", file=sys.stderr)
        del tasks[task]
    return tasks, curves


TRAIN, VALIDATION = 0.6, 0.2  # shares of the views, the rest is for testing; T3.3.2


def random_views(count: int, generator: np.random.Generator) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(train, validation, test): sorted ids of `count` pictures, 60, 20 and 20 %, whatever their object (T3.3.2).

    Views of one object, even neighbouring ones, are in all three sets. So the accuracy is that of known objects from
    new directions, not of new objects.
    """
    order, first, second = generator.permutation(count), round(TRAIN * count), round((TRAIN + VALIDATION) * count)
    return np.sort(order[:first]), np.sort(order[first:second]), np.sort(order[second:])


def object_folds(labels: np.ndarray, folds: int, generator: np.random.Generator) -> np.ndarray:
    """(k,) i8: the fold 0..folds-1 in which each object is tested, -1 for one whose class has no other object.

    labels (k,): the objects' classes. Each class is spread over the folds, so that the training set of each tested
    object has another object of its class.
    """
    labels = np.asarray(labels)
    fold, start = np.full(len(labels), -1), 0
    for label in np.unique(labels):
        ids = generator.permutation(np.flatnonzero(labels == label))
        if len(ids) > 1:
            fold[ids] = (start + np.arange(len(ids))) % folds
            start += len(ids)
    return fold


def viewpoint_sphere(parallels: int, azimuths: int) -> tuple[Viewpoint, ...]:
    """Viewpoints on parallel circles and at both poles, (parallels x azimuths + 2) of them; the first view first.

    T3.3.2: nine circles, a picture every 15 degrees, and the poles: viewpoint_sphere(9, 24) has 218. The thesis does
    not say where the circles are; here they are evenly spaced, by 18 degrees for nine. Raises ValueError for numbers
    without an equator, or without three views on it a third of a turn apart (see evaluated_views).
    """
    if parallels < 1 or parallels % 2 == 0:
        raise ValueError(f"fixation.parallels must be an odd number, one of them is the equator, got {parallels}")
    if azimuths < 3 or azimuths % 3:
        raise ValueError(f"fixation.azimuths must be a multiple of three, got {azimuths}")
    step = 180 / (parallels + 1)
    around = [Viewpoint(360 / azimuths * k, step * (row + 1) - 90) for row in range(parallels) for k in range(azimuths)]
    return (*around, Viewpoint(0, 90), Viewpoint(0, -90))


def evaluated_views(parallels: int, azimuths: int) -> list[int]:
    """The indices in viewpoint_sphere of three views on the equator, a third of a turn apart.

    The thesis evaluates at the three viewpoints of Lavoue's data, whose directions are not published with it.
    """
    return [parallels // 2 * azimuths + k * azimuths // 3 for k in range(3)]
