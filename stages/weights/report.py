"""Channel weights and SVMs learned from people, beside the thesis's (T table 3.1, T3.2.3)."""

from . import weight_tables

PAGE = "attention"
TABLES = {
    "table_3_1": weight_tables.table_3_1,
    "section_3_2_3": weight_tables.section_3_2_3,
}
FIGURES = {}
CHARTS = {}
