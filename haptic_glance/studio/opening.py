"""The top of the page: which mesh is on the table, where else there is one, and which axis points up."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from stages.kit import Mesh
from stages.meshes.own import names_of

from .guard import MAX_UPLOAD
from .specimen import Specimen, open_content, open_file, turned

if TYPE_CHECKING:
    from .window import Window

OPENS, NOTHING = "Opening", "none yet"


class Opening:
    """files: those that the person named when the studio was started; no others are read."""

    def __init__(self, window: "Window", files: Sequence[Path], up: str | None) -> None:
        self.window, self.files, self.up = window, dict(zip(names_of(list(files)), files, strict=True)), up
        gui = window.gui
        with gui.add_folder("Mesh"):
            self.about = gui.add_markdown("Open a mesh, a point cloud or a scan.")
            self.choice = gui.add_dropdown("Open", [*self.files] or [NOTHING], visible=len(self.files) > 1)
            self.upload = gui.add_upload_button("Upload a file", hint=f"at most {MAX_UPLOAD >> 20} MB")
            self.axis = gui.add_dropdown("Up axis", ["x", "y", "z"], initial_value="z")
        window.on(self.choice.on_update, lambda: self.open(self.files[self.choice.value]))
        window.on(self.upload.on_upload, self.uploaded)
        window.on(self.axis.on_update, self.turn)

    def first(self) -> None:
        """Opens the first of the files, if there is one."""
        if self.files:
            self.open(next(iter(self.files.values())))

    def open(self, path: Path) -> None:
        """Opens a file in the background."""
        self.window.work(f"{OPENS} {path.name}", lambda _: self.looked_at(open_file(path, self.up)), self.put)

    def uploaded(self) -> None:
        """Opens what the person has uploaded."""
        file = self.upload.value
        self.window.work(
            f"{OPENS} {file.name}", lambda _: self.looked_at(open_content(file.name, file.content)), self.put
        )

    def turn(self) -> None:
        """Another axis points up."""
        specimen, up = self.window.session.on_table, self.axis.value
        if up != specimen.given.up:
            self.window.work(f"Turning {specimen.name}", lambda _: self.looked_at(turned(specimen, up)), self.put)

    def looked_at(self, specimen: Specimen) -> Specimen:
        """The Specimen once it can be clicked and its saliency is known: the slow part, off the window's thread."""
        specimen.look(self.window.session.method, self.window.session.count)
        specimen.rays  # noqa: B018 (built ahead of the first click)
        return specimen

    def put(self, specimen: Specimen) -> None:
        """Puts it on the table."""
        self.window.put(specimen)

    def named(self, specimen: Specimen) -> None:
        """Says what is on the table."""
        mesh: Mesh = specimen.given
        self.about.content = f"**{specimen.name}**: {len(mesh.faces):,} faces, {specimen.note}"
        self.axis.value = mesh.up

    def refuse(self, name: str, size: int) -> None:
        """Says that an upload is too large."""
        text = (
            f"It has {size / 2**20:,.0f} MB, and {MAX_UPLOAD >> 20} are the most. Give its path when you start the studio:"
            f" haptic-glance studio {name}"
        )
        self.window.say(f"{name} was not uploaded", text, "red", None)
