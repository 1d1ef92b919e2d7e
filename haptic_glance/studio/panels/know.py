"""Recognises the mesh on the table by touch: bars of belief that move with each touch, and a planner of touches."""

from collections.abc import Sequence
from pathlib import Path

import viser

from haptic_glance.base.extras import MissingExtra
from haptic_glance.base.rng import rng
from haptic_glance.know import Exploration, known_objects, learn, primitives, touched
from haptic_glance.know.library import CELLS, PITCH
from haptic_glance.mesh.mesh import Mesh
from haptic_glance.touch.places import Places
from haptic_glance.touch.surface import as_surface

from ..drawing import bars_html, draw_cells, grid_html
from ..feeling import Sensor, feel_in_pose, place_of
from ..jobs import Report
from ..panel import Panel
from ..scene import BLUE, RED, escaped
from ..specimen import Hit, Specimen, open_file

HOUSEHOLD = Path("data") / "household" / "meshes"  # where `make repro` puts them, below the current folder
MOST = 60  # objects
TOUCHES = 30  # of the planner at a time, at most
DRAWN, FELT, TOUCHED = "/know", "/know/felt", "/know/touched"
SENSOR = Sensor(cells=CELLS[0], pitch=PITCH)
ASK = "Click the mesh to touch it, or let the planner touch where it learns most."


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
            meshes[path.stem] = open_file(path, up).mesh
        except (ValueError, OSError, MissingExtra) as error:
            notes.append(f"{path.name}: {error}")
    meshes[table.name] = table.mesh
    for name, mesh in list(meshes.items()):
        try:
            touched(name, mesh)
        except ValueError as error:
            notes.append(str(error))
            del meshes[name]
    return meshes, notes


