"""The figures of the report: each module has build(results) -> Figure; a new file here is a new figure."""
