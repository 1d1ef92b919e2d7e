"""Published weights: equal ones, those of T table 3.1, and those learned from human gaze."""

import functools
from collections.abc import Callable

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


GLANCE = "glance"  # the default method


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


# Of the features of stages.glance, learned from 32 people's gaze on the 19 meshes of the data set `gaze` and on the 14
# point clouds of `gaze_clouds`. The features without an up axis are a model of their own, for what lies in any pose.
GLANCES = {
    "glance": {
        "rank": 0.44, "middle": 0.309, "upward": 0.128, "upward_high": -0.344, "seen": 0.08, "above": 0.019,
        "above_high": 0.004, "below": -0.06, "log_below": 0.178, "log_side": 0.612, "convexity": 0.601,
        "detail": -0.013, "relief": 0.066, "fullness_0.12": -0.036, "fullness_0.24": 0.226, "distance": -0.031,
        "distance_squared": 0.131, "outward": 0.199, "off_plane": -0.212, "on_plane": 0.097,
    },
    "glance_any_pose": {
        "seen": 0.441, "convexity": 0.627, "detail": -0.016, "relief": 0.007, "fullness_0.12": -0.035,
        "fullness_0.24": 0.334, "distance": -0.101, "distance_squared": 0.106, "outward": 0.147,
    },
}  # fmt: skip


# Of the features of stages.glance and of the maps of a network (stages.salient_points.deep), learned from the same gaze
# by benchmarks/deep_gaze.py. They are not in METHODS, since the stage `weights` does not learn them.
MAP_WEIGHTS = (
    0.015, 0.018, 0.027, -0.011, 0.053, -0.034, -0.042, -0.023, 0.027, 0, -0.025, 0.03, 0.051, -0.022, 0.013,
    -0.012, -0.028, -0.03, -0.015, 0, 0.007, -0.002, 0.015, -0.028, 0.009, 0.007, -0.039, 0, 0.003, -0.027, -0.013,
    0.031, -0.031, 0.004, 0.001, -0.041, -0.018, -0.022, 0.033, -0.014, -0.055, 0, 0.033, -0.024, -0.042, 0, -0.042,
    -0.012, 0.051, -0.03, 0.046, -0.014, 0.02, -0.011, 0.001, 0.026, -0.008, 0.008, -0.002, -0.007, -0.002, -0.022,
    0.029, 0.011, 0.005, 0.02, -0.013, 0.025, -0.01, 0.023, 0.027, 0.041, -0.012, -0.023, 0.018, -0.02, -0.015,
    -0.037, -0.021, 0.069, -0.041, -0.002, -0.005, 0.006, 0.006, 0.011, 0.01, -0.022, -0.014, -0.002, 0.015, -0.027,
    0.01, -0.006, 0.026, -0.017,
)  # fmt: skip
MAPS = tuple(f"map_{k}" for k in range(len(MAP_WEIGHTS)))
DEEP = {
    "glance_deep": {
        "rank": 0.338, "middle": 0.277, "upward": 0.12, "upward_high": -0.277, "seen": 0.073, "above": 0.035,
        "above_high": 0.036, "below": -0.053, "log_below": 0.159, "log_side": 0.571, "convexity": 0.64,
        "detail": -0.049, "relief": 0.108, "fullness_0.12": -0.062, "fullness_0.24": 0.176, "distance": -0.049,
        "distance_squared": 0.074, "outward": 0.141, "off_plane": -0.164, "on_plane": 0.124,
        **dict(zip(MAPS, MAP_WEIGHTS, strict=True)),
    },
}  # fmt: skip


METHODS: dict[str, Callable[[], dict[str, float]]] = {
    "equal": equal, "thesis_ssim": thesis_ssim, "thesis_ed": thesis_ed,
    **{name: functools.partial(dict, found) for name, found in GLANCES.items()},
}  # fmt: skip


def weights(method: str) -> dict[str, float]:
    """The weight of each channel by a method of METHODS: dict channel -> weight, not normalised.

    The methods give weights of all nine channels, for T eq. 3.9, which divides by their sum; GLANCES give those of the
    features of stages.glance. Raises ValueError for an unknown method.
    """
    if method not in METHODS:
        raise ValueError(f"unknown weights {method!r}: choose one of {', '.join(METHODS)}")
    return METHODS[method]()
