"""The tables of the report: each module has build(results) -> Table; a new file here is a new table."""
