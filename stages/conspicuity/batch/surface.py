"""The channels of the surface on a Stack: values of the mesh at every second pixel."""

import numpy as np
import torch

from stages.kit import Mesh
from stages.kit.camera import DISTANCE, pixels_per_unit

from ..curvature import capped_curvature
from ..operators import SCALES
from ..surface import SCALE
from ..symmetry import BAND, symmetries, weighted_axes, weighted_planes
from .stack import Stack


class VisibleSurface:
    """The surface under the pixels of a Stack at SCALE: known, faces (v, 1, h, w) and points (3, v, 1, h, w)."""

    def __init__(self, stack: Stack, mesh: Mesh) -> None:
        step = 2**SCALE
        self.stack, self.mesh, self.views = stack, mesh, stack.views
        crops = list(zip(stack.views, stack.boxes, strict=True))
        faces = stack.upload([view.face[box][::step, ::step] for view, box in crops], SCALE).long()
        depths = stack.upload([view.depth[box][::step, ::step] for view, box in crops], SCALE)
        self.known = (faces >= 0) & stack.grid.within(SCALE)
        self.faces = faces.clamp(min=0)
        self.points = self._points(torch.where(self.known, depths, 0).double(), step)

    def _points(self, depths, step):
        """The points at given depths along stages.kit.camera.pixel_rays."""
        (h, w), scale = self.stack.view_shape, pixels_per_unit(self.stack.view_shape[0])
        axes = self.tensor(np.stack([view.viewpoint.axes for view in self.views]).transpose(1, 2, 0))
        right, up, back = axes[..., None, None, None]
        top, left = self.tensor(self.stack.corners.T)[..., None, None, None]
        rows, columns = (torch.arange(n, device=depths.device) * step for n in depths.shape[2:])
        x, y = (left + columns - (w - 1) / 2) / scale, ((h - 1) / 2 - top - rows[:, None]) / scale
        return (DISTANCE - depths) * back + x * right + y * up

    def tensor(self, values: np.ndarray) -> torch.Tensor:
        """The values as f8 on the device."""
        return torch.from_numpy(np.ascontiguousarray(values, dtype=np.float64)).to(self.stack.device)

    def interpolate(self, values: np.ndarray) -> torch.Tensor:
        """(v, 1, h, w) f8 of values (n,) f8 at the vertices: barycentric, as stages.kit.rays.barycentric."""
        corners = self.tensor(self.mesh.vertices[self.mesh.faces].transpose(1, 2, 0))  # corner, coordinate, face
        normals = self.tensor(self.mesh.face_crosses.T)
        square = (normals * normals).sum(0).clamp(min=np.finfo(float).tiny)
        a, b, c = corners[:, :, self.faces]
        normal, square = normals[:, self.faces], square[self.faces]
        wb = (torch.linalg.cross(self.points - a, c - a, dim=0) * normal).sum(0) / square
        wc = (torch.linalg.cross(b - a, self.points - a, dim=0) * normal).sum(0) / square
        weights = torch.stack([1 - wb - wc, wb, wc]).clamp(0, 1)
        weights = weights / weights.sum(0)
        return (weights * self.tensor(values[self.mesh.faces].T)[:, self.faces]).sum(0)

    def pyramid(self, values: torch.Tensor) -> dict[int, torch.Tensor]:
        """{1..8: (v, 1, h, w) f4} of values (v, 1, h, w) on the surface, extended into the background."""
        filled = self.stack.grid.fill(torch.where(self.known, values, 0).float(), self.known, SCALE)
        return self.stack.grid.pyramid(filled, SCALE, SCALES - 1)


def curvature(seen: VisibleSurface) -> dict[int, torch.Tensor]:
    """{2..8: (v, 1, h, w)}."""
    return seen.pyramid(seen.interpolate(capped_curvature(seen.mesh)))


def symmetry(seen: VisibleSurface) -> dict[int, torch.Tensor]:
    """{2..8: (v, 1, h, w)}: stages.conspicuity.symmetry.symmetric_points, plane by plane and axis by axis."""
    found, spread = symmetries(seen.mesh), 2 * (BAND * seen.mesh.diagonal) ** 2
    backs = [view.viewpoint.axes[2] for view in seen.views]
    response = torch.zeros_like(seen.points[0])
    for normal, offset, weight in _across_views(seen, [weighted_planes(found, back) for back in backs]):
        height = (seen.points * normal).sum(0) - offset
        response = torch.maximum(response, weight * torch.exp(-(height**2) / spread))
    away = seen.points - seen.tensor(found.centre)[:, None, None, None, None]
    for axis, weight in _across_views(seen, [weighted_axes(found, back) for back in backs]):
        distance = (away**2).sum(0) - (away * axis).sum(0) ** 2
        response = torch.maximum(response, weight * torch.exp(-distance / (4 * spread)))
    return seen.pyramid(response)


def _across_views(seen, lists):
    """Yields tuples of tensors with the k-th plane or axis of each view; views with fewer get one of zero weight."""
    nothing = tuple(np.zeros_like(part) for part in next((first for first, *_ in filter(None, lists)), ()))
    for k in range(max(map(len, lists))):
        parts = zip(*(each[k] if k < len(each) else nothing for each in lists), strict=True)
        yield tuple(seen.tensor(np.stack(part, axis=-1))[..., None, None, None] for part in parts)
