"""The file of one object's attention."""

from stages.kit.files import read_arrays


def read_attention(path):
    """dict METHOD.TASK -> (n,) f2 attention at the vertices in 0..1, of data/fixation/NAME.npz.

    The file also has METHOD.TASK.views (3, n): the three views apart; METHOD.maps (3, t, i, j): their Grad-CAM maps in
    the order of the tasks of tasks.csv; visible (3, n): what each of the three sees; seen (n,): what any view sees.
    """
    stored = read_arrays(path)
    return {key: values for key, values in stored.items() if values.ndim == 1 and "." in key}
