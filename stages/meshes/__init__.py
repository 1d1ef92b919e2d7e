"""Collects the meshes of a data set."""
