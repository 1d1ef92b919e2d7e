"""Shows where people look: the mesh coloured by a method, its points with their reasons, another method beside it."""

from collections.abc import Sequence
from functools import partial

import numpy as np
import viser

from haptic_glance.lod.mesh_pictures import coloured
from haptic_glance.look.points import METHODS
from haptic_glance.look.points.methods import split_runnable
from haptic_glance.look.points.reasons import contributions, reasons
from haptic_glance.look.views import TWELVE, render
from haptic_glance.look.weights import LearnedWeights
from haptic_glance.look.weights.weights import GLANCES
from haptic_glance.mesh.mesh import Mesh

from ..jobs import Report
from ..panel import Panel
from ..scene import BESIDE, MESH
from ..specimen import Hit, Look, Specimen, as_bytes

POINTS, OTHER, NAMES = "/points", "/other", "/names"
NONE, AUTOMATIC = "none", 0  # no method beside it; as many points as the method finds
MOST = 20  # points
ABOVE = np.array([0.0, 0.0, 0.58])
TILE = (150, 200)  # rows, columns of each of the twelve views


class LookPanel(Panel):
    """Draws what the session's methods have found."""

    title = "Look"

    def build(self, gui: viser.GuiApi) -> None:
        session, window = self.window.session, self.window
        self.method = gui.add_dropdown("Method", methods(), initial_value=session.method)
        self.other = gui.add_dropdown("Beside it", [NONE, *methods()], initial_value=session.other or NONE)
        hint = f"how many; {AUTOMATIC}: those past the method's own threshold"
        self.listed = session.count or AUTOMATIC  # places that are listed
        self.count = gui.add_slider("Places", AUTOMATIC, MOST, 1, session.count or AUTOMATIC, hint=hint)
        self.here = gui.add_markdown("Click the mesh to see why people look there, or not.")
        self.list = gui.add_markdown("")
        with gui.add_folder("Twelve views", expand_by_default=False):
            self.draw_views = gui.add_button("Draw them", hint="from the viewpoints of the thesis, figure 3.2")
            self.views = gui.add_image(np.full((*TILE, 3), 255, np.uint8), visible=False)
        with gui.add_folder("Save", expand_by_default=False):
            saves = gui.add_button("Places (CSV)"), gui.add_button("Coloured mesh (GLB)")
            hint = "the saliency of each vertex, for Blender (PLY), glTF, USD and meshoptimizer (NPZ)"
            self.weights = gui.add_button_group("Weights", ("PLY", "GLB", "USDA", "NPZ"), hint=hint)
        for control in (self.method, self.other, self.count):
            window.on(control.on_update, self.choose)
        window.on(self.draw_views.on_click, self.start_views)
        window.on(saves[0].on_click, self.save_points)
        window.on(saves[1].on_click, self.save_mesh)
        window.on(self.weights.on_click, self.save_weights)

    def choose(self) -> None:
        """Another method or count was chosen."""
        session = self.window.session
        count = None if session.count is None and self.count.value == self.listed else self.count.value or None
        other = None if self.other.value == NONE else self.other.value
        if (other is None) != (session.other is None):
            self.window.scene.aim(wide=other is not None)
        if (self.method.value, count, other) != (session.method, session.count, session.other):
            session.method, session.count, session.other = self.method.value, count, other
            self.on_show()

    def on_mesh(self) -> None:
        """Another mesh: its views are not drawn yet."""
        self.views.visible = False
        self.here.content, self.list.content = "Click the mesh to see why people look there, or not.", ""
        self.window.scene.aim(wide=self.window.session.other is not None)

    def on_show(self) -> None:
        """Looks at the mesh, unless that was done before, and draws what was found."""
        session = self.window.session
        names = [session.method, *([session.other] if session.other else [])]
        specimen, count = session.on_table, session.count

        def work(report: Report) -> list[Look]:
            looks = []
            for number, name in enumerate(names):
                tell = partial(report, number / len(names), name)
                tell()
                looks.append(specimen.look(name, count, tell))
            return looks

        self.window.work(f"Looking at {specimen.name}", work, self.draw, slot=self.title)

    def on_hide(self) -> None:
        self.window.scene.clear(POINTS, OTHER, NAMES)

    def draw(self, looks: Sequence[Look]) -> None:
        """Draws the one or two Looks, side by side, and lists the points of the first."""
        if self.window.panel is not self:
            return
        scene, specimen = self.window.scene, self.window.session.on_table
        mesh, first = specimen.mesh, looks[0]
        self.on_hide()
        scene.mesh(MESH, first.drawn[0], coloured(*first.drawn).colors)
        self.number(POINTS, mesh, first)
        if len(looks) > 1:
            scene.mesh(OTHER, looks[1].drawn[0], coloured(*looks[1].drawn).colors, at=BESIDE)
            self.number(f"{OTHER}/points", mesh, looks[1])
            scene.labels(NAMES, np.array([ABOVE, BESIDE + ABOVE]), [look.method for look in looks])
        self.explain(specimen, first)

    def number(self, name: str, mesh: Mesh, look: Look) -> None:
        """Draws the points of a Look with their ranks."""
        vertex_ids, ranks = look.vertices, [str(row[0]) for row in look.points]
        self.window.scene.markers(name, mesh.vertices[vertex_ids], mesh.vertex_normals[vertex_ids], ranks)

    def explain(self, specimen: Specimen, look: Look) -> None:
        """Lists the points; with the reasons, if the method has some, when they are known."""
        self.list.content = listing(look, [[]] * len(look.points))
        self.listed = min(len(look.points), MOST)
        if self.count.value != self.listed:  # of a method's own number it says which that is
            self.count.value = self.listed
        if look.method in GLANCES and look.points:
            self.window.work(
                "Asking why",
                lambda _: reasons(contributions(specimen.baked, look.vertices, look.method), look.method),
                lambda why: setattr(self.list, "content", listing(look, why)),
            )

    def on_click(self, hit: Hit) -> None:
        """Says how salient the place is, and why."""
        session = self.window.session
        specimen, look = session.on_table, session.look()
        text = f"**Vertex {hit.vertex}**: saliency {look.saliency[hit.vertex]:.2f}"
        self.here.content = text
        if look.method in GLANCES:
            self.window.work(
                "Asking why here",
                lambda _: contributions(specimen.baked, np.array([hit.vertex]), look.method),
                lambda terms: setattr(self.here, "content", text + for_and_against(terms, look.method)),
            )

    def start_views(self) -> None:
        """Draws the twelve views, one after the other."""
        session = self.window.session
        specimen, look = session.on_table, session.look()
        self.window.work("Twelve views", lambda report: views_of(specimen.mesh, look.saliency, report), self.show_views)

    def show_views(self, image: np.ndarray) -> None:
        """Shows them in the panel."""
        self.views.image, self.views.visible = image, True

    def save_points(self) -> None:
        """Hands out the points in the file's coordinates."""
        self.window.save_points(self.window.session.look())

    def save_mesh(self) -> None:
        """Hands out the coloured mesh in the file's coordinates, turned upright as glTF has it."""
        session = self.window.session
        specimen, look = session.on_table, session.look()
        self.window.save(f"{look.method}.glb", lambda: as_bytes(coloured(specimen.source, look.saliency), ".glb"))

    def save_weights(self) -> None:
        """Hands out the mesh as it was opened, with the saliency of each vertex."""
        session, suffix = self.window.session, f".{self.weights.value.lower()}"
        specimen, look = session.on_table, session.look()
        self.window.save(f"{look.method}_weights{suffix}", lambda: as_bytes(specimen.source, suffix, look.saliency))


