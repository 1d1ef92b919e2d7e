"""A local web page on which a person marks interest points of a mesh, and the files of these marks."""

from .marks import MarksChanged, MarksError, check_on_mesh, read_marks, write_marks
from .server import open_server

__all__ = ["MarksChanged", "MarksError", "check_on_mesh", "open_server", "read_marks", "write_marks"]
