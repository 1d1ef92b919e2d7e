"""Stability: what each method still finds when the mesh, the light or the image changes, and where it breaks."""

from collections.abc import Container
from dataclasses import dataclass

from stages.engine.settings import setting
from stages.salient_points import method_names

COLUMNS = {
    "perturbation": "how the object, the light or the image was disturbed; none: as it is",
    "severity": "how much, in the perturbation's unit",
}


def perturbation_names() -> Container[str]:
    """Disturbances of objects, light and pictures."""
    from haptic_glance.disturb.objects import PERTURBATIONS

    return PERTURBATIONS


@dataclass
class Params:
    """Section `stability` of params.yaml."""

    objects: list[str] = setting(
        ["elephant", "hand", "cup", "eyeglasses"],
        "objects to disturb; the first objects of the set if it has none of these",
    )
    most: int = setting(4, "how many objects at most", least=1)
    methods: list[str] = setting(
        ["glance", "glance_any_pose", "itti", "thesis_ssim", "mesh_saliency", "harris", "random"],
        "names of METHODS in haptic_glance/look/points/methods.py",
        names=method_names,
    )
    count: int = setting(
        30,
        "points an object and method: the same number for all, since chance hits grow with it",
        least=1,
    )
    size: list[int] = setting(
        [450, 600],
        "rows, columns of the views: half the thesis's, a fourth of the time",
        least=1,
    )
    perturbations: list[str] = setting(
        [
            "noise",
            "decimation",
            "remeshing",
            "missing_faces",
            "scan",
            "vertex_order",
            "winding",
            "turn",
            "tilt",
            "scale",
            "light",
            "background",
            "background_left_in",
            "paint",
            "pattern",
            "image_size",
        ],
        "names of haptic_glance.disturb.objects.PERTURBATIONS",
        names=perturbation_names,
    )
    severities: dict[str, list[float]] = setting(
        {
            "noise": [0.001, 0.0025, 0.005, 0.01],  # sigma, share of the diagonal
            "decimation": [0.5, 0.25, 0.1],  # share of the faces kept
            "remeshing": [0.02, 0.04],  # edge length, share of the diagonal
            "missing_faces": [0.02, 0.05, 0.1],  # share of the faces
            "scan": [90.0, 180.0, 360.0],  # degrees between the depth cameras around the object: four, two, one
            "vertex_order": [1.0],  # share of the vertices
            "winding": [0.5, 1.0],  # share of the faces
            "turn": [5.0, 15.0, 45.0],  # degrees about the vertical
            "tilt": [15.0, 45.0, 90.0],  # degrees about a level axis
            "scale": [1000.0],  # factor
            "light": [15.0, 30.0, 60.0],  # degrees off the camera
            "background": [1.0],  # brightness, kept out of the maps
            "background_left_in": [0.0, 0.5, 1.0],  # brightness, black, grey, white
            "paint": [0.5, 1.0],  # saturation
            "pattern": [0.25, 1.0],  # saturation
            "grey": [1.0],  # share of the hue taken away, of objects that have colours
            "clay": [1.0],  # share of the colour taken away, brightness included
            "image_size": [0.75, 0.5, 0.33],  # share of the rows
        },
        "of each perturbation, in its own unit, from mild to harsh",
        names=perturbation_names,
    )
