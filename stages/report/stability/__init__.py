"""Where methods break: under which perturbation, and how much of it; and where the time went."""

from . import claims, growth, kernels, people, points, simplification, time_spent, touch, touch_imprints, transfer

TABLES = {
    "stability": points.table,
    "stability_people": people.table,
    "stability_simplification": simplification.table,
    "touch_stability": touch.table,
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
    "growth": growth.build,
}
CHARTS = {}
CLAIMS = claims.CLAIMS
