"""Finds the fewest faces of every object of a scene along a camera path."""

from dataclasses import dataclass

COLUMNS = {
    "place": "the object's number in the scene",
    "kind": "what the tolerance is of: pixels or ssim",
    "tolerance": "the tolerated error of a frame",
    "factor": "the same over the scene's own tolerance",
    "matched": "the quantity in which a method equals ours, or asked; empty for a plan of its own",
    "frame": "the number of a frame, or all",
    "condition": "what the models of the face count are tested on",
    "setting": "the number of objects that they are trained on",
    "cases": "test cases of a model",
    "objects": "objects that the cases are of",
    "low": "the interval's lower end, 95 %",
    "high": "its upper end",
}


@dataclass
class Item:
    """One object of a scene."""

    name: str  # of an object in data/SET/meshes; what is not there is left out, or stood in for if none is, and said
    position: list[float]  # x, y, z in metres of the middle of its foot; +z is up
    turn: float  # degrees about +z, counter-clockwise seen from above
    size: float  # metres, the longest side of its bounding box


@dataclass
class Keyframe:
    """A place on the path of the camera."""

    eye: list[float]  # x, y, z in metres
    target: list[float]  # x, y, z in metres of what it looks at


@dataclass
class Params:
    """Section `scene` of params.yaml."""

    name: str  # of the scene, for the tables
    objects: list[Item]  # what stands where
    camera: list[Keyframe]  # where the camera goes, at equal times
    frames: int  # frames along the path
    screen: list[int]  # rows, columns of the screen in pixels
    angle: float  # vertical view angle in degrees
    tolerance: float  # of the error on the screen: pixels, or with kind ssim a share of the structure lost
    kind: str  # what the tolerance is of: pixels or ssim
    limit: int
    hold: int
    method: str
    factors: list[float]
    msft_lod: bool
