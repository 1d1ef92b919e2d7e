"""One glance by touch: which points, classifiers and imprints make simulated touch recognisable (T4.2)."""

from functools import partial

from stages.report.results import SECTION_4_2
from stages.report.words import as_printed

from . import claims, imprints, pictures, similar, touches

TABLES = {
    "recognition": touches.recognition,
    "table_4_1": touches.table_4_1,
    "table_4_2": touches.table_4_2,
    "table_4_3": similar.table_4_3,
    "table_4_5": touches.table_4_5,
    "table_4_6": touches.table_4_6,
    "section_4_2_4": similar.section_4_2_4,
    "imprint_rates": imprints.table,
}
FIGURES = {
    "pipeline": pictures.pipeline,
    "touch_one_mesh": pictures.touch_one_mesh,
    "imprints": pictures.imprints,
    "table_4_1": touches.figure_4_1,
    "figure_4_4": partial(as_printed, similar.figure_4_4, SECTION_4_2),
}
CHARTS = {
    "touch": claims.by_classifier,
    "touches": claims.by_features,
    "saliency": claims.by_saliency,
    "imprints": imprints.chart,
}
CLAIMS = claims.CLAIMS
