"""One glance by touch: which points, classifiers and imprints make simulated touch recognisable (T4.2)."""

from functools import partial

from stages.charts.datasets import SECTION_4_2
from stages.charts.items import as_printed

from . import recognition_charts, recognition_tables, touch_pictures

PAGE = "touch"
TABLES = {
    "recognition": recognition_tables.recognition,
    "table_4_1": recognition_tables.table_4_1,
    "table_4_2": recognition_tables.table_4_2,
    "table_4_3": recognition_tables.table_4_3,
    "table_4_5": recognition_tables.table_4_5,
    "table_4_6": recognition_tables.table_4_6,
    "section_4_2_4": recognition_tables.section_4_2_4,
}
FIGURES = {
    "pipeline": touch_pictures.pipeline,
    "touch_one_mesh": touch_pictures.touch_one_mesh,
    "imprints": touch_pictures.imprints,
    "table_4_1": touch_pictures.figure_4_1,
    "figure_4_4": partial(as_printed, touch_pictures.figure_4_4, SECTION_4_2),
}
CHARTS = {
    "touch": recognition_charts.by_classifier,
    "saliency": recognition_charts.by_saliency,
}
