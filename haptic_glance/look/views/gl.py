"""The renderer on OpenGL: pyrender (scikit-robot-pyrender) off screen through EGL, with its shaders replaced.

pyrender's segmentation pass has no multisampling, so silhouettes stay sharp. The two shaders make it draw face ids in
one pass and the shaded material in the next. That pass culls back faces, so each face is uploaded twice, the second
time with reversed winding.
"""

import os
from functools import cache, lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from haptic_glance.base.extras import from_extra
from haptic_glance.mesh.mesh import Mesh

from ..camera import DISTANCE, Viewpoint, pixels_per_unit, project
from .shading import GREY, corner_groups
from .view import LAMBERT, Material, View, empty_view, pixel_box, round_depth

SHADERS = Path(__file__).parent / "shaders"
NEAR, FAR = (
    DISTANCE - 1,
    DISTANCE + 1,
)  # clipping planes; 24 bits of depth resolve 1.2e-7 between them
FACE_IDS, SHADED = (255, 255, 255), (0, 0, 0)  # the uniform `color` selects what the fragment shader draws


@cache
def egl_error() -> str:
    """Why this renderer cannot run here, or an empty string when it can. Creates the context of this process."""
    try:
        _offscreen()
    except Exception as error:  # PyOpenGL raises many types without libEGL or a driver
        return f"{type(error).__name__}: {error}"
    return ""


def render_pyrender(
    mesh: Mesh, viewpoint: Viewpoint, size: tuple[int, int], background: str, material: Material
) -> View:
    """Renders a View (see haptic_glance.look.views.render) by OpenGL; OSError when no EGL context can be created."""
    if egl_error():
        raise OSError(
            f"the renderer pyrender needs EGL, which is not available ({egl_error()}): install it (Debian: apt-get "
            "install libegl1 libgl1-mesa-dri), or set renderer=raster"
        )
    view = empty_view(viewpoint, size, background)
    if pixel_box(np.stack(project(mesh.vertices[mesh.used], viewpoint, size)), size) == (0, 0, 0, 0):
        return view
    scene, node = _upload(mesh)
    _place_camera(scene, viewpoint, size)
    _offscreen()._renderer._program_cache.material = material
    ids, depth = _draw(scene, node, size, FACE_IDS)
    shaded, _ = _draw(scene, node, size, SHADED)
    codes = ids.astype(np.int32) @ np.array([1, 256, 65536], dtype=np.int32)
    mask = codes > 0
    face = np.where(mask, (codes - 1) % max(len(mesh.faces), 1), -1).astype(np.int32)
    rgb = np.where(mask[..., None], shaded, view.rgb)
    return View(rgb, np.where(mask, round_depth(_linear(depth)), view.depth), face, viewpoint)


@cache
def _offscreen() -> Any:
    """The renderer of this process. Its context is created here, so never before a worker process starts."""
    os.environ.setdefault("PYOPENGL_PLATFORM", "egl")  # read when OpenGL is first imported
    with from_extra():
        import pyrender
        from pyrender.shader_program import ShaderProgramCache

    class Programs(ShaderProgramCache):
        """The shaders compiled for a material, whose numbers are constants in them; pyrender passes no others on."""

        material = LAMBERT

        def get_program(self, vertex_shader, fragment_shader, geometry_shader=None, defines=None):
            numbers = {name.upper(): repr(float(value)) for name, value in vars(self.material).items()}
            return super().get_program(vertex_shader, fragment_shader, geometry_shader, (defines or {}) | numbers)

    offscreen: Any = pyrender.OffscreenRenderer(1, 1)  # typed as if its renderer and results could be missing
    offscreen._renderer._program_cache = Programs(shader_dir=str(SHADERS))
    return offscreen


@lru_cache(maxsize=1)  # pyrender frees meshes that are not in the scene it draws
def _upload(mesh):
    """(scene, node) of the mesh: one vertex per group of smooth corners, and each face in both windings."""
    import pyrender

    groups, normals = corner_groups(mesh)
    vertices = np.zeros(len(normals), dtype=np.int64)
    vertices[groups] = mesh.faces
    colors = np.full((len(normals), 3), GREY) if mesh.colors is None else mesh.colors[vertices]
    primitive = pyrender.Primitive(
        positions=np.tile(mesh.vertices[vertices], (2, 1)).astype(np.float32),
        normals=np.r_[normals, -normals].astype(np.float32),
        color_0=np.tile(np.c_[colors / 255, np.ones(len(colors))], (2, 1)).astype(np.float32),
        indices=np.r_[groups, groups[:, ::-1] + len(normals)].astype(np.uint32),
    )
    scene = pyrender.Scene()
    return scene, scene.add(pyrender.Mesh([primitive]))


def _place_camera(scene, viewpoint, size):
    import pyrender

    h, w = size
    scale = 2 * pixels_per_unit(h)
    pose = np.eye(4)
    pose[:3, :3] = viewpoint.axes.T
    pose[:3, 3] = DISTANCE * viewpoint.axes[2]
    if scene.main_camera_node is not None:
        scene.remove_node(scene.main_camera_node)
    scene.add(pyrender.OrthographicCamera(xmag=w / scale, ymag=h / scale, znear=NEAR, zfar=FAR), pose=pose)


def _draw(scene, node, size, color):
    from pyrender import RenderFlags

    offscreen = _offscreen()
    offscreen.viewport_height, offscreen.viewport_width = size
    return offscreen.render(scene, flags=RenderFlags.SEG, seg_node_map={node: color})


def _linear(depth):
    """Distances from the camera. pyrender unprojects as if the camera were a perspective one, which is undone here."""
    depth = np.where(depth > 0, depth, FAR).astype(np.float64)
    window = (FAR + NEAR - 2 * FAR * NEAR / depth) / (FAR - NEAR)
    return NEAR + (window + 1) / 2 * (FAR - NEAR)
