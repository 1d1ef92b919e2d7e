"""Accuracy against cost: each module has build(results) -> Figure by pareto_chart; a new file is a new chart."""
