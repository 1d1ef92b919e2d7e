"""Timings of the pipeline and its parts; each writes a table below reports/bench."""
