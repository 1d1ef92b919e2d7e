"""The page of one browser window: its panels, its messages, and its work in the background."""

import os
import sys
import traceback
from collections.abc import Callable
from threading import Lock, RLock, Timer
from typing import Any

import numpy as np
import viser

from haptic_glance.base.errors import DEBUG
from haptic_glance.cli.saliency import as_csv

from .guard import bound_uploads
from .jobs import Job, Report
from .opening import Opening
from .panels import PANELS
from .scene import BESIDE, MESH, Scene, escaped
from .session import Session, Settings
from .specimen import Look, Specimen

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


class Window:
    """Everything of one viser client."""

    def __init__(self, client: viser.ClientHandle, settings: Settings, session: Session) -> None:
        self.client, self.gui, self.settings, self.session = client, client.gui, settings, session
        self.lock = RLock()  # one callback at a time
        self.ready = False  # whether events are answered
        self.jobs: dict[str, Job] = {}
        self.scene = Scene(client)
        if not self.scene.covered:
            self.gui.main_panel.dock_right()
        self.scene.on_click(lambda *ray: self.run("", lambda: self.clicked(*ray)))
        self.progress = Progress(self.gui, self.on)
        self.opening = Opening(self, settings)
        bound_uploads(self.gui, self.opening.refuse)
        self.panels = [make(self) for make in PANELS]
        self.tabs = self.gui.add_button_group("Panel", [panel.title for panel in self.panels])
        self.folders = []
        for panel in self.panels:
            folder = self.gui.add_folder(panel.title, visible=False)
            self.folders.append(folder)
            with folder:
                panel.build(self.gui)
        self.panel = self.panels[0]
        self.restore()
        self.ready = True
        self.choose(session.panel or settings.panel)
        self.on(self.tabs.on_click, lambda: self.choose(self.tabs.value))

    def start(self) -> None:
        """Shows the mesh that the session holds, or else opens the first file."""
        self.scene.aim()
        if self.session.specimen is not None:
            self.put(self.session.specimen, keep=True)
            if self.session.view is not None:
                self.scene.turn(*self.session.view)
        else:
            self.opening.first()

    # what panels use

    def on(self, attach: Callable[[Callable[[Any], None]], Any], work: Callable[[], Any]) -> None:
        """on(button.on_click, self.undo): calls work() at each event, one at a time; errors become messages."""
        attach(lambda _: self.run("", work) if self.ready else None)

    def run(self, title: str, work: Callable[[], Any]) -> None:
        """work(), alone; an error becomes a message in the page."""
        with self.lock:
            try:
                work()
            except Exception as error:
                self.fail(title, error)

    def work(
        self, title: str, work: Callable[[Report], Any], receiver: Callable[[Any], Any], slot: str | None = None
    ) -> None:
        """work(report) on a thread of its own, then receiver(result), alone; the page shows its progress and stops it.

        Work in the same slot (None: of the same title) that still runs is stopped, and so is all when another mesh
        comes. Errors become messages.
        """
        slot = slot or title
        with self.lock:
            if slot in self.jobs:
                self.jobs[slot].stop()

            def finish(outcome: Any) -> None:
                with self.lock:
                    if not job.stopped:
                        self.run(title, lambda: receiver(outcome))

            job = Job(title, work, finish, lambda error: self.fail(title, error), self._ended, self.progress.show)
            self.jobs[slot] = job
            self.progress.begin(job)
            job.start()

    def save(self, ending: str, make: Callable[[], bytes]) -> None:
        """Makes a file in the background, then hands it to the browser under the mesh's name and the ending."""
        name = f"{self.session.on_table.name}_{ending}"

        def send(content: bytes) -> None:
            self.client.send_file_download(name, content, save_immediately=True)

        self.work(f"Writing {name}", lambda _: make(), send)

    def save_points(self, look: Look) -> None:
        """Hands the points of a Look to the browser, in the file's coordinates."""
        source = self.session.on_table.source
        self.save("points.csv", lambda: (as_csv(look.points, source) + "\n").encode())

    def say(self, title: str, text: str = "", colour: Any = None, seconds: float | None = 6) -> None:
        """Shows a message; seconds: until it closes by itself, None for never."""
        self.client.add_notification(title, text, color=colour, auto_close_seconds=seconds)

    def fail(self, title: str, error: Exception) -> None:
        """Says what went wrong. A fault of ours is told in the terminal as well."""
        theirs = isinstance(error, ValueError | OSError | ModuleNotFoundError)
        text = " ".join(str(error).split()) or type(error).__name__
        if not theirs or os.environ.get(DEBUG):
            traceback.print_exception(error, file=sys.stderr)
        if not theirs:
            text = f"{type(error).__name__}: {text}. A fault of the studio: the terminal shows where. The rest goes on."
        self.say(title or "That did not work", text, "red", None)

    def put(self, specimen: Specimen, keep: bool = False) -> None:
        """Another mesh on the table: everything of the old one goes."""
        for job in list(self.jobs.values()):
            job.stop()
        if not keep:
            self.session.put(specimen)
        self.run(self.panel.title, self.panel.on_hide)
        self.scene.clear(MESH)
        self.opening.named(specimen)
        for panel in self.panels:
            self.run(panel.title, panel.on_mesh)
        self.run(self.panel.title, self.panel.on_show)

    def show(self) -> None:
        """The mesh on the table in its own colours, or grey."""
        mesh = self.session.on_table.mesh
        self.scene.mesh(MESH, mesh, mesh.colors)

    def clicked(self, origin: np.ndarray, direction: np.ndarray) -> None:
        """A click on the picture."""
        specimen = self.session.specimen
        if specimen is None:
            return
        hit = specimen.pick(origin, direction)
        if hit is None and self.session.other is not None:
            hit = specimen.pick(origin - BESIDE, direction)
        if hit is not None:
            self.panel.on_click(hit)

    def choose(self, title: str) -> None:
        """Shows one panel alone."""
        new_panel = next(panel for panel in self.panels if panel.title == title)
        if new_panel is not self.panel:
            self.run(self.panel.title, self.panel.on_hide)
        self.panel = new_panel
        for panel, folder in zip(self.panels, self.folders, strict=True):
            folder.visible = panel is new_panel
        self.session.panel = title
        if self.session.specimen is not None:
            self.run(new_panel.title, new_panel.on_show)

    def close(self) -> None:
        """The window is gone: its work ends, and the session keeps its controls and its view."""
        for job in list(self.jobs.values()):
            job.stop()
        for part in (self.opening, *self.panels):
            self.session.controls[type(part).__name__] = {name: box.value for name, box in inputs(part).items()}
        self.session.view = self.client.camera.position, self.client.camera.look_at

    def restore(self) -> None:
        """Sets the controls as the session has kept them, but a choice that is no longer offered."""
        for part in (self.opening, *self.panels):
            values = self.session.controls.get(type(part).__name__, {})
            for name, control in inputs(part).items():
                value = values.get(name, control.value)
                if not isinstance(control, viser.GuiDropdownHandle) or value in control.options:
                    control.value = value
        self.opening.colour()

    def _ended(self, job):
        with self.lock:
            self.jobs = {slot: other for slot, other in self.jobs.items() if other is not job}
            self.progress.end(job)


def inputs(part: object) -> dict[str, viser.GuiInputHandle]:
    """The controls with a value among the attributes of a part of the page, by name."""
    return {name: control for name, control in vars(part).items() if isinstance(control, viser.GuiInputHandle)}
