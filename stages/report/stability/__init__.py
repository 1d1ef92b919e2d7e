"""The stability of methods: the perturbation and severity at which each breaks; and the time of each stage."""

from . import claims, costs, people, points, score, simplification, touch, transfer

TABLES = {
    "stability_score": score.table,
    "stability_breaking": score.breaking,
    "stability_pairs": people.pairs_table,
    "stability_uses": people.uses,
    "stability": points.table,
    "stability_people": people.people_table,
    "stability_simplification": simplification.table,
    "touch_stability": touch.table,
    "touch_denoised": touch.denoised,
    "transfer_stability": transfer.table,
    "time_spent": costs.time_spent,
}
FIGURES = {
    "stability": points.figure,
    "stability_failures": points.failures,
    "stability_simplification": simplification.figure,
    "touch_stability": touch.figure,
    "touch_stability_imprints": touch.build,
    "transfer_stability": transfer.figure,
    "kernels": costs.kernels,
}
CHARTS = {"stability": score.chart}
CLAIMS = claims.CLAIMS
