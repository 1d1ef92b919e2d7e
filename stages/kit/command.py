"""The command line that all stages share: the data set, the root, `--help`, and errors in one line."""

import argparse
import errno
import os
import sys
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING

from .extras import from_extra
from .fetch import FetchError

if TYPE_CHECKING:
    from .workspace import Workspace

REMEDIES = {
    errno.ENOSPC: ": make room on that disk and run it again; it goes on where it stopped",
    errno.EROFS: ": make that place writable and run it again",
}
DEBUG = "HAPTIC_GLANCE_DEBUG"  # where it is set, every error keeps its traceback


def workspace_of_arguments(doc: str | None, stage: str) -> "Workspace":
    """The workspace that the command line of a stage names: `python -m stages.lod household`.

    Answers --help with the stage's docstring, and lets errors of input and settings end in one line. A stage has no
    other setting on its command line: they live in params.yaml. Without a set, the stage runs on the only one that it
    is switched on for.
    """
    first, _, rest = (doc or "").partition("\n")
    parser = argparse.ArgumentParser(
        prog=f"python -m stages.{stage}",
        description=first,
        epilog=rest,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("dataset", nargs="?", default="", help="a data set that params.yaml names")
    parser.add_argument("--root", type=Path, default=Path("."), help="the folder of params.yaml (default: this one)")
    given = parser.parse_args()
    errors_in_one_line(stage)
    with from_extra():
        from .workspace import Workspace  # a core install has commands for one mesh, but no settings
    workspace = Workspace(given.root)
    if stage not in workspace.params["graph"]:
        return workspace  # a stage about all sets
    return workspace.on(given.dataset or _only_set(workspace, stage))


def _only_set(workspace: "Workspace", stage: str) -> str:
    known = list(workspace.params["graph"][stage])
    if len(known) != 1:
        choice = f"one of {', '.join(known)}" if known else "none is switched on: see `python -m stages.compose --help`"
        raise ValueError(f"name the data set: {choice}")
    return known[0]


def errors_in_one_line(name: str) -> None:
    """From now on what a person did (ValueError, a missing file, no network, Ctrl-C) ends in one line, no traceback.

    A fault of ours keeps its traceback, and every error does where HAPTIC_GLANCE_DEBUG is set. After Ctrl-C Python
    ends by the signal itself, which shells report as 130, and which stops a loop of theirs as well.
    """

    def show(kind: type[BaseException], error: BaseException, trace: TracebackType | None) -> None:
        if os.environ.get(DEBUG) or not issubclass(kind, ValueError | FetchError | OSError | KeyboardInterrupt):
            return sys.__excepthook__(kind, error, trace)
        said = "stopped" if issubclass(kind, KeyboardInterrupt) else " ".join(str(error).split())
        print(f"{name}: {said}{REMEDIES.get(getattr(error, 'errno', 0) or 0, '')}", file=sys.stderr)

    sys.excepthook = show
