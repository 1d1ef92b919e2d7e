"""Published weights: equal ones, those of T table 3.1, and those learned from human gaze."""

# T table 3.1: channel -> (average SSIM over 43 models, one minus the average normalised Euclidean distance).
# In code rather than in a data file, so that they are available wherever the package is installed.
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


GLANCE = "glance"  # the method of the features of stages.glance
ENHANCED = "enhanced"  # the method whose weights are chosen by the setting weights.method


def equal() -> dict[str, float]:
    """One for every channel: the plain average (T eq. 3.8)."""
    return dict.fromkeys(TABLE, 1.0)


def thesis_ssim() -> dict[str, float]:
    """Similarity of each channel's map to that of the ground truth (T3.2.1.2 and T3.2.1.4)."""
    return {channel: ssim for channel, (ssim, _) in TABLE.items()}


def thesis_ed() -> dict[str, float]:
    """One minus the distance of each channel's brightest pixels from the ground truth (T3.2.1.1).

    The text calls this column a value "for a selected viewpoint from model of skull", the caption an average over 43
    models. T3.2.2 agrees with the caption, so this is taken as the average.
    """
    return {channel: nearness for channel, (_, nearness) in TABLE.items()}


# Of the fixation model (stages.weights.fixations), learned from 32 people's gaze on 19 meshes, the data set `gaze`.
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


# Of the features of stages.glance, learned from the gaze on these meshes and on 14 point clouds, `gaze_clouds`.
GLANCE_WEIGHTS = {
    "rank": 0.475,
    "middle": 0.279,
    "upward": 0.124,
    "upward_high": -0.305,
    "seen": 0.065,
    "above": -0.097,
    "above_high": -0.052,
    "below": -0.12,
    "log_below": 0.157,
    "log_side": 0.589,
    "convexity": 0.631,
    "detail": -0.03,
    "relief": 0.08,
    "fullness_0.12": 0.06,
    "fullness_0.24": 0.151,
    "distance": -0.043,
    "distance_squared": 0.106,
    "outward": 0.223,
    "off_plane": -0.153,
    "on_plane": 0.123,
}


def gaze() -> dict[str, float]:
    """Weights of the features in a log-linear density of fixations: for `enhanced`, not for T eq. 3.9."""
    return dict(GAZE)


def glance() -> dict[str, float]:
    """Weights of the features of stages.glance, in a log-linear density of fixations."""
    return dict(GLANCE_WEIGHTS)


METHODS = {"equal": equal, "thesis_ssim": thesis_ssim, "thesis_ed": thesis_ed, "gaze": gaze, GLANCE: glance}


def weights(method: str) -> dict[str, float]:
    """The weight of each channel by a method of METHODS: dict channel -> weight, not normalised.

    The methods give weights of all nine channels, for T eq. 3.9, which divides by their sum; `gaze` and `glance` give
    weights of the features of stages.weights.features and of stages.glance. Raises ValueError for an unknown method.
    """
    if method not in METHODS:
        raise ValueError(f"unknown weights {method!r}: choose one of {', '.join(METHODS)}")
    return METHODS[method]()
