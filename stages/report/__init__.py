"""Report: tables beside the thesis's, claims, figures, charts of accuracy against cost, and the web page."""

from dataclasses import dataclass

from stages.engine.settings import setting


@dataclass
class Params:
    """The objects that the pictures and the page show; names that the data set lacks are passed over."""

    hero_object: str = setting("duck", "the object of figures/pipeline.png")
    figure_objects: list[str] = setting(
        ["elephant", "stanfordbunny", "hand", "cup", "eyeglasses", "airplane"],
        "of the other figures; missing: skipped",
    )
    viewer_objects: list[str] = setting(
        [
            "stanfordbunny",
            "elephant",
            "hand",
            "duck",
            "cup",
            "eyeglasses",
            "airplane",
            "teapot",
            "piggybank",
            "camera",
            "wineglass",
            "headphones",
        ],
        "rotatable meshes of the page, in this order; other meshes follow alphabetically",
    )
    viewer_count: int = setting(12, "how many meshes the page carries at most", least=1)
    viewer_faces: int = setting(
        12000,
        "a larger mesh is shown simplified to this many faces, 21,845 at most",
        least=1,
    )
    viewer_lod_methods: list[str] = setting(["qem", "glance"], "simplifications that the page's slider goes through")
    viewer_kilobytes: int = setting(640, "room for all mesh data in the page; objects that do not fit are left out")
