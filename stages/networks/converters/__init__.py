"""Conversions of published weight files, one per file, to the weights of the architectures here."""
