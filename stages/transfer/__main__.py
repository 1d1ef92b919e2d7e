"""Lets networks that learned on photographs recognise imprints, beside ones that learned on nothing (T5.2 to T5.4).

Reads data/classes. Presses the touches of every object with a fine and a coarse array, then trains transfer.networks
from each of transfer.weights in each of transfer.modes, with touches drawn at random for testing and with whole objects
left out. Writes data/transfer/imprints/NAME.npz, networks/TRIAL.npz (what was trained, of the first repetition),
predictions/TRIAL.npz, confusion.csv, weight_change.csv (of each convolution) and stability.csv (disturbed touches).
Stitches hybrid networks for sight and touch (T5.5) of networks that share their middle: data/transfer/hybrid.
"""

import functools
import shutil
import sys
import warnings

from stages.classes import read_classes
from stages.kit import StageRun, arguments, params
from stages.kit.files import write_table
from stages.kit.run import DATA
from stages.networks.weights import imagenet_state

from . import hybrid_data, hybrid_trial, touches, trial
from .plan import check, plan
from .tables import KNOWN, confusion, sorted_out, summary
from .touches import touchable_vertices


def stitch(run, members, settings):
    """(rows, metrics) of the hybrid networks, one network for sight and touch each; none where none is wanted."""
    names = hybrid_trial.trials(settings, members)
    if not names:
        return [], {}
    imagenet_state("mobilenet_v2", settings.source)  # before the work starts, not in each worker
    look = functools.partial(hybrid_data.process, settings=settings, seed=run.seed)
    run.each(look, hybrid_data.items(members["random"]))
    train = functools.partial(hybrid_trial.process, members=members, settings=settings, seed=run.seed)
    rows = run.each(train, names)
    write_table(run.folder / "hybrid" / "confusion.csv", hybrid_trial.confusion(run.folder, names, members))
    return rows, {"hybrid": hybrid_trial.summary(rows, settings, run.seed)}


def main():
    arguments(__doc__)
    settings, source = params("transfer"), params("classes").source
    check(settings)
    # Torch's caches make a worker grow; joblib then renews it between two items, loses none, and warns.
    warnings.filterwarnings("ignore", message="A worker stopped while some jobs")
    with StageRun("transfer", inputs=("classes",)) as run:
        run.dataset = source
        classes = read_classes(DATA / "classes")
        vertices = {name: touchable_vertices(name) for objects in classes.values() for name in objects}
        planned = plan(classes, vertices, settings)
        run.rows = [
            KNOWN | about | {"metric": "accuracy", "value": None, "note": note} for about, note in planned.notes
        ]
        for _, note in planned.notes:
            print(f"transfer: {note}", file=sys.stderr)
        metrics = {}
        if planned.trials:
            objects = [name for objects in planned.members["random"].values() for name in objects]
            run.each(functools.partial(touches.process, settings=settings, seed=run.seed), objects)
            train = functools.partial(trial.process, members=planned.members, settings=settings, seed=run.seed)
            notes = list(run.rows)
            found, disturbed, layers = sorted_out(run.each(train, [one.name for one in planned.trials]), planned.had)
            stitched, parts = stitch(run, planned.members, settings)
            run.rows = found + stitched + notes
            metrics = summary(found, run.seed) | parts
            write_table(run.folder / "stability.csv", disturbed)
            write_table(run.folder / "weight_change.csv", layers)
            write_table(run.folder / "confusion.csv", confusion(run.folder, planned.trials, planned.members))
            shutil.rmtree(run.folder / trial.UNFINISHED, ignore_errors=True)
        for row in run.rows:
            row["object"] = source
        run.metrics(metrics)
    print(f"transfer: {len(planned.members['random'])} classes of {source}, {len(planned.trials)} trainings")


if __name__ == "__main__":
    main()
