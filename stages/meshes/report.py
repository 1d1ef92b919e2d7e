"""The objects of a data set."""

from .object_table import objects_table

PAGE = "meshes"
TABLES = {
    "dataset": objects_table,
}
FIGURES = {}
CHARTS = {}
