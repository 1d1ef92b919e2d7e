"""Errors in one line, for commands. Imports nothing that takes long, in which a person could press Ctrl-C."""

import atexit
import errno
import os
import select
import signal
import sys
from collections.abc import Iterator
from contextlib import contextmanager
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
    ends by the signal itself, which shells report as 130, and which stops a loop of theirs as well. Where the reader of
    stdout has gone, as after `| head`, the program ends in silence.
    """

    def show(kind: type[BaseException], error: BaseException, trace: TracebackType | None) -> None:
        if os.environ.get(DEBUG) or not issubclass(kind, ValueError | FetchError | OSError | KeyboardInterrupt):
            return sys.__excepthook__(kind, error, trace)
        if issubclass(kind, BrokenPipeError) and _reader_has_gone():
            return _drop_output()
        reason = "stopped" if issubclass(kind, KeyboardInterrupt) else " ".join(str(error).split())
        return print(f"{name}: {reason}{REMEDIES.get(getattr(error, 'errno', 0) or 0, '')}", file=sys.stderr)

    sys.excepthook = show
    atexit.register(_flush)


@contextmanager
def interrupts_wait() -> Iterator[None]:
    """Inside the block Ctrl-C waits until its end; processes that start there never see it.

    Libraries that catch every exception while they are imported would swallow it. Other threads must have begun in such
    a block, or they take the signal.
    """
    if not hasattr(signal, "pthread_sigmask"):  # Windows
        yield
        return
    mask = signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGINT])
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, mask)


def _flush() -> None:
    """Flushes stdout before Python does, which would print that the reader has gone."""
    try:
        print(end="", flush=True)
    except BrokenPipeError:
        _drop_output()
    except OSError:  # such as a full disk: Python's own flush names it and ends with an error
        pass


def _reader_has_gone() -> bool:
    """Whether stdout is a pipe that nobody reads any more; a BrokenPipeError may be of another pipe."""
    if not hasattr(select, "poll"):  # Windows, where such a stdout raises another error
        return False
    poll = select.poll()
    poll.register(1, 0)
    return bool(poll.poll(0))


def _drop_output() -> None:
    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)  # Python flushes stdout once more at its end
