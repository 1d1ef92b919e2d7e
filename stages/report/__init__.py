"""Report: tables beside the thesis's, claims, figures, charts of accuracy against cost, and the web page."""

from dataclasses import dataclass


@dataclass
class Params:
    """The objects that the pictures and the page show; names that the data set lacks are passed over."""

    hero_object: str
    figure_objects: list[str]
    viewer_objects: list[str]
    viewer_count: int
    viewer_faces: int
    viewer_lod_methods: list[str]
    viewer_kilobytes: int
