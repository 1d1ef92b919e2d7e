"""Lets a network that learned on photographs recognise imprints, beside one that learned on nothing.

Reads data/meshes and data/salient_points. Presses imprints of high resolution, then trains the network of
transfer.network from each of transfer.weights in each of transfer.modes. Writes data/transfer/imprints/NAME.npz,
networks/TRIAL.npz (what was trained), predictions/TRIAL.npz and confusion.csv.
"""

import functools
import sys
import warnings

from stages.kit import StageRun, arguments, params
from stages.kit.files import write_table
from stages.networks.weights import imagenet_state

from . import touches, trial
from .touches import touchable_vertices


def present(wanted, vertices, touches):
    """The classes that have vertices enough for the touches; the others are named. vertices: {object: count}."""
    found = []
    for name in dict.fromkeys(wanted):
        if name not in vertices:
            print(f"transfer: left out, no mesh of {name}", file=sys.stderr)
        elif vertices[name] < touches:
            print(f"transfer: left out, {name} has {vertices[name]} vertices, fewer than {touches}", file=sys.stderr)
        else:
            found.append(name)
    return found


def none_to_tell_apart(settings, objects):
    """The row of a run with less than two classes: no value, and what would help."""
    note = f"two classes or more are needed: set transfer.classes to some of {', '.join(objects)}"
    print(f"transfer: {note}", file=sys.stderr)
    row = {"object": settings.class_set, "method": settings.network, "weights": None, "mode": None}
    return row | {"repetition": None, "metric": "accuracy", "value": None, "seconds": None, "note": note}


def main():
    arguments(__doc__)
    settings = params("transfer")
    # Torch's caches make a worker grow; joblib then renews it between two items, loses none, and warns.
    warnings.filterwarnings("ignore", message="A worker stopped while some jobs")
    names = trial.trials(settings)
    with StageRun("transfer", inputs=("meshes", "salient_points")) as run:
        there = [name for name in settings.classes if name in run.objects]
        classes = present(settings.classes, {name: touchable_vertices(name) for name in there}, settings.touches)
        if len(classes) < 2:
            run.rows.append(none_to_tell_apart(settings, run.objects))
            run.metrics({})
            return
        if "imagenet" in settings.weights:
            imagenet_state(settings.network, settings.source)  # before the work starts, not in each worker
        run.each(functools.partial(touches.process, settings=settings, seed=run.seed), classes)
        train = functools.partial(trial.process, settings=settings, classes=classes, seed=run.seed)
        rows = run.each(train, names)
        write_table(run.folder / "confusion.csv", trial.confusion(run.folder, names, classes))
        found = trial.summary(rows, run.seed)
        run.metrics(found)
    chance = found.pop("chance")
    reached = ", ".join(f"{kind} {value['accuracy']['value']:.1%}" for kind, value in found.items())
    print(f"transfer: {len(classes)} classes, {len(names)} trainings, chance {chance:.1%}, {reached}")


if __name__ == "__main__":
    main()
