"""A short tour of the page, which a browser that opens it for the first time shows."""

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .window import Window

STEPS = {
    "Look": "Colours show where people look: yellow draws the eye, and the numbers say in which order. Drag to turn the"
    " mesh, scroll to come nearer, click it to see why people look there.",
    "Levels": "The slider takes faces away where nobody looks. *Save* hands out the smaller mesh.",
    "Touch": "Click the mesh: a pressure array is pressed there, and its imprint appears in the panel.",
    "Know": "Each touch moves the belief in what the object is. *Mystery object* hides one for you to find out.",
}  # the panel that is shown: what to try there


class Tour:
    """Goes through the panels; the session knows its step."""

    def __init__(self, window: "Window") -> None:
        self.window, gui = window, window.gui
        self.folder = gui.add_folder("Tour")
        with self.folder:
            self.text = gui.add_markdown("")
            self.next = gui.add_button("Next")
            self.end = gui.add_button("End the tour", color="gray")
        window.on(self.next.on_click, self.go_on)
        window.on(self.end.on_click, lambda: self.show(None))
        self.show(window.session.tour)

    def show(self, step: int | None) -> None:
        """Shows a step, or hides the tour."""
        self.window.session.tour = step
        self.folder.visible = step is not None
        if step is not None:
            title = list(STEPS)[step]
            self.text.content = f"**{step + 1} of {len(STEPS)}: {title}.** {STEPS[title]}"
            self.next.visible = step + 1 < len(STEPS)

    def go_on(self) -> None:
        """The next step, on its panel."""
        step = (self.window.session.tour or 0) + 1
        self.show(step)
        self.window.choose(list(STEPS)[step])
