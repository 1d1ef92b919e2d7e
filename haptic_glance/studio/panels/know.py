"""Recognition by touch: bars of belief that move with each touch, the next touch, and a mystery object."""

import viser

from haptic_glance.know import NONE, Library
from haptic_glance.know.library import CELLS, PITCH
from haptic_glance.touch.places import Places

from ..drawing import bars_html, draw_cells, grid_html
from ..feeling import Felt, Sensor, feel_in_pose, place_of
from ..jobs import Report
from ..mystery import HOUSEHOLD, Guess, by_planner, count, gather, guess, study, verdict, without_stranger
from ..panel import Panel
from ..scene import BLUE, MESH, escaped
from ..specimen import Hit, Specimen

DRAWN, FELT, TOUCHED, SHOWN, ROOM = "/know", "/know/felt", "/know/touched", "/know/shown", "/know/room"
SENSOR = Sensor(cells=CELLS[0], pitch=PITCH)
ASK = "Click the mesh to touch it, or let the planner touch where it learns most."
HIDDEN = "An object hides in the ball. Click where it may be: what you touch is shown."
GUESS = "guess"


class KnowPanel(Panel):
    """A library of known objects, and one object that is touched: that on the table, or a hidden one."""

    title = "Know"

    def build(self, gui: viser.GuiApi) -> None:
        self.about = gui.add_markdown(ASK)
        self.bars = gui.add_html("", visible=False)
        self.next = gui.add_button("Touch next", hint="where the belief is expected to gain most")
        self.until = gui.add_button("Touch until it is known", color="gray")
        self.mystery = gui.add_button("Mystery object", hint="one of the known objects, hidden", color="violet")
        self.name = gui.add_dropdown("It is", [GUESS], visible=False)
        self.reveal = gui.add_button("Reveal", visible=False)
        self.again = gui.add_button("Start again", color="gray")
        self.grid = gui.add_html("", visible=False)
        with gui.add_folder("Known objects", expand_by_default=False):
            self.known = gui.add_markdown("")
            self.basic = gui.add_checkbox("Basic shapes", True)
            self.household = gui.add_checkbox("Household", HOUSEHOLD.is_dir(), visible=HOUSEHOLD.is_dir())
            self.placed = gui.add_checkbox("It stands as it was learned", True, hint="or else it may lie anywhere")
        hint = "the mesh on the table is not learned, and neither is one of the objects that may hide"
        self.unknown = gui.add_checkbox("It may be none of these", False, hint=hint)
        on = self.window.on
        on(self.next.on_click, self.touch_next)
        on(self.until.on_click, self.touch_on)
        on(self.mystery.on_click, lambda: self.learn(hidden=True))
        on(self.name.on_update, self.take_answer)
        on(self.reveal.on_click, self.show_it)
        on(self.again.on_click, self.learn)
        for control in (self.basic, self.household, self.placed, self.unknown):
            on(control.on_update, self.learn)

    @property
    def guess(self) -> Guess | None:
        """The object that is touched."""
        return self.window.session.kept.get(self.title)

    def target(self) -> Specimen | None:
        """The object that is touched: a hidden one, or the mesh on the table."""
        return self.guess.specimen if self.guess is not None else super().target()

    def on_mesh(self) -> None:
        """Hides the plots until the object is touched."""
        self.bars.visible = self.grid.visible = False
        self.about.content = ASK
        self.window.scene.clear(DRAWN)

    def on_show(self) -> None:
        """Learns the objects, unless that was done, and shows what was touched."""
        self.draw()
        if self.guess is None:
            self.learn()

    def on_hide(self) -> None:
        """Takes away what was touched; it comes back with the panel."""
        self.window.scene.clear(DRAWN)

    def forget(self) -> None:
        """Nothing is touched."""
        self.window.session.kept.pop(self.title, None)
        self.on_mesh()

    def learn(self, hidden: bool = False) -> None:
        """Learns the objects in the background, then begins with the mesh on the table, or with a hidden one."""
        table, settings = self.window.session.specimen, self.window.settings
        household = HOUSEHOLD if self.household.value else None
        basic, placed, unknown = self.basic.value, self.placed.value, self.unknown.value

        def work(report: Report) -> tuple[list[str], Library, float, Guess | None]:
            report(0.1, "reading the known objects")
            meshes, notes = gather(settings.files, settings.up, table, basic, household)
            known = without_stranger(meshes, None if hidden else table) if unknown else meshes
            report(0.5, f"{len(known)} objects")
            library, seconds = study(known, placed, unknown)
            begun = guess(library, meshes, None if hidden else table) if hidden or table is not None else None
            return notes, library, seconds, begun

        self.window.work("Learning the known objects", work, lambda outcome: self.begin(*outcome))

    def begin(self, notes: list[str], library: Library, seconds: float, begun: Guess | None) -> None:
        """The library is there: an object can be touched."""
        self.forget()
        self.window.session.kept[self.title] = begun
        left_out = "".join(f"\n- left out: {escaped(note)}" for note in notes)
        self.known.content = f"{len(library.names)} objects, learned in {seconds:.1f} s.{left_out}"
        self.draw()

    def on_click(self, hit: Hit) -> None:
        if not self.touchable() or self.guess is None:
            return
        self.touch(self.guess, place_of(self.guess.exploration.surface, hit))

    def on_miss(self) -> None:
        """Says so, of a hidden object."""
        if self.guess is not None and self.guess.hidden:
            self.window.say("Nothing there", "the object is elsewhere in the ball", seconds=2)

    def touch(self, game: Guess, place: Places, by_hand: bool = True) -> None:
        """Touches a place of an object, unless another one has come meanwhile."""
        if game is not self.guess:
            return
        game.exploration.touch(place)
        game.helped += not by_hand
        self.show_touch(game.touches - 1)
        self.report()

    def touchable(self) -> bool:
        """Whether there is something to touch; says what to do where there is not."""
        if self.guess is None:
            text = (
                "the known objects are still being learned"
                if self.window.jobs
                else "open a mesh, or take a mystery object"
            )
            self.window.say("Nothing to touch yet", text)
        return self.guess is not None and not self.guess.over

    def touch_next(self) -> None:
        """Finds the most telling place in the background, then touches it."""
        if not self.touchable() or self.guess is None:
            return
        game = self.guess

        def touch(place: Places | None) -> None:
            self.touch_planned(game, place)

        self.window.work("Choosing a place", lambda _: game.exploration.next_place(), touch)

    def touch_planned(self, game: Guess, place: Places | None) -> None:
        """Marks the chosen place and touches it."""
        if place is None:
            self.no_touch_helps()
            return
        self.touch(game, place, by_hand=False)
        if game is not self.guess or self.window.panel is not self:
            return
        number = game.touches
        words = [f"{number}, the planner's"]
        self.window.scene.markers(f"{TOUCHED}/{number - 1}", place.positions, place.normals, words, BLUE)
        self.window.scene.face(place.positions[0], place.normals[0])

    def no_touch_helps(self) -> None:
        """Says why the planner stops."""
        self.window.say("No touch would help", "the likeliest objects feel the same wherever it was not touched yet")

    def touch_on(self) -> None:
        """Lets the planner touch until the object is known."""
        if not self.touchable() or self.guess is None:
            return
        game, before = self.guess, self.guess.touches

        def work(report: Report) -> bool:
            exploration = game.exploration
            while game is self.guess and not exploration.belief.known and game.touches < before + 30:
                report((game.touches - before) / 30, f"touch {game.touches + 1}")
                place = exploration.next_place()
                if place is None:
                    return False
                self.window.run(self.title, lambda place=place: self.touch(game, place, by_hand=False))
            return True

        def ended(helpful: bool) -> None:
            self.report()
            if not helpful:
                self.no_touch_helps()

        self.window.work("Touching", work, ended)

    def report(self) -> None:
        """The bars, and what is known by now."""
        game = self.guess
        if game is None:
            return
        belief = game.exploration.belief
        self.bars.content, self.bars.visible = bars_html(belief.probabilities, belief.known), True
        touches = f"after {count(game.touches)}"
        begin = HIDDEN if game.hidden else ASK
        self.about.content = (
            f"**{escaped(belief.known)}**, {touches}." if belief.known else f"Not sure {touches}. {begin}"
        )
        if game.over:
            self.about.content = game.verdict_text or f"**It is {escaped(game.name)}.**"
        elif not game.touches:
            self.about.content = begin
        if game.hidden and belief.known:
            self.show_it()

    def take_answer(self) -> None:
        """The person says what it is."""
        if self.guess is not None and self.guess.hidden and self.name.value != GUESS and not self.guess.over:
            self.guess.person_answer = self.name.value
            self.show_it()

    def show_it(self) -> None:
        """Ends a mystery: how the planner does alone is found in the background, then the object is shown."""
        game = self.guess
        if game is None or not game.hidden or game.over:
            return
        game.over = True
        self.draw()
        self.window.work(
            "Letting the planner try", lambda _: by_planner(game), lambda planner: self.tell(game, planner)
        )

    def tell(self, game: Guess, planner: tuple[int, str]) -> None:
        """Says who knew the hidden object."""
        game.verdict_text = verdict(game, planner, escaped)
        self.report()

    def draw(self) -> None:
        """Everything anew: the mesh unless it hides, the touches, the controls that fit."""
        if self.window.panel is not self:
            return
        scene, game = self.window.scene, self.guess
        scene.clear(DRAWN)
        hides = game is not None and game.hidden and not game.over
        self.name.visible = self.reveal.visible = hides
        if game is None or not game.hidden:
            if self.window.session.specimen is not None:
                self.window.show()
        else:
            scene.clear(MESH)
        if game is None:
            return
        if hides:
            library = game.exploration.library
            self.name.options = (GUESS, *library.names, *([NONE] if library.verifier else []))
            scene.api.add_icosphere(ROOM, 0.5, (150, 160, 190), subdivisions=5, opacity=0.12, cast_shadow=False)
        elif game.hidden:
            scene.mesh(SHOWN, game.specimen.mesh, None)
        for number in range(game.touches):
            self.show_touch(number)
        self.report()

    def show_touch(self, number: int) -> None:
        """Draws one touch on the object, and what was felt there."""
        if self.window.panel is not self:  # `draw` shows it later
            return
        felt = self.felt(number)
        draw_cells(self.window.scene, f"{FELT}/{number}", felt)
        self.window.scene.markers(
            f"{TOUCHED}/{number}", felt.centre[None], felt.axes[2:], [str(number + 1)], radius=0.008
        )
        self.grid.content = grid_html(felt.pressed, felt.span, felt.unit, f"touch {number + 1}")
        self.grid.visible = True

    def felt(self, number: int) -> Felt:
        """The finding of a touch, in the object's own units."""
        assert self.guess is not None
        exploration, specimen = self.guess.exploration, self.guess.specimen
        position, axes = exploration.positions[number], exploration.axes[number]
        return feel_in_pose(exploration.surface, position, axes, SENSOR, specimen.unit)
