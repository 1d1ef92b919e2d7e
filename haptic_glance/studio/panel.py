"""A panel of the studio: what can be done with the mesh on the table."""

from typing import TYPE_CHECKING

import viser

from .specimen import Hit

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

    def on_show(self) -> None:
        """The panel is chosen: draw in the scene what belongs to it."""

    def on_hide(self) -> None:
        """Another panel is chosen: take it away again."""
