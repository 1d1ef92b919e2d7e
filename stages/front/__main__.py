"""Searches the front from mesh to named object: `python -m stages.front`

The choices at all stages (detector, viewpoints, image size, places, sensels, faces of the model, touches, classifier)
decide together how often an object is known, and after how many seconds. Optuna proposes choices, and Hydra composes
and checks each. Twice, a third of the choices is tested again with more objects and splits. Choices that no other
choice beats are then confirmed on shapes and classes that the search has not seen. Finally, each option of the smallest
good choice is changed alone. Seconds are those of one processor core, from the mesh of an object to its name:
simplifying, looking, pressing, asking. Learning is reported apart.

Reads data/SET/meshes of household and of a set with classes; writes reports/measurements/SET/front.csv.gz of both.
Keeps its study in build/front and goes on where it stopped. `dvc repro` does not run it.

examples:
  python -m stages.front
  python -m stages.front --minutes 10
  python -m stages.front --trials 300 --classes princeton_eight
"""

import argparse
import hashlib
import sys
from collections.abc import Sequence
from pathlib import Path

from haptic_glance.base.errors import errors_in_one_line
from haptic_glance.base.extras import from_extra
from haptic_glance.base.files import sha256
from stages.engine.code import stage_digest
from stages.engine.settings import check_clone

SHAPES = "household"
TRIALS = 96  # choices that are proposed: four generations
MINUTES = 60.0


def run(argv: Sequence[str], root: Path = Path(".")) -> int:
    """Runs or continues the search of a repository root; 1 where the minutes were over before its end."""
    parser = argparse.ArgumentParser(
        prog="python -m stages.front", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--trials", type=int, default=TRIALS, help="choices to propose (default: %(default)s)")
    parser.add_argument(
        "--minutes", type=float, default=MINUTES, help="stop after these; a later call goes on (default: %(default)s)"
    )
    parser.add_argument("--seed", type=int, default=0, help="of all random numbers (default: %(default)s)")
    parser.add_argument("--classes", default="furniture", help="data set of the classes (default: %(default)s)")
    options = parser.parse_args(argv)
    with from_extra():
        from . import known
        from .known import halves, read_objects
        from .search import OutOfTime, Search
        from .senses import Senses
    shapes, classes, files = read_objects(root / "data", SHAPES, options.classes)
    searched, unseen = halves(shapes, classes, options.seed)
    folder = root / "build/front" / f"{SHAPES}-{options.classes}-{options.seed}"
    meshes = hashlib.sha256("".join(f"{name} {sha256(path)}" for name, path in sorted(files.items())).encode())
    made_of = {"code": stage_digest("front"), "meshes": meshes.hexdigest()[:16]}
    search = Search(folder, made_of, Senses(files, folder / "felt", options.seed), options.seed, options.minutes)
    try:
        rows = search.run(searched, unseen, options.trials)
    except OutOfTime:
        print(f"front: {options.minutes:g} minutes are over; run it again to go on", file=sys.stderr)
        return 1
    paths = known.write(root / "reports/measurements", (SHAPES, options.classes), rows, options.seed)
    print(f"front: {len(rows)} rows in {' and '.join(map(str, paths))}; `python -m stages.report` shows them")
    return 0


def main() -> None:
    """Runs the command line."""
    errors_in_one_line("front")
    if not {"-h", "--help"} & set(sys.argv):
        check_clone()
    sys.exit(run(sys.argv[1:]))


if __name__ == "__main__":
    main()