def methods() -> list[str]:
    """The names of the methods that have a saliency and run on any mesh."""
    return [name for name in split_runnable(METHODS, LearnedWeights())[0] if hasattr(METHODS[name], "saliency")]


def listing(look: Look, why: Sequence[Sequence[tuple[str, float]]]) -> str:
    """The points as a list in Markdown, each with its reasons."""
    if not look.points:
        return "No place stands out."
    lines = [
        f"{row[0]}. vertex {row[1]}, saliency {row[5]:.2f}"
        + (": " + ", ".join(f"{words} ({amount:+.1f})" for words, amount in causes) if causes else "")
        for row, causes in zip(look.points, why, strict=True)
    ]
    return "\n".join(lines)


def for_and_against(terms: dict[str, np.ndarray], method: str) -> str:
    """The reasons for looking at one place, and those against, in Markdown."""
    sides = {"For it": reasons(terms, method)[0], "against it": reasons(terms, method, against=True)[0]}
    sentences = [
        f"{name}: " + ", ".join(f"{words} ({amount:+.1f})" for words, amount in side)
        for name, side in sides.items()
        if side
    ]
    return "\n\n" + "; ".join(sentences) + "."


def views_of(mesh: Mesh, saliency: np.ndarray, report: Report) -> np.ndarray:
    """The twelve views of the thesis as one picture, (rows, columns, 3) u1, three in a row."""
    model, tiles = coloured(mesh, saliency), []
    for number, viewpoint in enumerate(TWELVE):
        report(number / len(TWELVE), f"{number + 1} of {len(TWELVE)}")
        tiles.append(render(model, viewpoint, TILE, "raster", "white").rgb)
    return np.concatenate([np.concatenate(tiles[k : k + 3], axis=1) for k in range(0, len(tiles), 3)])
