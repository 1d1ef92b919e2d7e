"""The stability of methods: the perturbation and severity at which each breaks; and the time of each kernel.

The claims are on a denoising autoencoder before recognition by touch (T6.3), and on the stability of attention.
"""

from . import breaking, costs, people, score, simplification, touch

TABLES = {
    "stability_score": score.table,
    "stability_breaking": score.breaking,
    "stability_pairs": people.pairs_table,
    "stability": breaking.points_table,
    "stability_people": people.people_table,
    "stability_simplification": simplification.table,
    "touch_stability": touch.table,
    "transfer_stability": breaking.networks_table,
}
FIGURES = {
    "stability": breaking.points_figure,
    "stability_failures": breaking.failures,
    "touch_stability": touch.figure,
    "touch_stability_imprints": touch.build,
    "transfer_stability": breaking.networks_figure,
    "kernels": costs.kernels,
}
CHARTS = {"stability": score.chart}

PLAIN, LEARNED, FILTERED = (f"{touch.PLAIN}{denoiser}" for denoiser in ("", "_autoencoder", "_median"))
