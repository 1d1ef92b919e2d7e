"""The inner loops of simplification and of its error measures: compiled kernels on plain arrays."""
