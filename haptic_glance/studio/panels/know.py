"""Recognises the mesh on the table: a peek past a board, then touches; bars of belief move with each of them."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import viser

from haptic_glance.base.extras import MissingExtra
from haptic_glance.base.rng import rng
from haptic_glance.know import Approach, Belief, Library, known_objects, learn, primitives, touch_until_known
from haptic_glance.know.sight import board
from haptic_glance.look.camera import Viewpoint
from haptic_glance.look.views import render
from haptic_glance.mesh.mesh import Mesh
from haptic_glance.mesh.repair import area_share
from haptic_glance.touch.surface import as_surface

from ..drawing import bars_html, draw_cells, grid_html, picture_html
from ..feeling import felt_by, place_of
from ..jobs import Report
from ..panel import Panel
from ..scene import BLUE, RED, escaped
from ..specimen import Hit, Specimen, open_file

HOUSEHOLD = Path("data") / "household" / "meshes"  # where `make repro` puts them, below the current folder
MOST = 60  # objects
TOUCHES = 10  # of the planner at a time, at most
AWAY = 1.0  # units from the clicked place, where the hand starts: outside of an object, whose radius is 0.5
CAMERA, SIDE = Viewpoint(0, 35), 96  # of the peek; rows and columns of its picture
BOARD = (128, 128, 128)  # colour of the board
POSES = {"turned": "turned", "as learned": "fixed", "anyhow": "any"}
LIFTED = 0.01  # units above the array: its cells face the camera, and would hide the marker
DRAWN, FELT, TOUCHED = "/know", "/know/felt", "/know/touched"
ASK = "Peek at the mesh, click to touch it, or let the planner touch where it learns most."


@dataclass(frozen=True)
class Course:
    """What was seen and felt of a mesh, and the belief after it.

    picture (96, 96, 3) u1: of the last peek, with its board. peeks: so far; each draws another board.
    """

    mesh: Mesh
    belief: Belief
    picture: np.ndarray | None = None
    peeks: int = 0

    def peek(self, share: float) -> "Course":
        """The course with a picture in which a board hides a share of the object, in place of an earlier picture."""
        view = render(self.mesh, CAMERA, size=(SIDE, SIDE))
        hidden = board(view.face >= 0, share, rng(self.peeks, "board"))
        picture = np.where(hidden[..., None], np.array(BOARD, np.uint8), view.rgb)
        blind = replace(self.belief, log_weights=self.belief.library.belief().log_weights + self.belief.felt)
        return replace(self, belief=blind.look(picture, CAMERA, hidden), picture=picture, peeks=self.peeks + 1)

    def touch(self, approach: Approach) -> "Course":
        """The course with one more touch."""
        return replace(self, belief=self.belief.after(approach, *approach.feel(as_surface(self.mesh))))

    @property
    def words(self) -> str:
        """What was done, such as `after a peek and 1 touch`; empty before."""
        touches = len(self.belief.touches)
        parts = ["a peek"] * bool(self.peeks) + [f"{touches} touch{'' if touches == 1 else 'es'}"] * bool(touches)
        return f"after {' and '.join(parts)}" if parts else ""


def gather(
    files: Sequence[Path], up: str | None, table: Specimen, basic: bool, household: Path | None
) -> tuple[dict[str, Mesh], list[str]]:
    """({name: normalised mesh}, what was left out) of all that can be known.

    Basic shapes, the household objects, the files that were opened with the studio, and the mesh on the table; of equal
    names the later ones.
    """
    meshes, notes = primitives() if basic else {}, []
    if household is not None:
        theirs, notes = known_objects(household, MOST)
        meshes |= theirs
    for path in files[:MOST]:
        try:
            mesh = open_file(path, up).mesh
            area_share(mesh)  # or `learn` would refuse all
            meshes[path.stem] = mesh
        except (ValueError, OSError, MissingExtra) as error:
            notes.append(f"{path.name}: {error}")
    return meshes | {table.name: table.mesh}, notes


class KnowPanel(Panel):
    """Peeks at the mesh on the table and touches it, and says which of the known objects it is."""

    title = "Know"

    def build(self, gui: viser.GuiApi) -> None:
        self.about = gui.add_markdown(ASK)
        self.bars = gui.add_html("", visible=False)
        self.pose = gui.add_dropdown("How it stands", tuple(POSES), hint="what is known of its pose before a peek")
        self.hidden = gui.add_slider("Hidden, %", 0, 90, 5, 60, hint="of the object's pixels, behind a board")
        buttons = (
            (gui.add_button("Peek", hint="a picture, 35 degrees from above"), self.peek),
            (gui.add_button("Touch next", hint="where the belief is expected to gain most"), self.touch_next),
            (gui.add_button("Touch until it is known", color="gray"), self.touch_on),
            (gui.add_button("Start again", color="gray"), self.learn),
        )
        self.picture = gui.add_html("", visible=False)
        self.grid = gui.add_html("", visible=False)
        with gui.add_folder("Known objects", expand_by_default=False):
            self.known = gui.add_markdown("")
            self.basic = gui.add_checkbox("Basic shapes", True)
            self.household = gui.add_checkbox("Household", HOUSEHOLD.is_dir(), visible=HOUSEHOLD.is_dir())
        for button, work in buttons:
            self.window.on(button.on_click, work)
        for control in (self.basic, self.household, self.pose):
            self.window.on(control.on_update, self.learn)

    @property
    def course(self) -> Course | None:
        """What was seen and felt of the mesh on the table, once the objects are learned."""
        return self.window.session.kept.get(self.title)

    def on_mesh(self) -> None:
        """Hides what is known of another mesh."""
        self.bars.visible = self.picture.visible = self.grid.visible = False
        self.about.content = ASK
        self.window.scene.clear(DRAWN)

    def on_show(self) -> None:
        """Learns the objects, unless that was done, and shows what was touched."""
        self.window.show()
        if self.course is None:
            self.learn()
        else:
            self.draw()

    def on_hide(self) -> None:
        """Takes away what was touched; it comes back with the panel."""
        self.window.scene.clear(DRAWN)

    def learn(self) -> None:
        """Learns the objects in the background, then begins with the mesh on the table."""
        table, settings = self.window.session.on_table, self.window.settings
        self.window.session.kept.pop(self.title, None)  # a click meanwhile would touch by the old settings
        self.on_mesh()
        household = HOUSEHOLD if self.household.value else None
        basic, pose = self.basic.value, POSES[self.pose.value]

        def work(report: Report) -> tuple[list[str], Library]:
            report(0.1, "reading the known objects")
            meshes, notes = gather(settings.files, settings.up, table, basic, household)
            report(0.5, f"{len(meshes)} objects")
            return notes, learn(meshes, pose)

        self.work("Learning the known objects", work, lambda outcome: self.begin(*outcome))

    def work(self, title: str, work: Callable[[Report], Any], receiver: Callable[[Any], Any]) -> None:
        """Only what was asked for last counts: a touch must not join a belief that has changed meanwhile."""
        self.window.work(title, work, receiver, slot=self.title)

    def begin(self, notes: Sequence[str], library: Library) -> None:
        """The objects are learned: the mesh can be seen and touched."""
        self.window.session.kept[self.title] = Course(self.window.session.on_table.mesh, library.belief())
        twins = [f"{late} has the shape of {early}: they stay undecided" for late, early in library.alike.items()]
        self.known.content = f"{len(library.names)} objects." + "".join(f"\n- {escaped(x)}" for x in [*notes, *twins])
        self.draw()

    def begun(self) -> Course:
        """The course; ValueError that says what to wait for where there is none."""
        self.window.session.on_table  # noqa: B018 (raises where there is no mesh)
        if self.course is None:
            raise ValueError("the known objects are still being learned")
        return self.course

    def advance(self, before: Course, after: Course) -> None:
        """Takes the next step of a course, unless another mesh or another step has come meanwhile."""
        if before is self.course:
            self.window.session.kept[self.title] = after
            self.draw()

    def peek(self) -> None:
        """Takes a picture; the first one waits until each known object was drawn in each pose."""
        course, share = self.begun(), self.hidden.value / 100
        self.work("Comparing views", lambda _: course.peek(share), lambda after: self.advance(course, after))

    def on_click(self, hit: Hit) -> None:
        """Touches where the person clicks."""
        course = self.begun()
        place = place_of(as_surface(course.mesh), hit)
        position, normal = place.positions[0], place.normals[0]
        approach = course.belief.library.approach(position + AWAY * normal, -normal)
        self.work("Touching", lambda _: course.touch(approach), lambda after: self.advance(course, after))

    def touch_next(self) -> None:
        """Touches along the most telling line, and turns the camera to see it."""
        course = self.begun()

        def show(after: Course) -> None:
            self.advance(course, after)
            if self.window.panel is self and self.grid.visible:  # it met the object
                touch = after.belief.touches[-1]
                self.window.scene.face(touch.contact * after.belief.library.diameter, touch.approach.axes[2])

        self.work("Touching", lambda _: course.touch(course.belief.next_touch()), show)

    def touch_on(self) -> None:
        """Lets the planner touch until the object is known."""
        first = self.begun()

        def work(report: Report) -> Course:
            before = first
            for number, step in enumerate(touch_until_known(first.belief, as_surface(first.mesh), TOUCHES)):
                report(number / TOUCHES, f"touch {number + 1}")
                after = replace(before, belief=step.belief)
                self.window.run(self.title, lambda before=before, after=after: self.advance(before, after))
                before = after
            return before

        def end(last: Course) -> None:
            if not last.belief.known:
                self.window.say("Not known yet", f"{TOUCHES} touches leave {last.belief.name} the likeliest")

        self.work("Touching", work, end)

    def draw(self) -> None:
        """Shows the belief, the peek and the touches, as far as they are not shown yet."""
        if self.window.panel is not self or (course := self.course) is None:
            return
        belief, scene = course.belief, self.window.scene
        self.bars.content, self.bars.visible = bars_html(belief.probabilities, belief.known), True
        unsure = f"Not sure {course.words}. {ASK}" if course.words else ASK
        self.about.content = f"**{escaped(belief.known)}**, {course.words}." if belief.known else unsure
        if course.picture is not None:
            self.picture.content, self.picture.visible = picture_html(course.picture, "the peek"), True
        met, number = False, len(belief.touches)
        for k, touch in enumerate(belief.touches, 1):
            felt = felt_by(touch, belief.library, self.window.session.on_table.unit)
            met = bool(np.isfinite(felt.depths).any())
            if met and not scene.has(f"{TOUCHED}/{k}"):
                draw_cells(scene, f"{FELT}/{k}", felt)
                colour, places = BLUE if touch.approach.line >= 0 else RED, felt.centre + LIFTED * felt.axes[2:]
                scene.markers(f"{TOUCHED}/{k}", places, felt.axes[2:], [str(k)], colour)
            self.grid.content = grid_html(felt.pressed, felt.span, felt.unit, f"touch {k}")
        self.grid.visible = met
        if number and not met:
            self.about.content = f"Touch {number} met nothing. {self.about.content}"
