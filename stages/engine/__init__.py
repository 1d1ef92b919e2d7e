"""The engine of the pipeline: settings, rows, cache, statistics, parallel map."""
