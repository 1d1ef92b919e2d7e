"""A small local web page on which a person marks the points of a mesh that matter, and the files of such marks."""

from .marks import MarksChanged, MarksError, check_on_mesh, read_marks, write_marks
from .server import open_server

__all__ = ["MarksChanged", "MarksError", "check_on_mesh", "open_server", "read_marks", "write_marks"]
