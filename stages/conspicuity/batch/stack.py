"""The crops of a batch of views in one tensor, filled and in pyramids: CroppedView for a batch."""

from collections.abc import Sequence
from functools import cached_property

import cv2
import numpy as np
import torch
from torch.nn import functional

from stages.views import View

from ..cropped_view import COVERED, SILHOUETTE_BAND, cropped_view
from ..operators import OUTPUT_SCALE
from .grid import Grid

LUMA = (9798, 19235, 3735)  # ITU-R BT.601 in units of 2**-15, as in OpenCV


class Stack:
    """v views of one image size, each showing part of the object, on a device.

    mask, known (v, 1, h, w) boolean as in CroppedView; planes (v, 1 or 3, h, w) f4, integer levels 0..255 with
    silhouette and background filled, one plane if no view has a hue; boxes and corners (v, 2): of the crops in the
    views.
    """

    def __init__(self, views: Sequence[View], device: str | torch.device) -> None:
        crops = [cropped_view(view, False) for view in views]
        self.views, self.view_shape, self.device = views, crops[0].shape, torch.device(device)
        self.corners = np.array([[side.start for side in crop.box] for crop in crops])
        self.boxes = [crop.box for crop in crops]
        self.grid = Grid([crop.mask.shape for crop in crops], device)
        self.mask = self.upload([crop.mask for crop in crops])
        self.known = core(self.mask, max(round(SILHOUETTE_BAND * self.view_shape[0]), 1)) & self.grid.within(0)
        self.grey = all(crop.grey_only for crop in crops)
        rendered = [crop.rgb[..., : 1 if self.grey else 3].transpose(2, 0, 1) for crop in crops]
        self.planes = self.grid.fill(self.upload(rendered).float(), self.known).round()

    def upload(self, images: Sequence[np.ndarray], scale: int = 0) -> torch.Tensor:
        """(v, c, h, w) on the device from arrays (h', w') or (c, h', w'), one per view, at a scale of its crop."""
        images = [image.reshape(-1, *image.shape[-2:]) for image in images]
        stacked = np.zeros((len(images), len(images[0]), *self.grid.shape(scale)), images[0].dtype)
        for k, image in enumerate(images):
            stacked[k, :, : image.shape[1], : image.shape[2]] = image
        return torch.from_numpy(stacked).to(self.device)

    @cached_property
    def intensity(self) -> dict[int, torch.Tensor]:
        """{0..8: (v, 1, h, w) f4 in 0..1}."""
        mean = self.planes if self.grey else (self.planes * (1 / 3)).sum(1, keepdim=True)
        return self.grid.pyramid(mean / 255, 0, 8)

    @cached_property
    def luminance(self) -> torch.Tensor:
        """(v, 1, h, w) f4, integer levels 0..255."""
        if self.grey:
            return self.planes
        red, green, blue = (self.planes.int() * torch.tensor(LUMA, device=self.device)[:, None, None]).unbind(1)
        return ((red + green + blue + 2**14) >> 15).float()[:, None]

    @cached_property
    def cover(self) -> dict[int, torch.Tensor]:
        """{0..4: (v, 1, h, w) boolean}: where the object is, at each scale."""
        shares = self.grid.pyramid(self.mask.float(), 0, OUTPUT_SCALE)
        return {scale: (share > COVERED) & self.grid.within(scale) for scale, share in shares.items()}


def core(mask: torch.Tensor, band: int) -> torch.Tensor:
    """stages.conspicuity.cropped_view.core of masks (v, 1, h, w) boolean. Counts are exact at any precision."""
    disc = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (2 * band + 1, 2 * band + 1)).astype(np.float32)
    disc = torch.from_numpy(disc)[None, None].to(mask.device)
    inner = functional.conv2d(mask.float(), disc, padding=band) > disc.sum() - 0.5
    thick = functional.conv2d(inner.float(), disc, padding=band).clamp(max=1)
    thick = functional.max_pool2d((thick > 0.5).float(), 3, 1, 1) > 0.5
    return inner | (mask & ~thick)
