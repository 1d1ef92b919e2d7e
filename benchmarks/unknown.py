"""Objects that were never learned, recognised by touch: `python -m benchmarks.unknown [PSB.zip]`, 3 minutes

Learns one or three objects of each of seven classes of psb.zip. Touches each learned object (`known`), another object
of each of these classes (`sibling`), and the objects of the other classes (`stranger`). The planner touches until an
answer has a belief of 95 %, at most 30 times, at places that were drawn for the exploration. The objects stand as they
were learned, or, with `pose` unknown, are turned at random, and each array about its normal. No constant of
haptic_glance.know.unknown was chosen by the ten classes; three draws of classes and objects.

Writes reports/bench/unknown.csv: pose, learned (objects), unknown (whether an object may be none of these), touched
(known, sibling or stranger), explorations; the share of them that ends with the right name, a wrong name, the answer
`none of these`, or undecided, in the mean of the classes with a 95 % interval over the classes (`right_low`,
`right_high` and so on, empty where all classes are equal); the mean number of touches.
"""

from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pandas as pd
from scipy.spatial.transform import Rotation

from benchmarks import arguments
from benchmarks.imprints import PSB
from haptic_glance.base.files import write_table
from haptic_glance.base.rng import rng
from haptic_glance.know import NONE, Exploration, Library, learn
from haptic_glance.mesh import normalise, rotate_to_z_up
from haptic_glance.mesh.files import parse
from haptic_glance.mesh.mesh import Mesh
from stages.engine.statistics import interval
from stages.meshes.sources import SOURCES

OUT = Path("reports/bench/unknown.csv")
CLASSES = ("Airplane", "Armadillo", "Bird", "Bust", "Chair", "Fish", "Glasses", "Human", "Octopus", "Table")
KNOWN, DRAWS = 7, 3  # classes that are learned; draws
EACH = (1, 3)  # learned objects of each class
ANSWERS = ("right", "wrong", "none", "undecided")
SHARES = [f"{name}{end}" for name in ANSWERS for end in ("", "_low", "_high")]
COLUMNS = ["pose", "learned", "unknown", "touched", "explorations", *SHARES, "touches"]


def read(archive):
    """{class: {name: normalised Mesh}} of CLASSES."""
    objects = {name: {} for name in CLASSES}
    for item in SOURCES["princeton"](SimpleNamespace(folder=str(archive), objects=[], up="y")):
        if (group := item.name.rpartition("_")[0]) in objects:
            objects[group][item.name] = normalise(rotate_to_z_up(parse(item.content(), item.suffix), item.up))
    return objects


def drawn(objects, each, seed):
    """{touched: {name: Mesh}}: the objects that are learned, their siblings and the strangers."""
    random = rng(seed, "classes")
    order = random.permutation(list(objects)).tolist()
    members = [random.permutation(list(objects[name])).tolist() for name in order]
    names = {
        "known": [name for group in members[:KNOWN] for name in group[:each]],
        "sibling": [group[max(EACH)] for group in members[:KNOWN]],
        "stranger": [name for group in members[KNOWN:] for name in group],
    }
    meshes = {name: mesh for group in objects.values() for name, mesh in group.items()}
    return {touched: {name: meshes[name] for name in chosen} for touched, chosen in names.items()}


def answer(library: Library, name: str, mesh: Mesh, turned: bool, seed: int) -> tuple[str, int]:
    """(one of ANSWERS, touches) of one exploration."""
    random = rng(seed, name)
    if turned:
        mesh = Mesh(Rotation.random(None, random).apply(mesh.vertices), mesh.faces)
    exploration = Exploration(library, mesh, random)
    known = exploration.finish()
    kinds = {"": "undecided", NONE: "none", name: "right"}
    return kinds.get(known, "wrong"), len(exploration.images)


def rows_of(objects, pose, each, unknown):
    """The rows of one kind of library."""
    answers = []
    for seed in range(DRAWS):
        parts = drawn(objects, each, seed)
        library = learn(parts["known"], pose == "learned", seed, turned=pose != "learned", unknown=unknown)
        answers += [
            (touched, name.rpartition("_")[0], *answer(library, name, mesh, pose != "learned", seed))
            for touched, meshes in parts.items()
            for name, mesh in meshes.items()
        ]
    frame = pd.DataFrame(answers, columns=["touched", "class", "answer", "touches"])
    for touched, group in frame.groupby("touched"):
        shares = {}
        for name in ANSWERS:
            of_classes = (group["answer"] == name).groupby(group["class"]).mean()
            shares |= zip((name, f"{name}_low", f"{name}_high"), np.clip(interval(of_classes), 0, 1), strict=True)
        yield {
            "pose": pose, "learned": KNOWN * each, "unknown": unknown, "touched": touched, "explorations": len(group),
            **shares, "touches": group["touches"].mean(),
        }  # fmt: skip


def main():
    """Measures, prints and writes."""
    objects = read(arguments(__doc__, archive=PSB).archive)
    kinds = [(pose, each, unknown) for pose in ("learned", "unknown") for each in EACH for unknown in (False, True)]
    table = pd.DataFrame([row for kind in kinds for row in rows_of(objects, *kind)], columns=COLUMNS).round(3)
    print(table.to_string(index=False))
    write_table(OUT, table)


if __name__ == "__main__":
    main()
