"""A picture and a touch of the current mesh, one of them damaged, and which one the hybrid network trusts."""

import numpy as np
import viser

from haptic_glance.know import place_at
from haptic_glance.touch import sensor_axes
from haptic_glance.touch.places import Places
from haptic_glance.touch.surface import as_surface

from ..drawing import draw_array
from ..feeling import feel_by_rays
from ..grids import bars_html, pair_html
from ..panel import Panel
from ..senses import CELLS, MISSING, PITCH, Answer, Trained, ask, load_network, newest_network, sense, viewpoint
from ..specimen import Hit

ARRAY = "/senses"
DRAWN, WIDE = 16, PITCH * CELLS / 16  # cells of the array as it is drawn, and their pitch
BARS = 4  # classes of each sense
ASK = "Click the mesh: the picture is what you see now, the touch is where you click."


class SensesPanel(Panel):
    """Asks the hybrid network that was trained last."""

    title = "Senses"

    def build(self, gui: viser.GuiApi) -> None:
        self.network: Trained | None = None
        self.about = gui.add_markdown(ASK)
        self.images = gui.add_html("", visible=False)
        self.seen = gui.add_html("", visible=False)
        self.felt = gui.add_html("", visible=False)
        self.dark = gui.add_slider("Dark", 0.0, 1.0, 0.05, 0.0, hint="share of the light that is taken")
        self.dead = gui.add_slider("Dead", 0.0, 1.0, 0.05, 0.0, hint="share of the cells that are dead")
        for control in (self.dark, self.dead):
            self.window.on(control.on_update, self.again)

    @property
    def place(self) -> Places | None:
        """The place that was touched."""
        return self.window.session.kept.get(self.title)

    def on_mesh(self) -> None:
        self.images.visible = self.seen.visible = self.felt.visible = False

    def on_show(self) -> None:
        """Loads the network, or says how one is made."""
        self.window.show()
        path = newest_network()
        if path is None:
            self.about.content = MISSING
        elif self.network is None:
            self.window.work("Loading the network", lambda _: load_network(path), self.loaded)

    def loaded(self, network: Trained) -> None:
        """The network is there."""
        self.network, self.about.content = network, ASK
        self.again()

    def on_hide(self) -> None:
        self.window.scene.clear(ARRAY)

    def on_click(self, hit: Hit) -> None:
        surface = as_surface(self.window.session.on_table.mesh)
        self.window.session.kept[self.title] = place_at(surface, hit.position[None], np.array([hit.face]))
        self.again()

    def again(self) -> None:
        """Looks, touches, and asks the network."""
        specimen, place, network, camera = (
            self.window.session.specimen,
            self.place,
            self.network,
            self.window.client.camera,
        )
        if specimen is None or place is None or network is None:
            return
        surface, seen_from = as_surface(specimen.mesh), viewpoint(np.array(camera.position), np.array(camera.look_at))
        dark, dead = self.dark.value, self.dead.value
        axes = sensor_axes(place.normals[:1])[0]
        draw_array(self.window.scene, ARRAY, feel_by_rays(surface, place.positions[0], axes, (DRAWN, DRAWN), WIDE))
        self.window.work(
            "Asking the network",
            lambda _: ask(network, *sense(specimen.mesh, surface, seen_from, place), dark, dead),
            self.answer,
        )

    def answer(self, verdict: Answer) -> None:
        """Shows what both senses say, and which is trusted."""
        of_all = verdict.vision if verdict.sense == "vision" else verdict.touch
        best = next(iter(of_all), "")
        trusted = f"It trusts **{verdict.sense}**: {best}, {of_all[best]:.0%}." if best else "Both senses are absent."
        self.about.content = trusted
        self.images.content, self.images.visible = pair_html(verdict.picture, verdict.imprint), True
        for part, values in ((self.seen, verdict.vision), (self.felt, verdict.touch)):
            part.content, part.visible = (
                bars_html(dict(list(values.items())[:4]), best if values is of_all else ""),
                True,
            )
