"""One glance by touch: which points, classifiers and imprints make simulated touch recognisable (T4.2)."""

from . import (
    claims,
    costs,
    figure_4_4,
    imprint_rates,
    imprints,
    one_touch,
    pipeline,
    similar,
    table_4_6,
    touch_one_mesh,
)

TABLES = {
    "table_4_1": one_touch.table_4_1,
    "table_4_2": one_touch.table_4_2,
    "table_4_3": similar.table_4_3,
    "table_4_5": one_touch.table_4_5,
    "table_4_6": table_4_6.table_4_6,
    "section_4_2_4": similar.section_4_2_4,
    "imprint_rates": imprint_rates.table,
}
FIGURES = {
    "pipeline": pipeline.build,
    "touch_one_mesh": touch_one_mesh.build,
    "imprints": imprints.build,
    "table_4_1": one_touch.figure_4_1,
    "figure_4_4": figure_4_4.build,
}
CHARTS = {
    "touch": costs.by_classifier,
    "touches": costs.by_features,
    "saliency": costs.by_saliency,
    "imprints": imprint_rates.chart,
}
CLAIMS = claims.CLAIMS
