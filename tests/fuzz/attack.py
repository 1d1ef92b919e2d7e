"""Reads damaged files under limits of time and memory: `python -m tests.fuzz.attack FOLDER READER ...`

Prints a line for every file that breaks the rule: it is read, or refused by a ValueError or a FetchError that names it.
The file that is being read lies in FOLDER, so that one that kills the process is found there.
"""

import logging
import re
import resource
import signal
import sys
import time
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from haptic_glance.base.fetch import FetchError

from .damage import damaged
from .readers import READERS, Reader

SECONDS = 5  # of the processor, of one file
MEMORY = 2**29  # bytes that reading one file may take
CLAIMED = "fits in memory"  # a refusal by the parser's MemoryError, which comes too late where memory is overcommitted


class TooSlow(BaseException):
    """Not an Exception, which a parser would catch."""


def attack(name: str, folder: Path, count: int) -> Iterator[str]:
    """Yields what is wrong with the reading of each of `count` damaged files."""
    reader = READERS[name]
    seeds = reader.seeds(folder)
    for number in range(count):
        fault = fault_of(reader, folder, damaged(seeds, number))
        if fault:
            yield f"{name} {number}: {fault}"


def fault_of(reader: Reader, folder: Path, content: bytes) -> str:
    """What is wrong with the reading of one file; "" where nothing is."""
    path = folder / reader.file
    path.write_bytes(content)
    try:
        with limits():
            reader.read(path)
    except (ValueError, FetchError) as error:
        if CLAIMED in str(error):
            return f"memory was asked for: {error}"
        if reader.names and not any(name in str(error) for name in (path.name, str(folder))):
            return f"the message does not name the file: {error}"
    except TooSlow:
        return f"not done in {SECONDS} s"
    except Exception as error:
        trace = error.__traceback__
        while trace.tb_next and re.search("/(stages|haptic_glance)/", trace.tb_next.tb_frame.f_code.co_filename):
            trace = trace.tb_next
        return f"{type(error).__name__} at {trace.tb_frame.f_code.co_filename}:{trace.tb_lineno}: {str(error)[:200]}"
    return ""


@contextmanager
def limits() -> Iterator[None]:
    """SECONDS and MEMORY for the block; the soft limit alone is lowered, so that it can be raised again."""
    soft, hard = resource.getrlimit(resource.RLIMIT_AS)
    pages = int(Path("/proc/self/statm").read_text().split()[0])
    handler = signal.signal(signal.SIGPROF, _stop)
    signal.setitimer(signal.ITIMER_PROF, SECONDS)
    resource.setrlimit(resource.RLIMIT_AS, (pages * resource.getpagesize() + MEMORY, hard))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_AS, (soft, hard))
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.signal(signal.SIGPROF, handler)


def _stop(*_):
    raise TooSlow


def main() -> None:
    """Attacks the readers that the command line names; the exit status tells of no fault, only of a crash."""
    warnings.simplefilter("ignore")
    logging.disable()
    folder, *names = sys.argv[1:]
    for name in names:
        subfolder, start = Path(folder, name), time.process_time()
        subfolder.mkdir()
        for fault in attack(name, subfolder, READERS[name].count):
            print(fault, flush=True)
        print(name, f"{time.process_time() - start:.1f}", file=sys.stderr)


if __name__ == "__main__":
    main()
