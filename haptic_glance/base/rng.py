"""Random numbers that depend on the seed and the item's name alone, never on order or workers."""

import zlib

import numpy as np


def rng(seed: int, name: object) -> np.random.Generator:
    """A generator for one named item; ValueError for a negative seed."""
    if seed < 0:
        raise ValueError(f"seed {seed} is negative: give 0 or more")
    return np.random.default_rng([seed, zlib.crc32(str(name).encode("utf-8"))])
