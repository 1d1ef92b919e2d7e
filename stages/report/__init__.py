"""Report: tables beside the thesis's, claims, figures, charts of accuracy against cost, and the web page."""

from dataclasses import dataclass


@dataclass
class Params:
    """What the pictures and the page show; names that the data set lacks are passed over."""

    hero_object: str  # the object of figures/pipeline.png
    figure_objects: list[str]  # the objects of the other figures, in this order
    viewer_objects: list[str]  # the turnable meshes of the page, in this order; others follow by the alphabet
    viewer_count: int  # how many meshes the page carries at most
    viewer_faces: int  # a larger mesh is shown simplified to this many faces
    viewer_lod_methods: list[str]  # simplifications that the page's slider goes through
    viewer_kilobytes: int  # room for all mesh data in the page; objects that do not fit are left out
