"""Simplifies every object of a data set to several sizes and measures the errors."""
