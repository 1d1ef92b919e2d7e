"""Work on a thread of its own that reports its progress and can be stopped."""

from collections.abc import Callable
from threading import Event, Thread
from typing import Any

Report = Callable[[float, str], None]  # share done in 0..1 and what is done now; raises Stopped


class Stopped(Exception):
    """The person has stopped the work; nobody waits for its result."""


class Job:
    """Runs work(report) on a thread, then done(result), or failed(error), unless it was stopped; at last ended().

    A job that was stopped ends at its next report; what it found is dropped.
    """

    def __init__(
        self, title: str, work: Callable[[Report], Any], receiver: Callable[[Any], None],
        failed: Callable[[Exception], None], ended: Callable[["Job"], None], shown: Callable[["Job"], None],
    ) -> None:  # fmt: skip
        self.title, self.share, self.text = title, 0.0, ""
        self._parts = work, receiver, failed, ended, shown
        self._stopped = Event()
        self.thread = Thread(target=self._run, name=title, daemon=True)

    def start(self) -> "Job":
        """Starts the work; returns itself."""
        self.thread.start()
        return self

    def stop(self) -> None:
        """Ends the work at its next report."""
        self._stopped.set()

    @property
    def stopped(self) -> bool:
        """Whether it was stopped."""
        return self._stopped.is_set()

    def report(self, share: float, text: str = "") -> None:
        """Shows the work's progress; the work calls it. Raises Stopped where the person has stopped it."""
        if self.stopped:
            raise Stopped
        self.share, self.text = share, text
        self._parts[-1](self)

    def _run(self):
        work, receiver, failed, ended, _ = self._parts
        try:
            outcome = work(self.report)
            if not self.stopped:
                receiver(outcome)
        except Stopped:
            pass
        except Exception as error:
            if not self.stopped:
                failed(error)
        finally:
            ended(self)
