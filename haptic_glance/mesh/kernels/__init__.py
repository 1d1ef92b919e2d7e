"""The inner loops of the search for the nearest point of a surface: compiled kernels on plain arrays."""
