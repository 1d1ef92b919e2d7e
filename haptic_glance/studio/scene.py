"""The scene of one window: coloured meshes, numbered markers."""

import re
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import trimesh
import viser
from trimesh.exchange.gltf import export_glb

from haptic_glance.mesh.mesh import Mesh
from haptic_glance.mesh.srgb import decoded

MATERIAL = {"pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0.8}, "doubleSided": True}


def glb(mesh: Mesh, colors: np.ndarray, flat: bool = False) -> bytes:
    """The GLB of a Mesh with colours (n, 3) u1; flat: without normals, so that every face is lit by its own."""
    rgb = np.full((len(colors), 4), 2**16 - 1, dtype=np.uint16)  # 16 bits: eight would lose the dark ones
    rgb[:, :3] = np.rint(decoded(colors / 255) * (2**16 - 1))
    normals = None if flat else mesh.vertex_normals
    model = trimesh.Trimesh(mesh.vertices, mesh.faces, vertex_normals=normals, process=False)
    model.vertex_attributes["rgb"] = rgb
    return export_glb(model, include_normals=not flat, tree_postprocessor=_matte)


def _matte(tree: dict[str, Any]) -> None:
    """Turns trimesh's attribute into the colours of glTF, and adds the material: trimesh writes colours of 8 bits."""
    (primitive,) = tree["meshes"][0]["primitives"]
    number = primitive["attributes"]["COLOR_0"] = primitive["attributes"].pop("_rgb")
    tree["accessors"][number]["normalized"] = True
    tree["materials"], primitive["material"] = [MATERIAL], 0


MESH = "/mesh"  # the name of the mesh on the table
MIDDLE = np.zeros(3)
GREY = 190  # of what has no colour
EYE = np.array([1.05, -1.4, 0.6])  # where the camera starts, from the middle of an object of diameter 1
BESIDE = np.array([0.8, 0.6, 0.0]) * 1.15  # where a second object stands, to the right of the first
AMBIENT = 1.5  # a full one is pi: the rest shows the shape
LIGHTS = (((1.0, -1.4, 1.6), 1.9), ((-1.4, 1.0, 0.8), 1.2), ((0.3, 0.6, -1.0), 0.6))  # where from, how bright
LEAST_ASPECT = 0.85  # of the picture, in which the object fits from there
FIELD = 0.62  # radians from the lower to the upper edge of the picture
MARKER = 0.011  # radius, in diameters of the object
RED, BLUE = (216, 27, 27), (0, 85, 140)


class Scene:
    """Draws on the page of one viser client. Names begin with `/`; drawing again under a name replaces it."""

    def __init__(self, client: viser.ClientHandle) -> None:
        self.client, self.api = client, client.scene
        self.covered = client.camera.aspect < 1  # a telephone, whose lower half the panel covers
        self.api.set_up_direction("+z")
        self._light()

    def _light(self):
        # The environment map that viser lights with takes five times the whole rest where there is no graphics card.
        self.api.configure_environment_map(None)
        self.api.configure_default_lights(enabled=False)
        self.api.add_light_ambient("/light", intensity=AMBIENT)
        for number, (place, intensity) in enumerate(LIGHTS):
            self.api.add_light_directional(f"/light/{number}", intensity=intensity, position=place)

    def aim(self, wide: bool = False) -> None:
        """Puts the camera where it starts; wide: so that there is room for a second mesh beside the first."""
        middle, scale = (BESIDE / 2, 1.7) if wide else (MIDDLE, 1.0)
        if self.covered:
            scale *= 0.8 / self.client.camera.aspect
            middle = middle - (0, 0, 0.33 * scale)
        else:  # beside the panel little room may be left
            scale *= max(1, LEAST_ASPECT / self.client.camera.aspect)
        self.turn(middle + EYE * scale, middle)

    def turn(self, position: np.ndarray, middle: np.ndarray) -> None:
        """Puts the camera at a position (3,), from which it looks at the middle (3,)."""
        with self.client.atomic():
            self.client.camera.up_direction = (0.0, 0.0, 1.0)
            self.client.camera.fov = FIELD
            self.client.camera.position = position
            self.client.camera.look_at = middle

    def face(self, place: np.ndarray, normal: np.ndarray) -> None:
        """Turns the camera about the middle, where it would see the place (3,) with its normal (3,) from behind."""
        camera = self.client.camera
        offset = np.asarray(camera.position) - camera.look_at
        if (np.asarray(camera.position) - place) @ normal > 0:
            return
        distance = np.linalg.norm(offset)
        towards = normal + 0.5 * offset / distance  # not quite along the normal, which may be the up axis
        self.turn(camera.look_at + towards / np.linalg.norm(towards) * distance, camera.look_at)

    def mesh(
        self, name: str, mesh: Mesh, colors: np.ndarray | None, flat: bool = False, at: np.ndarray = MIDDLE
    ) -> None:
        """A mesh with colours (n, 3) u1, or grey. flat: one normal a face, so that faces are seen. at: its place."""
        if colors is None:
            colors = np.full((len(mesh.vertices), 3), GREY, dtype=np.uint8)
        self.api.add_glb(name, glb(mesh, colors, flat), position=at, cast_shadow=False, receive_shadow=False)

    def on_click(self, clicked: Callable[[np.ndarray, np.ndarray], None]) -> None:
        """clicked(origin, direction) gets the ray of each click on the picture."""
        # Not that of the mesh itself: the page would search all of its faces at each movement of the pointer.
        self.api.on_click()(lambda event: clicked(np.array(event.ray_origin), np.array(event.ray_direction)))

    def markers(
        self, name: str, places: np.ndarray, normals: np.ndarray, labels: Sequence[str],
        colour: tuple[int, int, int] = RED, radius: float = MARKER,
    ) -> None:  # fmt: skip
        """Balls at places (k, 3) of a surface with normals (k, 3), each with its label in front of it."""
        self.clear(name)
        self.api.add_frame(name, show_axes=False)
        for number, (place, normal, label) in enumerate(zip(places, normals, labels, strict=True)):
            self.api.add_icosphere(f"{name}/{number}", radius, colour, subdivisions=2, position=place)
            front = (2 * normal + (0, 0, 1)) * radius
            self.api.add_label(f"{name}/{number}/label", label, depth_test=True, anchor="bottom-center", position=front)

    def labels(self, name: str, places: np.ndarray, labels: Sequence[str]) -> None:
        """Words at places (k, 3), above everything."""
        self.clear(name)
        self.api.add_frame(name, show_axes=False)
        for number, (place, label) in enumerate(zip(places, labels, strict=True)):
            self.api.add_label(f"{name}/{number}", label, anchor="bottom-center", position=place)

    def has(self, name: str) -> bool:
        """Whether something is drawn under the name."""
        return self.api.get_handle_by_name(name) is not None

    def clear(self, *names: str) -> None:
        """Takes away what was drawn under the names and below them."""
        for name in names:
            if self.has(name):
                self.api.remove_by_name(name)


def escaped(text: str) -> str:
    """Text in which nothing is Markdown or code: viser's page runs what a name of a file may hold."""
    return re.sub(r"([^\w\s/,:]|_)", r"\\\1", text)
