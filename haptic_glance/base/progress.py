"""Lines of progress on stderr, with a regular message during a long step."""

import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress

from .errors import interrupts_wait

PAUSE = 8.0  # seconds without a line, after which a command says that it still works


class _Last:
    """The command that printed the last line of progress, and the times of its step and of that line."""

    command, step, line = "", 0.0, 0.0


def report(command: str, text: str) -> None:
    """Prints a line of progress to stderr, apart from the results."""
    _Last.command = command
    _Last.step = _Last.line = time.monotonic()
    print(f"{command}: {text}", file=sys.stderr, flush=True)


@contextmanager
def no_silence() -> Iterator[None]:
    """Within the block, a step that prints nothing for PAUSE seconds is followed by a line that it still goes on.

    The first `report` begins that: what reports nothing, such as a server, stays silent.
    """
    ended = threading.Event()
    _Last.command = ""

    def watch() -> None:
        while not ended.wait(PAUSE / 20):
            now = time.monotonic()
            if _Last.command and now - _Last.line >= PAUSE:
                _Last.line = now
                with suppress(OSError, ValueError):  # the reader of stderr has gone
                    print(f"{_Last.command}: still working, {now - _Last.step:.0f} s", file=sys.stderr, flush=True)

    thread = threading.Thread(target=watch, daemon=True)
    with interrupts_wait():  # Ctrl-C is for the main thread
        thread.start()
    try:
        yield
    finally:
        ended.set()
        thread.join()
