"""Names known objects by a look and planned touches: `python -m benchmarks.look_and_touch --meshes ZIP_OR_FOLDER`

Each mesh is known, and is then there in some poses: turned by a drawn azimuth, a hundredth of its diameter beside its
place. A camera takes one picture, in which a board hides 60 % of the object. Then a hand touches along lines, up to six
times. Conditions: `blind`, no look; `look`, the picture, and nobody says where the board is; `look_told`, its mask is
told; `siblings`, no look, but the class is told. Policies: `planned`; `spread`, evenly; `random`; `glance`, at the
places of our glance. The names of the folders are classes. The constants of the belief were fitted to other objects.

Prints a table, or with --json one object: `right` {condition: {policy: percent after 0, 1, 2 ... touches}};
`touches_to_sure` and `right_when_sure` {condition: {policy: number}}, where a trial that never is sure counts as the
most touches; `differences` {name: [mean, low, high]} in points, or in touches for names that begin with `touches`;
`reliability`, the largest gap between stated probability and share of right answers, over fifths of the answers;
`seconds` of a step, of learning and in all. Intervals are 95 %, from 4,000 draws of whole classes.
With --rotations, 21 of the objects are also touched blind in any rotation, up to ten times: at random, planned, and
planned where the place is unknown by 3 % and the size by 10 %. `any_rotation` {way: [mean, low, high] for each touch}.
--out writes the same numbers as a table.

examples:
  python -m benchmarks.look_and_touch --meshes psb.zip --json
  python -m benchmarks.look_and_touch --meshes scans --poses 2
"""

import argparse
import json
import sys
import time
import warnings
import zipfile
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
import pandas as pd
from scipy.spatial.transform import Rotation

from haptic_glance.base import progress
from haptic_glance.base.files import write_table
from haptic_glance.base.rng import rng
from haptic_glance.know import SURE, Library, learn, stand
from haptic_glance.look.points import find_points
from haptic_glance.mesh import normalise, rotate_to_z_up
from haptic_glance.mesh.files import FORMATS, load, with_known_up
from haptic_glance.mesh.mesh import Mesh
from haptic_glance.touch import Surface, warm_up
from stages.look_and_touch.protocol import Case, touch_on

TOUCHES, PLACES, DRAWS = 6, 60, 4000
OBJECTS, MOST, PLACE, SIZE = 21, 10, 0.03, 0.1  # in any rotation: objects, touches, and tolerances
ROWS = {
    "blind": ("planned", "spread", "random", "glance"),
    "look": ("planned", "spread", "random", "glance"),
    "look_told": ("planned",),
    "siblings": ("planned", "spread", "glance"),
}
Right = dict[tuple[str, str], np.ndarray]  # (condition, policy): (objects, poses, touches + 1)


def meshes_of(place: Path) -> dict[str, tuple[str, Mesh]]:
    """{name: (class, normalised mesh)} of a ZIP or a folder; what cannot be read is said, and left out."""
    if place.suffix.lower() == ".zip":
        with TemporaryDirectory() as folder, zipfile.ZipFile(place) as archive:
            archive.extractall(folder)
            return meshes_of(Path(folder))
    files = sorted(path for path in place.rglob("*") if path.suffix.lower() in FORMATS and path.is_file())
    found: dict[str, tuple[str, Mesh]] = {}
    for path in files:
        kind = path.parent.name if path.parent != place else path.stem
        try:
            found[f"{kind}/{path.stem}"] = kind, normalise(rotate_to_z_up(with_known_up(load(path))))
        except (ValueError, OSError) as error:
            progress.report("look_and_touch", f"left out: {path.name}: {error}")
    if len(found) < 2:
        raise ValueError(f"{place} holds {len(found)} meshes that can be read: give a ZIP or a folder with two or more")
    return found


def measure(library: Library, meshes: dict[str, tuple[str, Mesh]], poses: int) -> tuple[Right, Right, float]:
    """(probability of the right object, greatest probability, seconds of a planned touch)."""
    names, seconds = list(meshes), []
    cells = [(condition, policy) for condition, policies in ROWS.items() for policy in policies]
    shape = len(names), poses, TOUCHES + 1
    right, stated = ({cell: np.zeros(shape) for cell in cells} for _ in range(2))
    for number, name in enumerate(names):
        kind, mesh = meshes[name]
        siblings = [other for other in names if meshes[other][0] == kind]
        places = {"glance": mesh.vertices[find_points(mesh, "glance", PLACES)]}
        for pose in range(poses):
            case = Case(library, name, mesh, pose, places=places)
            for condition, policies in ROWS.items():
                belief = case.look(condition, siblings)
                for policy in policies:
                    course = touch_on(case, belief, policy, TOUCHES)
                    answers = course.probabilities.argmax(axis=1)
                    right[condition, policy][number, pose] = answers == number
                    stated[condition, policy][number, pose] = course.probabilities.max(axis=1)
                    seconds += [course.seconds] * (policy == "planned")
        progress.report("look_and_touch", f"{number + 1} of {len(names)} objects")
    return right, stated, float(np.median(seconds))


