"""The imprint at a place: click the mesh, and turn the sensor's settings."""

import viser

from haptic_glance.mesh.mesh import Mesh
from haptic_glance.touch.places import Places
from haptic_glance.touch.press import warm_up
from haptic_glance.touch.surface import as_surface, mean_vertex_normals

from ..drawing import draw_array, grid_html
from ..feeling import CONTOURS, NEWTONS, SENSORS, Sensor, feel, place_of
from ..panel import Panel
from ..specimen import Hit

ARRAY = "/array"  # its name in the scene
ASK = "Click the mesh: the array is pressed there."


class TouchPanel(Panel):
    """Presses the array where the person clicks, and again there when a setting moves."""

    title = "Touch"

    def build(self, gui: viser.GuiApi) -> None:
        first = Sensor()
        self.about = gui.add_markdown(ASK)
        self.grid = gui.add_html("", visible=False)
        self.kind = gui.add_dropdown("Sensor", SENSORS, initial_value=first.kind, hint="how a cell measures")
        self.cells = gui.add_slider("Cells", 4, 64, 1, first.cells, hint="of each side")
        self.pitch = gui.add_slider("Pitch", 0.002, 0.03, 0.001, first.pitch, hint="from cell to cell; the object is 1")
        self.turn = gui.add_slider("Turn", -180, 180, 5, 0, hint="degrees about the normal")
        self.blur = gui.add_slider("Skin", 0.0, 3.0, 0.1, 0.0, hint="cells over which an elastic skin spreads the load")
        self.noise = gui.add_slider("Noise", 0.0, 0.3, 0.01, 0.0, hint="share of full scale")
        self.load = gui.add_slider("Load", 0.1, 10.0, 0.1, first.load, hint="newtons on the whole array", visible=False)
        self.size = gui.add_slider("Size", 10, 500, 10, 100, hint="of the object, in millimetres", visible=False)
        settings = self.kind, self.cells, self.pitch, self.turn, self.blur, self.noise, self.load, self.size
        for control in settings:
            self.window.on(control.on_update, self.again)

    @property
    def sensor(self) -> Sensor:
        """The sensor that the controls describe."""
        array = self.kind.value, self.cells.value, self.pitch.value
        return Sensor(
            *array, self.blur.value, self.noise.value, self.turn.value, self.load.value, self.size.value / 1000
        )

    @property
    def place(self) -> Places | None:
        """The place that was clicked, if one was on this mesh."""
        return self.window.session.kept.get(self.title)

    def on_mesh(self) -> None:
        self.about.content, self.grid.visible = ASK, False

    def on_show(self) -> None:
        mesh = self.window.session.on_table.mesh
        self.window.show()
        self.window.work("Preparing the mesh for touch", lambda _: prepare(mesh), lambda _: self.again())

    def on_hide(self) -> None:
        self.window.scene.clear(ARRAY)

    def on_click(self, hit: Hit) -> None:
        self.window.session.kept[self.title] = place_of(as_surface(self.window.session.on_table.mesh), hit)
        self.again()

    def again(self) -> None:
        """Presses the array where it was pressed before."""
        self.load.visible = self.size.visible = self.kind.value == NEWTONS
        self.turn.disabled = self.kind.value == CONTOURS
        place, specimen = self.place, self.window.session.specimen
        if place is None or specimen is None or self.window.panel is not self:
            return
        felt = feel(as_surface(specimen.mesh), place, self.sensor, specimen.unit)
        rows, columns = felt.pressed.shape
        where = f"vertex {place.vertices[0]}" if place.vertices[0] >= 0 else "a place inside a face"
        self.about.content = f"Pressed at **{where}**, {self.kind.value}."
        self.grid.content = grid_html(felt.pressed, felt.span, felt.unit, f"{rows} x {columns} cells at {where}")
        self.grid.visible = True
        draw_array(self.window.scene, ARRAY, felt)


def prepare(mesh: Mesh) -> None:
    """Does once what the first touch of a mesh would wait for."""
    warm_up()
    as_surface(mesh)
    mean_vertex_normals(mesh)
