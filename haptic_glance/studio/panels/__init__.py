"""The panels of the studio, one a file, in the order in which they are offered."""

from .know import KnowPanel
from .levels import LevelsPanel
from .look import LookPanel
from .mark import MarkPanel
from .touch import TouchPanel

PANELS = (LookPanel, LevelsPanel, TouchPanel, KnowPanel, MarkPanel)
