"""Several touches: how many it takes, where to touch next, and whether a stated belief is right."""

from . import (
    calibration,
    claims,
    exploration,
    exploration_chart,
)

TABLES = {
    "exploration": exploration.build,
}
FIGURES = {
    "exploration_calibration": calibration.build,
}
CHARTS = {
    "exploration": exploration_chart.build,
}
CLAIMS = claims.CLAIMS
