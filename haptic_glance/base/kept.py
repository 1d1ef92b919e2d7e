"""The folder of cached kernels, and which process compiles a kernel; does not import numba, which takes long."""

import hashlib
import os
import threading
import time
from pathlib import Path
from typing import IO

try:
    import fcntl
except ImportError:  # Windows: each process compiles for itself
    fcntl = None

beside = threading.Event()  # set where other processes compile for this one
PATIENCE = 60.0  # seconds: no kernel takes a tenth of that, so a process that holds one for longer hangs
# Files of this folder that decide the machine code of all kernels: helpers that kernels inline, and numba's passes.
SHARED = tuple(Path(__file__).with_name(name) for name in ("jit.py", "passes.py"))


def cache_folder() -> Path:
    """The folder of fetched files: HAPTIC_GLANCE_CACHE, or haptic-glance below the user's cache folder."""
    base = os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache"
    return Path(os.environ.get("HAPTIC_GLANCE_CACHE") or Path(base) / "haptic-glance")


def kept_in(file: str | Path) -> Path:
    """The folder in which the kernels of the folder of a file (`__file__`) are kept.

    numba renews a kept kernel when its own file changes, not when a kernel of another file that it calls does: so all
    kernels of a folder are kept under one digest of all its files, and of the files in SHARED.
    """
    sources = [*sorted(Path(file).parent.glob("*.py")), *SHARED]
    digest = hashlib.sha256(b"".join(path.read_bytes() for path in sources)).hexdigest()[:12]
    return cache_folder() / "kernels" / digest


def is_kept(file: str | Path, name: str) -> bool:
    """Whether machine code of a kernel of a file is kept, for any types."""
    return any(kept_in(file).glob(f"{Path(file).stem}.{name}-*.nbc"))


def marker(file: str | Path, name: str, folder: Path) -> Path:
    """The file that a process locks while it compiles a kernel of a file."""
    return folder / f"{Path(file).stem}.{name}.lock"


def claim(path: Path, patience: float = PATIENCE) -> IO[bytes] | None:
    """The marker of a kernel, open and locked: close it when the kernel is kept. None if another process has it.

    The operating system unlocks the file when its process ends, however it ends. patience: seconds to wait for it.
    """
    if fcntl is None:
        return None
    end = time.monotonic() + patience
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        file = path.open("wb")
        while True:
            try:
                fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
                return file
            except BlockingIOError:
                if time.monotonic() >= end:
                    break
                time.sleep(0.01)
        file.close()
    except OSError:  # a folder that is read-only, or a disk without locks
        pass
    return None
