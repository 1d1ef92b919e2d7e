"""A path of the array over the mesh, played frame by frame."""

import time

import numpy as np
import viser

from haptic_glance.touch.surface import as_surface

from ..drawing import draw_array, draw_line
from ..feeling import Sensor, feel_by_rays
from ..grids import grid_html
from ..jobs import Report
from ..panel import Panel
from ..paths import FRAMES, Path, around, through
from ..specimen import Hit

ARRAY, PLACES, LINE = "/path/array", "/path/places", "/path/line"
THROUGH, AROUND = "through the places", "around, by two places"
PLAYING = "Playing"
SECONDS = 0.12  # a frame
ASK = {
    THROUGH: "Click two or more places: the array goes from one to the next.",
    AROUND: "Click two places: the array goes around in the plane through them and the middle of the object.",
}


class PathPanel(Panel):
    """Collects places, follows the path through them, and plays what was felt."""

    title = "Path"

    def build(self, gui: viser.GuiApi) -> None:
        self.path: Path | None = None
        self.how = gui.add_dropdown("Path", (THROUGH, AROUND))
        self.about = gui.add_markdown(ASK[THROUGH])
        self.grid = gui.add_html("", visible=False)
        self.play = gui.add_button("Play", disabled=True)
        self.frame = gui.add_slider("Frame", 1, FRAMES, 1, 1, disabled=True)
        first = Sensor()
        self.cells = gui.add_slider("Cells", 4, 64, 1, first.cells, hint="of each side")
        self.pitch = gui.add_slider("Pitch", 0.002, 0.03, 0.001, first.pitch, hint="from cell to cell; the object is 1")
        self.clear = gui.add_button("Clear the path", color="gray")
        on = self.window.on
        on(self.how.on_update, self.begin)
        on(self.clear.on_click, self.begin)
        on(self.play.on_click, self.play_or_pause)
        on(self.frame.on_update, self.show_frame)
        for control in (self.cells, self.pitch):
            on(control.on_update, self.follow)

    @property
    def places(self) -> list[Hit]:
        """The places that were clicked."""
        return self.window.session.kept.setdefault(self.title, [])

    def on_mesh(self) -> None:
        """The path through the places, if there are any of this mesh."""
        self.hide()

    def on_show(self) -> None:
        self.window.show()
        self.draw()
        if self.path is None and len(self.places) > 1:  # of a page that was loaded again
            self.follow()

    def on_hide(self) -> None:
        self.pause()
        self.window.scene.clear("/path")

    def begin(self) -> None:
        """Forgets the places."""
        self.places.clear()
        self.hide()

    def hide(self) -> None:
        """Forgets the path."""
        self.pause()
        self.path = None
        self.about.content, self.grid.visible = ASK[self.how.value], False
        self.play.disabled = self.frame.disabled = True
        self.window.scene.clear("/path")

    def on_click(self, hit: Hit) -> None:
        """One more place; a third one around begins anew."""
        if self.how.value == AROUND and len(self.places) == 2:
            self.begin()
        self.places.append(hit)
        self.follow()

    def follow(self) -> None:
        """Follows the path through the places; a place that it cannot go to is dropped, with a message."""
        self.pause()
        if len(self.places) < 2:
            self.draw()
            return
        specimen = self.window.session.on_table
        surface, array = as_surface(specimen.mesh), (self.cells.value, self.cells.value)
        try:
            if self.how.value == AROUND:
                path = around(surface, self.places[0], self.places[1], FRAMES, array, self.pitch.value)
            else:
                path = through(specimen.rays, self.places, FRAMES, self.pitch.value)
        except ValueError:
            self.places.pop()
            self.draw()
            raise
        self.path = path
        self.about.content = f"{path.note}, {FRAMES} frames."
        self.play.disabled = self.frame.disabled = False
        self.draw()
        self.play_or_pause()

    def draw(self) -> None:
        """Draws places and path."""
        scene = self.window.scene
        places = np.array([hit.position for hit in self.places]).reshape(-1, 3)
        normals = np.array([hit.normal for hit in self.places]).reshape(-1, 3)
        scene.markers(PLACES, places, normals, [str(k + 1) for k in range(len(places))])
        if self.path is not None:
            draw_line(scene, LINE, self.path.line)
            self.show_frame()

    def show_frame(self) -> None:
        """The frame of the slider."""
        if self.path is None or self.window.panel is not self:
            return
        number, specimen, path = self.frame.value - 1, self.window.session.on_table, self.path
        pose, array = (path.positions[number], path.axes[number]), (self.cells.value, self.cells.value)
        felt = feel_by_rays(as_surface(specimen.mesh), *pose, array, path.pitches[number], specimen.unit)
        draw_array(self.window.scene, ARRAY, felt)
        words = f"frame {number + 1} of {FRAMES}"
        self.grid.content, self.grid.visible = grid_html(felt.pressed, felt.span, felt.unit, words), True

    def play_or_pause(self) -> None:
        """Plays from the frame of the slider, or from the first after the last; or stops there."""
        job = self.window.jobs.get(PLAYING)
        if job is not None and not job.stopped:
            self.pause()
            return
        start = self.frame.value % FRAMES
        self.play.label = "Pause"

        def work(report: Report) -> None:
            for number in range(start, FRAMES):
                report(number / FRAMES, f"frame {number + 1} of {FRAMES}")
                self.frame.value = number + 1  # which shows the frame
                time.sleep(SECONDS)

        self.window.work(PLAYING, work, lambda _: self.pause())

    def pause(self) -> None:
        """Stops playing."""
        if PLAYING in self.window.jobs:
            self.window.jobs[PLAYING].stop()
        self.play.label = "Play"
