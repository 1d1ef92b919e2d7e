"""What the pressure array does a million times a second: compiled kernels on plain arrays."""
