"""How faithful the project is to the thesis: each section, formula, table and figure, and where it is done."""

from . import table

TABLES = {"fidelity": table.build}
FIGURES = {}
CHARTS = {}
CLAIMS = []
