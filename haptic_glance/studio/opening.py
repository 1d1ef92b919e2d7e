"""The top of the page: the current mesh, other meshes to open, and the axis that points up."""

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from haptic_glance.mesh.axes import AXES
from haptic_glance.mesh.files import names_of

from .guard import MAX_UPLOAD
from .jobs import Report
from .scene import escaped
from .session import Settings
from .specimen import Specimen, open_content, open_file, turned

if TYPE_CHECKING:
    from .window import Window

NOTHING = "none"
THEME: dict[str, Any] = {"show_logo": False, "show_share_button": False, "control_width": "large"}


class Opening:
    """Reads the files that the person named when the studio was started, and no others."""

    def __init__(self, window: "Window", settings: Settings) -> None:
        self.window, self.up = window, settings.up
        self.files = dict(zip(names_of(list(settings.files)), settings.files, strict=True))
        gui = window.gui
        with gui.add_folder("Mesh"):
            self.about = gui.add_markdown("Drop a mesh, a point cloud or a scan on the page, or upload it.")
            self.choice = gui.add_dropdown("Open", [*self.files] or [NOTHING], visible=len(self.files) > 1)
            self.upload = gui.add_upload_button(
                "Upload a file", hint=f"or drop it on the page; at most {MAX_UPLOAD >> 20} MB"
            )
            self.dark = gui.add_checkbox("Dark", False)
            self.axis = gui.add_dropdown("Up axis", AXES, initial_value="z")
        window.on(self.choice.on_update, lambda: self.open(self.files[self.choice.value]))
        window.on(self.upload.on_upload, self.uploaded)
        window.on(self.axis.on_update, self.turn)
        window.on(self.dark.on_update, self.colour)

    def first(self) -> None:
        """Opens the first of the files, if there is one."""
        if self.files:
            self.open(next(iter(self.files.values())))

    def colour(self) -> None:
        """Makes the page dark or light."""
        self.window.gui.configure_theme(**THEME, dark_mode=self.dark.value)

    def open(self, path: Path) -> None:
        """Opens a file."""
        self.put(f"Opening {path.name}", lambda: open_file(path, self.up))

    def uploaded(self) -> None:
        """Opens what the person has uploaded."""
        file = self.upload.value
        self.put(f"Opening {file.name}", lambda: open_content(file.name, file.content, self.up))

    def turn(self) -> None:
        """Another axis points up."""
        specimen, up = self.window.session.on_table, self.axis.value
        if up != specimen.source.up:
            self.put(f"Turning {specimen.name}", lambda: turned(specimen, up))

    def put(self, title: str, make: Callable[[], Specimen]) -> None:
        """Puts the Specimen of make() on the table, once it was looked at and is ready for clicks."""
        session = self.window.session

        def work(report: Report) -> Specimen:
            specimen = make()
            report(0.3, "looking at it")
            specimen.look(session.method, session.count)
            report(0.9, "getting ready for clicks")
            specimen.rays  # noqa: B018 (computed here, once)
            return specimen

        self.window.work(title, work, self.window.put, slot="Opening")

    def named(self, specimen: Specimen) -> None:
        """Says what is on the table."""
        count, note = f"{len(specimen.source.faces):,} faces", specimen.note.partition(" (")[0]
        self.about.content = f"**{escaped(specimen.name)}**: {count}, {escaped(note)}"
        if specimen.source.up not in self.axis.options:  # a vector
            self.axis.options = (*self.axis.options, specimen.source.up)
        self.axis.value = specimen.source.up

    def refuse(self, name: str, size: int) -> None:
        """Says that an upload is too large."""
        text = (
            f"It has {size / 2**20:,.0f} MB, and {MAX_UPLOAD >> 20} are the most. Give its path when you start the"
            f" studio instead: haptic-glance studio {name}"
        )
        self.window.say(f"{name} was not uploaded", text, "red", None)
