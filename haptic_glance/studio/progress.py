"""The lines at the top of the page that show what is being worked on, and stop it."""

from collections.abc import Callable
from threading import Lock, Timer
from typing import Any

import viser

from .jobs import Job
from .scene import escaped

SOON = 0.4  # seconds; what is done before is not shown


class Progress:
    """Shows the job that was begun last, of those that still run."""

    def __init__(self, gui: viser.GuiApi, on: Callable[..., Any]) -> None:
        self.jobs: list[Job] = []
        self.lock = Lock()
        self.text = gui.add_markdown("", visible=False)
        self.bar = gui.add_progress_bar(0, visible=False, animated=True)
        self.button = gui.add_button("Stop", color="gray", visible=False)
        on(self.button.on_click, self.stop)

    def begin(self, job: Job) -> None:
        """A job starts."""
        with self.lock:
            self.jobs.append(job)
        timer = Timer(SOON, self.show, [job])
        timer.daemon = True
        timer.start()

    def show(self, job: Job) -> None:
        """A job has come further, or has been running for a while."""
        with self.lock:
            if self.jobs and self.jobs[-1] is job:
                self.text.content = f"**{escaped(job.title)}** {escaped(job.text)}"
                self.bar.value = 100 * min(max(job.share, 0.0), 1.0)
                self._visible(True)

    def end(self, job: Job) -> None:
        """A job has ended."""
        with self.lock:
            self.jobs.remove(job)
            if not self.jobs:
                self._visible(False)

    def stop(self) -> None:
        """The person has had enough of the job that is shown."""
        with self.lock:
            latest = self.jobs[-1:]
            self._visible(False)
        for job in latest:
            job.stop()

    def _visible(self, visible):
        for part in (self.text, self.bar, self.button):
            part.visible = visible