def to_sure(stated: np.ndarray, right: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(touches until sure, whether it is sure, whether the answer is then right), each (objects, poses)."""
    sure = stated >= SURE
    is_sure = sure.any(axis=2)
    touches = np.where(is_sure, sure.argmax(axis=2), TOUCHES)
    return touches, is_sure, np.take_along_axis(right, touches[..., None], axis=2)[..., 0] > 0


def difference(values: np.ndarray, classes: Sequence[str], digits: int) -> list[float]:
    """[mean, low, high] of values (objects,): of the means of classes, which are drawn with replacement."""
    kinds = np.unique(classes)
    means = np.array([values[np.array(classes) == kind].mean() for kind in kinds])
    draws = means[np.random.default_rng(0).integers(len(kinds), size=(DRAWS, len(kinds)))].mean(axis=1)
    return [round(float(value), digits) for value in (means.mean(), *np.quantile(draws, [0.025, 0.975]))]


def reliability(stated: np.ndarray, right: np.ndarray) -> float:
    """Percentage points of the largest gap between stated probability and share of right answers, over fifths."""
    order = np.argsort(stated)
    gaps = [abs(stated[part].mean() - right[part].mean()) for part in np.array_split(order, 5)]
    return round(100 * float(max(gaps)), 1)


def summary(right: Right, stated: Right, classes: Sequence[str]) -> dict[str, Any]:
    """The numbers that --json prints, but for seconds."""
    sure = {cell: to_sure(stated[cell], right[cell]) for cell in right}
    nested = {condition: list(policies) for condition, policies in ROWS.items()}

    def by_cell(value):
        return {condition: {policy: value((condition, policy)) for policy in nested[condition]} for condition in nested}

    def points(first, touches, second, others):
        change = right[first][..., touches] - right[second][..., others]
        return difference(100 * change.mean(axis=1), classes, 1)

    def touches(first, second):
        return difference((sure[first][0] - sure[second][0]).mean(axis=1), classes, 2)

    planned, blind, look = ("look", "planned"), ("blind", "planned"), ("look", "planned")
    return {
        "right": by_cell(lambda cell: [round(100 * float(v), 1) for v in right[cell].mean(axis=(0, 1))]),
        "touches_to_sure": by_cell(lambda cell: round(float(sure[cell][0].mean()), 2)),
        "decided": by_cell(lambda cell: round(100 * float(sure[cell][1].mean()), 1)),
        "right_when_sure": by_cell(lambda cell: round(100 * float(sure[cell][2][sure[cell][1]].mean()), 1)),
        "differences": {
            "look_one_minus_look": points(planned, 1, look, 0),
            "look_one_minus_blind_one": points(planned, 1, blind, 1),
            "touches_look_minus_blind_spread": touches(planned, ("blind", "spread")),
            "touches_siblings_planned_minus_spread": touches(("siblings", "planned"), ("siblings", "spread")),
            "touches_siblings_planned_minus_glance": touches(("siblings", "planned"), ("siblings", "glance")),
            "siblings_right_planned_minus_spread": points(("siblings", "planned"), -1, ("siblings", "spread"), -1),
            "glance_first_minus_spread_first": points(("blind", "glance"), 1, ("blind", "spread"), 1),
            "glance_first_minus_spread_first_after_look": points(("look", "glance"), 1, ("look", "spread"), 1),
            "planned_last_minus_random_last": points(blind, -1, ("blind", "random"), -1),
        },
        "reliability": by_cell(lambda cell: reliability(stated[cell].ravel(), right[cell].ravel())),
    }


def any_rotation(meshes: dict[str, tuple[str, Mesh]]) -> dict[str, list[list[float]]]:
    """{way: percent right with its interval over objects, after 1, 2 ... touches}, blind and in any rotation."""
    names = sorted(np.random.default_rng(0).choice(list(meshes), min(OBJECTS, len(meshes)), replace=False).tolist())
    some = {name: meshes[name][1] for name in names}
    exact, tolerant = learn(some, pose="any"), learn(some, pose="any", position=PLACE, size=SIZE)
    ways = {
        "random": (exact, False, 3),
        "planned": (exact, True, 3),
        "planned_place_and_size_unknown": (tolerant, True, 1),
    }
    found = {}
    for way, (library, planned, repeats) in ways.items():
        right = np.zeros((len(names), repeats, MOST))
        for number, name in enumerate(names):
            for repeat in range(repeats):
                right[number, repeat] = _turned(library, name, planned, repeat)
            progress.report("look_and_touch", f"any rotation, {way}: {number + 1} of {len(names)} objects")
        found[way] = [difference(100 * right[..., touch].mean(axis=1), names, 1) for touch in range(MOST)]
    return found


def _turned(library, name, planned, repeat):
    """(MOST,) whether the name is right after each touch of an object in a drawn rotation."""
    random = rng(repeat, f"rotation {name}")
    tolerance = (
        PLACE * random.uniform(-1, 1, 3) if library.tolerant else 0.01 * random.normal(size=3) * library.diameter
    )
    size = 1 + SIZE * random.uniform(-1, 1) if library.tolerant else 1.0
    there = stand(library.mesh(name), rotation=Rotation.random(None, random).as_matrix())
    surface = Surface(replace(there, vertices=size * there.vertices + tolerance))
    belief, lines, right = library.belief(), random.permutation(library.grid.lines), np.zeros(MOST)
    for touch in range(MOST):
        approach = belief.next_touch() if planned else library.line(int(lines[touch]))
        belief = belief.after(approach, *approach.feel(surface, random))
        right[touch] = belief.name == name
    return right


def rows_of(result: dict[str, Any]) -> list[dict[str, Any]]:
    """The result as rows: what, condition, policy, touches, value, low, high."""
    rows = []
    for condition, by_policy in result["right"].items():
        for policy, values in by_policy.items():
            common = {"condition": condition, "policy": policy}
            rows += [
                {"what": "right", **common, "touches": count, "value": value} for count, value in enumerate(values)
            ]
            rows += [
                {"what": what, **common, "value": result[what][condition][policy]}
                for what in ("touches_to_sure", "decided", "right_when_sure", "reliability")
            ]
    for way, values in result.get("any_rotation", {}).items():
        for touch, (mean, low, high) in enumerate(values):
            row = {"what": "any_rotation", "condition": "blind", "policy": way, "touches": touch + 1}
            rows.append(row | {"value": mean, "low": low, "high": high})
    for name, (mean, low, high) in result["differences"].items():
        rows.append({"what": name, "value": mean, "low": low, "high": high})
    rows += [{"what": what, "value": result[what]} for what in ("objects", "classes", "poses")]
    return rows


def lines_of(result: dict[str, Any]) -> Iterator[str]:
    """The result in words."""
    for condition, by_policy in result["right"].items():
        for policy, values in by_policy.items():
            after = "  ".join(f"{value:5.1f}" for value in values)
            touches, when = result["touches_to_sure"][condition][policy], result["right_when_sure"][condition][policy]
            yield f"{condition:9} {policy:8} {after}  % right after 0 to {TOUCHES}; sure after {touches}, right {when}"
    for way, values in result.get("any_rotation", {}).items():
        yield f"any rotation, {way}: " + "  ".join(f"{mean:g} [{low:g}, {high:g}]" for mean, low, high in values)
    for name, (mean, low, high) in result["differences"].items():
        yield f"{name}: {mean:+g} [{low:g}, {high:g}]"
    yield f"{result['objects']} objects, {result['classes']} classes, {result['poses']} poses: {result['seconds']}"


def main() -> None:
    """Runs the benchmark."""
    about, _, usage = (__doc__ or "").partition("\n\n")
    parser = argparse.ArgumentParser(description=about, epilog=usage, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--meshes", type=Path, required=True, help="a ZIP or a folder; its folders are classes")
    parser.add_argument("--poses", type=int, default=5, help="of each object (default 5)")
    parser.add_argument("--rotations", action="store_true", help="also blind, in any rotation (two minutes)")
    parser.add_argument("--out", type=Path, help="a CSV that is written, too")
    parser.add_argument("--json", action="store_true", help="print one object")
    options = parser.parse_args()
    warnings.simplefilter("ignore")  # equal meshes and guessed axes are part of what is measured
    start = time.perf_counter()
    try:
        meshes = meshes_of(options.meshes)
    except (ValueError, OSError) as error:
        sys.exit(f"look_and_touch: {error}")
    warm_up()
    begun = time.perf_counter()
    library = learn({name: mesh for name, (_, mesh) in meshes.items()})
    learned = time.perf_counter() - begun
    right, stated, step = measure(library, meshes, options.poses)
    classes = [kind for kind, _ in meshes.values()]
    result = summary(right, stated, classes) | {
        "objects": len(meshes), "classes": len(set(classes)), "poses": options.poses,
        "seconds": {"learn": round(learned, 2), "planned_touch": round(step, 4),
                    "all": round(time.perf_counter() - start, 1)},
    }  # fmt: skip
    if options.rotations:
        result["any_rotation"] = any_rotation(meshes)
    if options.out:
        write_table(options.out, pd.DataFrame(rows_of(result)))
    print(json.dumps(result) if options.json else "\n".join(lines_of(result)))


if __name__ == "__main__":
    main()
