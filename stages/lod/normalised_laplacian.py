"""The difference of two pictures after local mean subtraction and contrast gain control (T3.1.4).

Each value of the Laplacian pyramid is divided by a constant and a weighted sum of its neighbours' sizes, before
`laplacian.band_distance` (NLPD). Gain control gives a difference on a dark or even background a higher weight than one
among strong contrasts. Pixels beyond the frame count as zero in the gain.

Source: Laparra, Balle, Berardino and Simoncelli 2016 (T [225]), as in plenoptic 1.2.0 (Duong et al. 2023), whose scores
the tests check, without its 1e-10 under the root, so that equal pictures are at 0. The authors' program turns the small
asymmetric filters by 180 degrees where plenoptic does not.
"""

from collections.abc import Sequence

import cv2
import numpy as np

# Weights of the neighbours (up, left, right, down; beyond right in the first band) in a pixel's gain, and the constants
# beside them, band by band: fitted by the authors to undistorted photographs; the table of their own program.
NEIGHBOURS = (
    (0.1011, 0.1493, 0.1460, 0.1015, 0.0072),
    (0.0757, 0.1986, 0.1846, 0.0837, 0.0),
    (0.0477, 0.2138, 0.2243, 0.0467, 0.0),
    (0.0, 0.2503, 0.2616, 0.0, 0.0),
    (0.0, 0.2598, 0.2552, 0.0, 0.0),
    (0.0, 0.2215, 0.0717, 0.0, 0.0),
)
CONSTANTS = (0.0248, 0.0185, 0.0179, 0.0191, 0.0220, 0.2782)


def normalise(bands: Sequence[np.ndarray]) -> list[np.ndarray]:
    """The six bands after gain control."""
    return [
        band / cv2.filter2D(np.abs(band), -1, kernel, delta=constant, borderType=cv2.BORDER_CONSTANT)
        for band, kernel, constant in zip(bands, KERNELS, CONSTANTS, strict=True)
    ]


def _kernel(up, left, right, down, beyond):
    kernel = np.zeros((5, 5))
    kernel[1, 2], kernel[2, 1], kernel[2, 3], kernel[3, 2], kernel[2, 4] = up, left, right, down, beyond
    return kernel


KERNELS = [_kernel(*weights) for weights in NEIGHBOURS]
