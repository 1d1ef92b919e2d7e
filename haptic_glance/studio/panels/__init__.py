"""What can be done with the mesh on the table: a panel a file, in the order in which they are offered."""

from .levels import LevelsPanel
from .look import LookPanel
from .mark import MarkPanel

PANELS = (LookPanel, LevelsPanel, MarkPanel)
