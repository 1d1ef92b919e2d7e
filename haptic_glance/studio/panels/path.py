"""A path of the array over the mesh, played frame by frame.

Clicks draw it, through places or around the object. `through` and `around` need no page; `PathPanel` shows the result.
"""

import time
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import viser

from haptic_glance.mesh.mesh import unit
from haptic_glance.mesh.rays import RayScene, barycentric
from haptic_glance.touch import Surface, contour, follow
from haptic_glance.touch.surface import as_surface, mean_vertex_normals

from ..drawing import draw_array, draw_line, grid_html
from ..feeling import Sensor, feel_in_pose
from ..jobs import Report
from ..panel import Panel
from ..specimen import Hit

FRAMES = 25  # T4.4.5
FINE = 241  # points of a path as it is drawn: every tenth is a frame of 25
JUMP = 0.08  # units between neighbouring points, half an array: the surface ends there
ABOVE = 0.1  # units above the straight line between two places from which the surface is looked for, at least


@dataclass(frozen=True)
class Path:
    """The poses of the array, frame by frame: positions (k, 3), axes (k, 3, 3), pitches (k,) units.

    line (m, 3): the way as it is drawn; note: how long it is, for the person.
    """

    positions: np.ndarray
    axes: np.ndarray
    pitches: np.ndarray
    line: np.ndarray
    note: str


def around(surface: Surface, first: Hit, second: Hit, frames: int, cells: tuple[int, int], pitch: float) -> Path:
    """The contour in the plane through the object's middle and two places, as haptic_glance.touch.follow walks it
    (T4.4.6).

    Raises ValueError where the three lie on a line.
    """
    plane = np.stack([np.zeros(3), first.position, second.position])
    sequence, curve = follow(surface, plane, frames, cells, pitch), contour(surface, plane)
    line = np.concatenate([curve.points, curve.points[: int(curve.closed)]])
    ahead = np.roll(sequence.positions, -1, axis=0) - sequence.positions
    share = "" if sequence.loops == 1 else f", the longest of {sequence.loops} curves of this plane"
    note = f"once around, {sequence.length:.2f} times the object's size{share}"
    return Path(sequence.positions, _axes(sequence.normals, ahead), sequence.pitches, line, note)


def through(rays: RayScene, places: Sequence[Hit], frames: int, pitch: float) -> Path:
    """Over the surface from place to place, along the lines that a person sees between them.

    Raises ValueError for fewer than two places, and where the path leaves the mesh, with the places between which.
    """
    if len(places) < 2:
        raise ValueError("a path needs two places at least: click another one")
    corners = np.stack([hit.position for hit in places])
    knots = np.append(0.0, np.cumsum(np.linalg.norm(np.diff(corners, axis=0), axis=1)))
    if not knots[-1] > 0:
        raise ValueError("the places are one and the same: click another one")
    outward = np.stack([hit.normal for hit in places])
    line, faces, normals = _on_surface(rays, corners, outward, knots, np.linspace(0, knots[-1], FINE))
    stops = np.rint(np.linspace(0, FINE - 1, frames)).astype(int)
    normals = _normals(rays.mesh, line[stops], faces[stops], normals[stops])
    axes, positions = _axes(normals, np.gradient(line[stops], axis=0)), line[stops]
    note = f"{len(places)} places, {knots[-1]:.2f} times the object's size"
    return Path(positions, axes, np.full(frames, pitch), line, note)


def _on_surface(rays, corners, outward, knots, along):
    """(positions (k, 3), faces (k,), normals (k, 3)) below the lines between the corners, at lengths along (k,)."""
    leg = np.clip(np.searchsorted(knots, along, side="right") - 1, 0, len(corners) - 2)
    share = ((along - knots[leg]) / np.maximum(np.diff(knots)[leg], 1e-12))[:, None]
    line = corners[leg] * (1 - share) + corners[leg + 1] * share
    normals = unit(outward[leg] * (1 - share) + outward[leg + 1] * share)
    height = np.maximum(np.diff(knots)[leg], ABOVE)
    hits = rays.cast(line + height[:, None] * normals, -normals)
    positions = line + (height - np.minimum(hits.distance, 2 * height))[:, None] * normals
    steps = np.linalg.norm(np.diff(positions, axis=0, prepend=positions[:1]), axis=1)
    is_jump = steps > JUMP + knots[-1] / len(along)  # a ray that misses ends at least ABOVE below the line
    if is_jump.any():
        at = int(leg[is_jump.argmax()])
        raise ValueError(f"the path leaves the mesh between places {at + 1} and {at + 2}: click a place between them")
    return positions, hits.face, normals


def _normals(mesh, positions, faces, fallback):
    """Normals of the array between the corners of each face, which turn smoothly along the path."""
    weights = np.clip(barycentric(mesh, faces, positions), 0, 1)
    mean = np.einsum("ij,ijk->ik", weights, mean_vertex_normals(mesh)[mesh.faces[faces]])
    outward = np.einsum("ij,ij->i", mean, mesh.face_normals[faces]) > 0
    return unit(np.where(outward[:, None], mean, fallback))


def _axes(normals, ahead):
    """(k, 3, 3) rows right, up, normal: up is the direction of motion on the array."""
    up = ahead - np.einsum("ij,ij->i", ahead, normals)[:, None] * normals
    still = np.linalg.norm(up, axis=1, keepdims=True) < 1e-9
    up = unit(np.where(still, np.cross(normals, [0.1, 0.2, 1.0]), up))
    return np.stack([np.cross(up, normals), up, normals], axis=1)


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
        sensor = Sensor(cells=self.cells.value, pitch=path.pitches[number])
        pose = path.positions[number], path.axes[number]
        felt = feel_in_pose(as_surface(specimen.mesh), *pose, sensor, specimen.unit)
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
