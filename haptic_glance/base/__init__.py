"""Shared parts of the library: optional packages, downloads, files, compiled kernels, random numbers, errors."""