class KnowPanel(Panel):
    """Touches the mesh on the table, and says which of the known objects it is."""

    title = "Know"

    def build(self, gui: viser.GuiApi) -> None:
        self.about = gui.add_markdown(ASK)
        self.bars = gui.add_html("", visible=False)
        self.next = gui.add_button("Touch next", hint="where the belief is expected to gain most")
        self.until = gui.add_button("Touch until it is known", color="gray")
        self.again = gui.add_button("Start again", color="gray")
        self.grid = gui.add_html("", visible=False)
        with gui.add_folder("Known objects", expand_by_default=False):
            self.known = gui.add_markdown("")
            self.basic = gui.add_checkbox("Basic shapes", True)
            self.household = gui.add_checkbox("Household", HOUSEHOLD.is_dir(), visible=HOUSEHOLD.is_dir())
            self.placed = gui.add_checkbox("It stands as it was learned", True, hint="or else it may lie anywhere")
        on = self.window.on
        on(self.next.on_click, self.touch_next)
        on(self.until.on_click, self.touch_on)
        on(self.again.on_click, self.learn)
        for control in (self.basic, self.household, self.placed):
            on(control.on_update, self.learn)

    @property
    def exploration(self) -> Exploration | None:
        """The touches of the mesh on the table, once the objects are learned."""
        return self.window.session.kept.get(self.title)

    def on_mesh(self) -> None:
        """Hides the plots until the object is touched."""
        self.bars.visible = self.grid.visible = False
        self.about.content = ASK
        self.window.scene.clear(DRAWN)

    def on_show(self) -> None:
        """Learns the objects, unless that was done, and shows what was touched."""
        self.window.show()
        if self.exploration is None:
            self.learn()
        else:
            self.draw()

    def on_hide(self) -> None:
        """Takes away what was touched; it comes back with the panel."""
        self.window.scene.clear(DRAWN)

    def learn(self) -> None:
        """Learns the objects in the background, then begins with the mesh on the table."""
        table, settings = self.window.session.on_table, self.window.settings
        household = HOUSEHOLD if self.household.value else None
        basic, placed = self.basic.value, self.placed.value

        def work(report: Report) -> tuple[list[str], Exploration]:
            report(0.1, "reading the known objects")
            meshes, notes = gather(settings.files, settings.up, table, basic, household)
            report(0.5, f"{len(meshes)} objects")
            library = learn(meshes, placed, turned=not placed)
            return notes, Exploration(library, as_surface(table.mesh), rng(0, table.name))

        self.window.work("Learning the known objects", work, lambda outcome: self.begin(*outcome))

    def begin(self, notes: Sequence[str], exploration: Exploration) -> None:
        """The objects are learned: the mesh can be touched."""
        self.on_mesh()
        self.window.session.kept[self.title] = exploration
        left_out = "".join(f"\n- left out: {escaped(note)}" for note in notes)
        self.known.content = f"{len(exploration.library.names)} objects.{left_out}"
        self.draw()

    def on_click(self, hit: Hit) -> None:
        """Touches where the person clicks."""
        exploration = self.touchable()
        self.touch(exploration, place_of(exploration.surface, hit))

    def touchable(self) -> Exploration:
        """The exploration; ValueError that says what to wait for where there is none."""
        self.window.session.on_table  # noqa: B018 (raises where there is no mesh)
        if self.exploration is None:
            raise ValueError("the known objects are still being learned")
        return self.exploration

    def touch(self, exploration: Exploration, place: Places, colour: tuple[int, int, int] = RED) -> None:
        """Touches a place, unless another mesh has come meanwhile."""
        if exploration is not self.exploration:
            return
        exploration.touch(place)
        self.show_touch(exploration, len(exploration.images) - 1, colour)
        self.report()

    def touch_next(self) -> None:
        """Finds the most telling place in the background, then touches it."""
        exploration = self.touchable()

        def touch(place: Places | None) -> None:
            if place is None:
                self.say_no_touch_helps()
            else:
                self.touch(exploration, place, BLUE)
                self.window.scene.face(place.positions[0], place.normals[0])

        self.window.work("Choosing a place", lambda _: exploration.next_place(), touch)

    def touch_on(self) -> None:
        """Lets the planner touch until the object is known."""
        exploration = self.touchable()
        before = len(exploration.images)

        def work(report: Report) -> bool:
            while exploration is self.exploration and not exploration.belief.known:
                done = len(exploration.images) - before
                report(done / TOUCHES, f"touch {done + 1}")
                place = exploration.next_place()
                if place is None or done >= TOUCHES:
                    return place is not None
                self.window.run(self.title, lambda place=place: self.touch(exploration, place, BLUE))
            return True

        self.window.work("Touching", work, lambda helpful: None if helpful else self.say_no_touch_helps())

    def say_no_touch_helps(self) -> None:
        """Says why the planner stops."""
        self.window.say("No touch would help", "the likeliest objects feel the same wherever it was not touched yet")

    def report(self) -> None:
        """The bars, and what is known by now."""
        if (exploration := self.exploration) is None:
            return
        belief, touches = exploration.belief, len(exploration.images)
        self.bars.content, self.bars.visible = bars_html(belief.probabilities, belief.known), True
        after = f"after {touches} touch{'' if touches == 1 else 'es'}"
        unsure = f"Not sure {after}. {ASK}" if touches else ASK
        self.about.content = f"**{escaped(belief.known)}**, {after}." if belief.known else unsure

    def draw(self) -> None:
        """The touches and the belief, anew."""
        if self.window.panel is not self or (exploration := self.exploration) is None:
            return
        self.window.scene.clear(DRAWN)
        for number in range(len(exploration.images)):
            self.show_touch(exploration, number)
        self.report()

    def show_touch(self, exploration: Exploration, number: int, colour: tuple[int, int, int] = RED) -> None:
        """Draws one touch on the object, and what was felt there."""
        if self.window.panel is not self:  # `draw` shows it later
            return
        position, axes = exploration.positions[number], exploration.axes[number]
        felt = feel_in_pose(exploration.surface, position, axes, SENSOR, self.window.session.on_table.unit)
        draw_cells(self.window.scene, f"{FELT}/{number}", felt)
        name, label = f"{TOUCHED}/{number}", [str(number + 1)]
        self.window.scene.markers(name, position[None], axes[2:], label, colour, 0.008)
        self.grid.content = grid_html(felt.pressed, felt.span, felt.unit, f"touch {number + 1}")
        self.grid.visible = True
