"""Finds the fewest faces of every object of a scene along a camera path."""
