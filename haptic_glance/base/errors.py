"""Errors in one line, for commands. Imports nothing that takes long, in which a person could press Ctrl-C."""

import errno
import os
import sys
from types import TracebackType


class FetchError(RuntimeError):
    """A file could be neither found nor fetched, or is not the one expected; the message says what to do by hand."""


REMEDIES = {
    errno.ENOSPC: ": make room on that disk and run it again; it goes on where it stopped",
    errno.EROFS: ": make that place writable and run it again",
}
DEBUG = "HAPTIC_GLANCE_DEBUG"  # where it is set, every error keeps its traceback


def errors_in_one_line(name: str) -> None:
    """From now on what a person did (ValueError, a missing file, no network, Ctrl-C) ends in one line, no traceback.

    A fault of ours keeps its traceback, and every error does where HAPTIC_GLANCE_DEBUG is set. After Ctrl-C Python
    ends by the signal itself, which shells report as 130, and which stops a loop of theirs as well.
    """

    def show(kind: type[BaseException], error: BaseException, trace: TracebackType | None) -> None:
        if os.environ.get(DEBUG) or not issubclass(kind, ValueError | FetchError | OSError | KeyboardInterrupt):
            return sys.__excepthook__(kind, error, trace)
        if issubclass(kind, BrokenPipeError):  # the reader of the output has gone, as after `| head`
            os.dup2(os.open(os.devnull, os.O_WRONLY), 1)  # Python flushes stdout once more at its end
            return None
        said = "stopped" if issubclass(kind, KeyboardInterrupt) else " ".join(str(error).split())
        return print(f"{name}: {said}{REMEDIES.get(getattr(error, 'errno', 0) or 0, '')}", file=sys.stderr)

    sys.excepthook = show
