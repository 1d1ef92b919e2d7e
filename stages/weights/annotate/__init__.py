"""The files of the points that people mark on a mesh, in the studio (`haptic-glance studio --mark`)."""

from .marks import MarksChanged, MarksError, check_on_mesh, read_marks, write_marks

__all__ = ["MarksChanged", "MarksError", "check_on_mesh", "read_marks", "write_marks"]
