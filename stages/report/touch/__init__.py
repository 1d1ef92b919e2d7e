"""One glance by touch: which points, classifiers and imprints make simulated touch recognisable (T4.2)."""

from functools import partial

from stages.report.kept import as_printed
from stages.report.results import SECTION_4_2

from . import claims, costs, imprint_rates, pictures, similar, touches

TABLES = {
    "table_4_1": touches.table_4_1,
    "table_4_2": touches.table_4_2,
    "table_4_3": similar.table_4_3,
    "table_4_5": touches.table_4_5,
    "table_4_6": touches.table_4_6,
    "section_4_2_4": similar.section_4_2_4,
    "imprint_rates": imprint_rates.table,
}
FIGURES = {
    "pipeline": pictures.pipeline,
    "touch_one_mesh": pictures.touch_one_mesh,
    "imprints": pictures.imprints,
    "table_4_1": touches.figure_4_1,
    "figure_4_4": partial(as_printed, similar.figure_4_4, SECTION_4_2),
}
CHARTS = {
    "touch": costs.by_classifier,
    "touches": costs.by_features,
    "saliency": costs.by_saliency,
    "imprints": imprint_rates.chart,
}
CLAIMS = claims.CLAIMS
