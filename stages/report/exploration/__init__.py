"""Several touches: how many it takes, where to touch next, and whether a stated belief is right."""

from . import exploration

TABLES = {"exploration": exploration.build}
FIGURES = {"exploration_calibration": exploration.calibration}
CHARTS = {"exploration": exploration.exploration}
CLAIMS = exploration.CLAIMS
