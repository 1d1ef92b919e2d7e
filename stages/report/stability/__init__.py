"""Where methods break: under which perturbation, and how much of it; and where the time went."""

from . import (
    claims,
    kernels,
    leaderboard,
    pairs,
    people,
    points,
    simplification,
    time_spent,
    touch,
    touch_imprints,
    transfer,
    uses,
)

TABLES = {
    "stability_score": leaderboard.table,
    "stability_breaking": leaderboard.breaking,
    "stability_pairs": pairs.table,
    "stability_uses": uses.table,
    "stability": points.table,
    "stability_people": people.table,
    "stability_simplification": simplification.table,
    "touch_stability": touch.table,
    "touch_denoised": touch.denoised,
    "transfer_stability": transfer.table,
    "time_spent": time_spent.build,
}
FIGURES = {
    "stability": points.figure,
    "stability_failures": points.failures,
    "stability_simplification": simplification.figure,
    "touch_stability": touch.figure,
    "touch_stability_imprints": touch_imprints.build,
    "transfer_stability": transfer.figure,
    "kernels": kernels.build,
}
CHARTS = {"stability": leaderboard.chart}
CLAIMS = claims.CLAIMS
