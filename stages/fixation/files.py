"""The file of one object's attention."""

from pathlib import Path

import numpy as np

from stages.kit.files import read_arrays


def read_attention(path: str | Path) -> dict[str, np.ndarray]:
    """dict METHOD.TASK -> (n,) f2 attention at the vertices in 0..1, of data/SET/fixation/NAME.npz.

    The file also has METHOD.TASK.views (3, n): the attention in each of the three evaluated views; METHOD.maps
    (3, t, i, j): their Grad-CAM maps in the order of the tasks in tasks.csv; visible (3, n): the vertices visible in
    each of them; seen (n,): the vertices visible in any view.
    """
    stored = read_arrays(path)
    return {key: values for key, values in stored.items() if values.ndim == 1 and "." in key}
