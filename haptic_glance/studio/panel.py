"""A panel of the studio: what can be done with the mesh on the table."""

from typing import TYPE_CHECKING

import viser

from haptic_glance.touch.places import Places
from haptic_glance.touch.surface import as_surface

from .feeling import place_of
from .specimen import Hit, Specimen

if TYPE_CHECKING:
    from .window import Window


class Panel:
    """The base of all panels, which answers to nothing. A panel is made once for each browser window.

    All of its methods, and what it attaches by `window.on`, run one at a time for a window and must take well under
    100 ms: what takes longer goes to `window.work`. An exception in any of them becomes a message in the page.
    """

    title = ""

    def __init__(self, window: "Window") -> None:
        self.window = window

    def build(self, gui: viser.GuiApi) -> None:
        """Adds the controls, into a container that is shown while the panel is chosen."""

    def on_mesh(self) -> None:
        """Another mesh is on the table (window.session.specimen), or it was turned. Its drawings are already gone."""

    def on_click(self, hit: Hit) -> None:
        """A click on the mesh while this panel is chosen."""

    def target(self) -> Specimen | None:
        """The target of clicks: the mesh on the table."""
        return self.window.session.specimen

    def on_miss(self) -> None:
        """A click beside the target."""

    def on_show(self) -> None:
        """The panel is chosen: draw in the scene what belongs to it."""

    def on_hide(self) -> None:
        """Another panel is chosen: take it away again."""


class TouchingPanel(Panel):
    """The base of panels that touch the mesh on the table where the person clicks, and there again."""

    array = ""  # its name in the scene

    @property
    def place(self) -> Places | None:
        """The place that was clicked, if one was on this mesh."""
        return self.window.session.kept.get(self.title)

    def on_click(self, hit: Hit) -> None:
        self.window.session.kept[self.title] = place_of(as_surface(self.window.session.on_table.mesh), hit)
        self.again()

    def on_hide(self) -> None:
        self.window.scene.clear(self.array)

    def again(self) -> None:
        """Touches the place, if there is one, and shows what was found."""
