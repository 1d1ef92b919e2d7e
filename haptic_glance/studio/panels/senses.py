"""A picture and a touch of the current mesh, one of them damaged, and which one the hybrid network trusts (T5.5).

The functions need no page; `SensesPanel` shows what they find.
"""

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import viser

from haptic_glance.base.extras import from_extra
from haptic_glance.base.rng import rng
from haptic_glance.look.camera import Viewpoint
from haptic_glance.mesh.mesh import Mesh
from haptic_glance.touch import Surface, press_at, sensor_axes
from haptic_glance.touch.places import Places
from haptic_glance.touch.surface import as_surface

from ..drawing import bars_html, draw_array, pair_html
from ..feeling import Sensor, feel
from ..panel import TouchingPanel

if TYPE_CHECKING:
    from haptic_glance.deep.hybrid import HybridNet

NETWORKS = "data/*/transfer/hybrid/networks/*.npz"  # below the current folder, where the stage transfer puts them
MISSING = (
    "There is no hybrid network below data/ yet. `python -m stages.compose experiment=transfer`, then "
    "`make repro`, trains one on classes of furniture in half an hour."
)
SIZE, CELLS, PITCH = 80, 128, 0.00125  # transfer.size, .cells and .pitch of conf/config.yaml
LOWEST, HIGHEST = -10.0, 60.0  # degrees of elevation from which the network has seen objects


@dataclass(frozen=True)
class Answer:
    """picture (h, w, 3) and imprint (r, c), f4 in 0..1, as the network got them.

    vision, touch: {class: probability}, the likeliest first, empty where the sense is absent. sense: the trusted one.
    """

    picture: np.ndarray
    imprint: np.ndarray
    vision: dict[str, float]
    touch: dict[str, float]
    sense: str


def newest_network(root: Path = Path()) -> Path | None:
    """The file of the hybrid network that was trained last, if there is one."""
    return max(root.glob(NETWORKS), key=lambda path: path.stat().st_mtime, default=None)


Trained = tuple["HybridNet", list[str]]  # a network and the names of its classes


def load_network(path: Path) -> Trained:
    """The Trained network of a file. MissingExtra without torch; ValueError for a damaged file."""
    with from_extra():
        from haptic_glance.deep.hybrid import load
    return load(path)


def viewpoint(position: np.ndarray, look_at: np.ndarray) -> Viewpoint:
    """The Viewpoint of a camera, within the elevations that the network knows."""
    x, y, z = position - look_at
    elevation = np.degrees(np.arctan2(z, np.hypot(x, y)))
    return Viewpoint(float(np.degrees(np.arctan2(y, x)) % 360), float(np.clip(elevation, LOWEST, HIGHEST)))


def sense(mesh: Mesh, surface: Surface, seen_from: Viewpoint, place: Places) -> tuple[np.ndarray, np.ndarray]:
    """(picture (SIZE, SIZE, 3), imprint (CELLS, CELLS)), u1, of a normalised mesh."""
    with from_extra():
        from haptic_glance.deep.pictures import take_pictures
    axes = sensor_axes(place.normals[:1])
    imprint = press_at(surface, place.positions[:1], axes, (CELLS, CELLS), PITCH)[0]
    return take_pictures(mesh, [seen_from], SIZE)[0], np.rint(255 * imprint).astype(np.uint8)


def ask(trained: Trained, picture: np.ndarray, imprint: np.ndarray, dark: float, dead: float) -> Answer:
    """The network's class of a picture and an imprint; dark, dead: shares of the light and of the cells taken."""
    with from_extra():
        from haptic_glance.deep.hybrid import SENSES, join_senses
        from haptic_glance.deep.pictures import as_images
        from haptic_glance.disturb.imprint import disturb
        from haptic_glance.disturb.picture import damage_pictures
    (network, classes), random = trained, rng(0, "studio")
    pictures = damage_pictures(picture[None], "darkness", dark, random)
    cells = disturb(imprint[None], "dead_cells", dead, random) if dead < 1 else np.ones((1, *imprint.shape), np.float32)
    images = join_senses(as_images(pictures, SIZE), as_images(cells, SIZE))
    scores = [part[0] / t for part, t in zip(network.separate_scores(images), network.temperature, strict=True)]
    vision, touch = (_shares(part.softmax(0).numpy(), classes) for part in scores)
    trusted = int(network.predict(images).sense[0])
    return Answer(pictures[0], cells[0], vision, touch, SENSES[trusted] if trusted >= 0 else "")


def _shares(values: np.ndarray, classes: list[str]) -> dict[str, float]:
    order = np.argsort(-values, kind="stable")
    return {} if np.isnan(values).any() else {classes[i]: float(values[i]) for i in order}


DRAWN = Sensor(cells=16, pitch=PITCH * CELLS / 16)  # the array as it is drawn, in larger cells
BARS = 4  # classes of each sense
ASK = "Click the mesh: the picture is what you see now, the touch is where you click."


class SensesPanel(TouchingPanel):
    """Asks the hybrid network that was trained last."""

    title, array = "Senses", "/senses"

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

    def on_mesh(self) -> None:
        self.about.content = ASK
        self.images.visible = self.seen.visible = self.felt.visible = False

    def on_show(self) -> None:
        """Loads the network, or says how one is made."""
        self.window.show()
        path = newest_network()
        if path is None:
            self.about.content = MISSING
        elif self.network is None:
            self.window.work("Loading the network", lambda _: load_network(path), self.loaded)
        else:
            self.again()

    def loaded(self, network: Trained) -> None:
        """The network is there."""
        self.network, self.about.content = network, ASK
        self.again()

    def again(self) -> None:
        """Looks, touches, and asks the network."""
        specimen, camera = self.window.session.specimen, self.window.client.camera
        place, network = self.place, self.network
        if specimen is None or place is None or network is None or self.window.panel is not self:
            return
        surface, seen_from = as_surface(specimen.mesh), viewpoint(np.array(camera.position), np.array(camera.look_at))
        dark, dead = self.dark.value, self.dead.value
        draw_array(self.window.scene, self.array, feel(surface, place, DRAWN))
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
            likeliest = dict(list(values.items())[:BARS])
            part.content, part.visible = bars_html(likeliest, best if values is of_all else ""), True
