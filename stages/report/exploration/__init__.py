"""Several touches: how many it takes, where to touch next, and whether a stated belief is right."""

from . import charts, claims, exploration

TABLES = {"exploration": exploration.build}
FIGURES = {"exploration_calibration": charts.calibration}
CHARTS = {"exploration": charts.exploration}
CLAIMS = claims.CLAIMS
