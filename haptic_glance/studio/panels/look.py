"""Where people look: the mesh coloured by a method, its points in order, another method beside it."""

import viser

from stages.salient_points import METHODS
from stages.salient_points.methods import split_runnable
from stages.weights import LearnedWeights

from ..panel import Panel
from ..specimen import Look

POINTS = "/points"


def methods() -> list[str]:
    """The names of the methods that have a saliency and run on any mesh."""
    return [name for name in split_runnable(METHODS, LearnedWeights())[0] if hasattr(METHODS[name], "saliency")]


class LookPanel(Panel):
    """See above."""

    title = "Look"

    def build(self, gui: viser.GuiApi) -> None:
        """Adds the controls."""
        self.method = gui.add_dropdown("Method", methods(), initial_value=self.window.session.method)
        self.list = gui.add_markdown("")
        self.window.on(self.method.on_update, self.choose)

    def choose(self) -> None:
        """Another method was chosen."""
        self.window.session.method = self.method.value
        self.on_show()

    def on_show(self) -> None:
        """Draws the mesh and its points."""
        session = self.window.session
        self.window.work(f"Looking by {session.method}", lambda _: session.look(), self.draw, slot=self.title)

    def draw(self, look: Look) -> None:
        """Draws what was found."""
        mesh = self.window.session.on_table.mesh
        self.window.show(look.saliency)
        labels = [str(row[0]) for row in look.points]
        self.window.scene.markers(POINTS, mesh.vertices[look.vertices], labels)

    def on_hide(self) -> None:
        """Takes the points away."""
        self.window.scene.clear(POINTS)
