"""The weights that need no learning: equal ones, and those of T table 3.1."""

# T table 3.1: channel -> (average SSIM over 43 models, one minus the average normalised Euclidean distance).
# They stand here and not in a file beside the package, so that they are there wherever the package is installed.
TABLE = {
    "color": (0.1096, 0.6417),
    "contrast": (0.7692, 0.3941),
    "curvature": (0.7536, 0.7929),
    "dkl": (0.6389, 0.7098),
    "edge": (0.7264, 0.5651),
    "entropy": (0.8914, 0.7879),
    "intensity": (0.6274, 0.4487),
    "orientation": (0.4596, 0.6773),
    "symmetry": (0.7235, 0.4970),
}


ENHANCED = "enhanced"  # the method whose weights are a choice of the settings


def equal():
    """One for every channel: the plain average (T eq. 3.8)."""
    return dict.fromkeys(TABLE, 1.0)


def thesis_ssim():
    """Similarity of each channel's map to the ground truth's (T3.2.1.2 and T3.2.1.4)."""
    return {channel: ssim for channel, (ssim, _) in TABLE.items()}


def thesis_ed():
    """One minus the distance of each channel's brightest pixels from the ground truth (T3.2.1.1).

    The text calls this column a value "for a selected viewpoint from model of skull", the caption an average over 43
    models. Table 3.1's caption and T3.2.2 agree with each other, so the average is what is meant here.
    """
    return {channel: nearness for channel, (_, nearness) in TABLE.items()}


# Of the fixation model (stages.weights.fixations), learned from the gaze of 32 people on 19 meshes by `make gaze`.
GAZE = {
    "symmetry": 0.23,
    "height": 0.35,
    "height_squared": -0.393,
    "upright": -0.247,
    "sideways": 0.409,
    "visible": 0.209,
    "convexity": 0.521,
    "detail": 0.336,
}


def gaze():
    """What draws the eye in a log-linear density of looks, feature by feature: not for eq. 3.9 but for `enhanced`."""
    return dict(GAZE)


METHODS = {"equal": equal, "thesis_ssim": thesis_ssim, "thesis_ed": thesis_ed, "gaze": gaze}


def weights(method):
    """The weight of each channel by one method: dict channel -> weight, not normalised.

    All nine channels, for eq. 3.9, which divides by their sum; of `gaze` the features of stages.weights.features.
    Raises ValueError for a method that METHODS does not have.
    """
    if method not in METHODS:
        raise ValueError(f"unknown weights {method!r}: choose one of {', '.join(METHODS)}")
    return METHODS[method]()
