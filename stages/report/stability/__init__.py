"""Where methods break: under which perturbation, and how much of it; and where the time went."""

from . import (
    failures,
    points,
    points_figure,
    simplification,
    simplification_figure,
    time_spent,
    touch,
    touch_figure,
    touch_imprints,
    transfer,
    transfer_figure,
)

TABLES = {
    "stability": points.build,
    "stability_simplification": simplification.build,
    "touch_stability": touch.build,
    "transfer_stability": transfer.build,
    "time_spent": time_spent.build,
}
FIGURES = {
    "stability": points_figure.build,
    "stability_failures": failures.build,
    "stability_simplification": simplification_figure.build,
    "touch_stability": touch_figure.build,
    "touch_stability_imprints": touch_imprints.build,
    "transfer_stability": transfer_figure.build,
}
CHARTS = {}
CLAIMS = []
