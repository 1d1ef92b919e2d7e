"""Recorded touches: selection of imprints on a real pressure array (T4.2.4)."""

from .selection_table import table_4_4

PAGE = "recorded"
TABLES = {
    "table_4_4": table_4_4,
}
FIGURES = {}
CHARTS = {}
