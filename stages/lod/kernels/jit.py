"""Compiled kernels: numba, kept on disk between runs."""

import hashlib
from functools import partial
from pathlib import Path

import numba

from stages.kit.fetch import cache_folder

# numba renews a kept kernel when its own file changes, not when a kernel of another file that it calls does: so all
# kernels of this folder are kept under one digest of all its files.
_SOURCES = sorted(Path(__file__).parent.glob("*.py"))
_DIGEST = hashlib.sha256(b"".join(path.read_bytes() for path in _SOURCES)).hexdigest()[:12]
numba.config.CACHE_DIR = str(cache_folder() / "kernels" / _DIGEST)

# Inlined throughout: a call hands over seven words for each array, which took as long as the work. error_model: divides
# as numpy does, with no branch on zero.
kernel = partial(numba.njit, cache=True, nogil=True, error_model="numpy", forceinline=True)
inlined = numba.njit(inline="always", error_model="numpy")  # where a call costs as much as what it does
