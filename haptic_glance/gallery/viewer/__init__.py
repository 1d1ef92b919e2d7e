"""The viewer of turnable meshes: of the gallery, of the report's site, and of `show` in a notebook.

viewer.html, viewer.js and page.css are its parts; `haptic_glance.base.packing` writes the data that the script reads.
"""

import json
from html import escape
from importlib import resources

import numpy as np

from haptic_glance.base.packing import SHADES, pack, viewer_data
from haptic_glance.lod.export import shown_mesh
from haptic_glance.lod.mesh_pictures import viridis, vivid
from haptic_glance.mesh import normalise, rotate_to_z_up
from haptic_glance.mesh.files import MeshLike, as_mesh
from haptic_glance.mesh.materials import bake_texture

MOST = 20_000  # faces of a turnable mesh, some 100 kB


def part(name: str) -> str:
    """The text of one of the viewer's files."""
    return (resources.files(__name__) / name).read_text("utf-8")


def as_script(value: object) -> str:
    """JSON that is safe inside a script element."""
    return json.dumps(value, separators=(",", ":")).replace("</", "<\\/").replace("<!--", "<\\u0021--")


class Shown:
    """A rotatable mesh in a notebook.

    Attributes
    ----------
    html : str
        The page, which any browser can open.
    """

    def __init__(self, html: str) -> None:
        self.html = html

    def _repr_html_(self) -> str:
        return f'<iframe srcdoc="{escape(self.html)}" width="100%" height="560" style="border: 0"></iframe>'


def show(mesh: MeshLike, values: np.ndarray | None = None) -> Shown:
    """Shows a rotatable mesh in a notebook.

    Parameters
    ----------
    mesh : Mesh or any input of `as_mesh`
        The mesh. One of more than 20,000 faces is drawn with so many.
    values : (n,) array_like, optional
        One value per vertex, 0 or more, that colours the mesh from violet (low) to yellow (high).

    Returns
    -------
    Shown
        An object that notebooks draw.

    Raises
    ------
    ValueError
        For values of another shape, negative values, and values that are not finite.
    """
    source = as_mesh(mesh)
    model = normalise(rotate_to_z_up(bake_texture(source)))
    drawn, nearest = shown_mesh(model, MOST)
    saliency = {}
    if values is not None:
        values = np.asarray(values, dtype=np.float64)
        if values.shape != (len(source.vertices),) or not ((values >= 0) & (values < np.inf)).all():
            raise ValueError(f"values must be one per vertex, ({len(source.vertices)},), finite and 0 or more")
        saliency = {"values": ("values", vivid(values)[nearest])}
    colors = None if model.colors is None else model.colors[nearest]
    packed = pack("mesh", len(model.faces), drawn, saliency, {}, {}, colors)
    data = as_script(viewer_data([packed], viridis(np.linspace(0, 1, SHADES))))
    return Shown(
        f'<!DOCTYPE html><html lang="en"><meta charset="utf-8"><title>Mesh</title><style>{part("page.css")}</style>'
        f'<body>{part("viewer.html")}<script type="application/json" id="mesh-data">{data}</script>'
        f"<script>{part('viewer.js')}</script></body></html>"
    )
