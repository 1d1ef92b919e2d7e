"""The inner loops of the pressure array: compiled kernels on plain arrays."""
