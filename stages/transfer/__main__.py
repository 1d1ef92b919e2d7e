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

from . import touches, trial
from .weights import imagenet_state


def present(wanted, objects):
    """The classes whose meshes are there; the others are named. Raises ValueError where less than two are left."""
    missing = sorted(set(wanted) - set(objects))
    found = [name for name in wanted if name in objects]
    if missing:
        print(f"transfer: left out, no mesh of {', '.join(missing)}", file=sys.stderr)
    if len(found) < 2:
        raise ValueError(f"two classes or more are needed: set transfer.classes to some of {', '.join(objects)}")
    return found


def main():
    arguments(__doc__)
    settings = params("transfer")
    # Torch's caches make a worker grow; joblib then renews it between two items, loses none, and warns.
    warnings.filterwarnings("ignore", message="A worker stopped while some jobs")
    names = trial.trials(settings)
    if "imagenet" in settings.weights:
        imagenet_state(settings.network, settings.source)  # before the work starts, not in each worker
    with StageRun("transfer", inputs=("meshes", "salient_points")) as run:
        classes = present(settings.classes, run.objects)
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
