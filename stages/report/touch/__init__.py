"""One glance by touch: which points, classifiers and imprints make simulated touch recognisable (T4.2)."""

from functools import partial

from stages.charts.datasets import SECTION_4_2
from stages.charts.items import as_printed

from . import claims, pictures, tables

TABLES = {
    "recognition": tables.recognition,
    "table_4_1": tables.table_4_1,
    "table_4_2": tables.table_4_2,
    "table_4_3": tables.table_4_3,
    "table_4_5": tables.table_4_5,
    "table_4_6": tables.table_4_6,
    "section_4_2_4": tables.section_4_2_4,
}
FIGURES = {
    "pipeline": pictures.pipeline,
    "touch_one_mesh": pictures.touch_one_mesh,
    "imprints": pictures.imprints,
    "table_4_1": pictures.figure_4_1,
    "figure_4_4": partial(as_printed, pictures.figure_4_4, SECTION_4_2),
}
CHARTS = {
    "touch": claims.by_classifier,
    "touches": claims.by_features,
    "saliency": claims.by_saliency,
}
