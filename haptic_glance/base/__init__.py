"""What the whole library shares: optional packages, downloads, files, compiled kernels, random numbers, errors."""
