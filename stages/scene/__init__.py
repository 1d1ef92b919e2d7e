"""Finds the fewest faces of every object of a scene along a camera path."""

from dataclasses import dataclass

from stages.engine.settings import REQUIRED, setting

COLUMNS = {
    "kind": "what the tolerance is of: pixels or ssim",
    "tolerance": "the tolerated error of a frame",
    "factor": "the same over the scene's own tolerance",
    "matched": "the quantity in which a method equals ours, or asked; empty for a plan of its own",
    "frame": "the number of a frame, or all",
    "condition": "what the models of the face count are tested on",
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

    name: str = setting(REQUIRED, "of the scene, for the tables")
    objects: list[Item] = setting(REQUIRED, "what stands where")
    camera: list[Keyframe] = setting(REQUIRED, "where the camera goes, at equal times")
    frames: int = setting(REQUIRED, "frames along the path", least=1)
    screen: list[int] = setting(REQUIRED, "rows, columns of the screen in pixels", least=1)
    angle: float = setting(REQUIRED, "vertical view angle in degrees", above=0, most=180)
    tolerance: float = setting(
        REQUIRED,
        "of the error on the screen: pixels, or with kind ssim a share of the structure lost",
        above=0,
    )
    kind: str = setting(REQUIRED, "what the tolerance is of: pixels or ssim")
    limit: int = setting(0, "faces that all objects in view may have together; 0 for no limit", least=0)
    hold: int = setting(3, "frames that a level stays at least, so that nothing flickers", least=0)
    method: str = setting(
        "glance-soft",
        "how levels spare the salient places: a name of lod.methods, for example glance-soft",
    )
    factors: list[float] = setting(
        [0.5, 1.0, 2.0, 4.0],
        "multiples of the tolerance at which the chart of faces against error is measured",
        above=0,
    )
    msft_lod: bool = setting(True, "also write one GLB per object that holds all its levels (MSFT_lod)")
