"""Disturbances of pictures and imprints, by name and severity."""
