"""Rows, tables, cells and drawing that the report of every stage uses; it imports no stage."""
