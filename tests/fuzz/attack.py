"""Reads damaged files under limits of time and memory: `python -m tests.fuzz.attack FOLDER SECONDS READER ...`

Prints a line for every file that breaks the rule: it is read, or refused by a ValueError or a FetchError that names it.
SECONDS of the processor are shared equally by the readers. The file that is being read lies in FOLDER, so that one that
kills the process is found there.

Damages are flipped bits, cuts, swapped parts, noise, lies in headers, huge counts and deep nesting.
"""

import itertools
import logging
import re
import resource
import signal
import sys
import time
import warnings
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

import numpy as np

from haptic_glance.base.fetch import FetchError

from .readers import READERS, Reader

SECONDS = 5  # of the processor, of one file
RATE = 75  # files a second of the budget, at most: a small budget tries the same files on every fast machine
MEMORY = 2**29  # bytes that reading one file may take
CLAIMED = "fits in memory"  # a refusal by the parser's MemoryError, which comes too late where memory is overcommitted


class TooSlow(BaseException):
    """Not an Exception, which a parser would catch."""


def attack(name: str, folder: Path, seconds: float) -> Iterator[str]:
    """Yields what is wrong with the reading of damaged files, until so many seconds of the processor are over."""
    reader = READERS[name]
    seeds = reader.seeds(folder)
    end = time.process_time() + seconds
    for number in itertools.takewhile(lambda _: time.process_time() < end, range(round(RATE * seconds))):
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


SEED = 16
HEADER = 400  # bytes at the beginning, where a lie does most
LIES = (b"4294967295", b"-1", b"0", b"99999999999999999999", b"1e308", b"nan", b"2147483648", b"", b"x", b"7 7 7")
VALUES = (-1, 2**31 - 1, 10**6, 0)
WORDS = [value.to_bytes(size, order, signed=True) for order in ("little", "big") for size in (4, 8) for value in VALUES]
NESTS = (b"[" * 60_000, b'{"a":' * 20_000, b"- " * 3_000, b"(" * 5_000)


def damaged(seeds: Sequence[bytes], number: int) -> bytes:
    """The damaged copy of that number of one of the seeds in turn: one to three damages, the same on every machine.

    Half of the copies only lie, in text where the seed is one: other damages seldom get past the first check.
    """
    random = np.random.default_rng([SEED, number])
    content = seeds[number % len(seeds)]
    lie = _lie_in_bytes if 0 in content else _lie_in_text
    kinds = DAMAGES if random.random() < 0.5 else (lie,)
    for _ in range(random.integers(1, 4)):
        content = kinds[random.integers(len(kinds))](content, random)
    return content


def _flip(content, random):
    bits = np.frombuffer(content, dtype=np.uint8).copy()
    at = random.integers(0, max(len(bits), 1), random.integers(1, 9)) if len(bits) else []
    bits[at] ^= 1 << random.integers(0, 8, len(at)).astype(np.uint8)
    return bits.tobytes()


def _cut_end(content, random):
    return content[: random.integers(0, len(content) + 1)]


def _swap(content, random):
    a, b = _span(content, random)
    return content[b:] + content[a:b] + content[:a]


def _noise(content, random):
    a, b = _span(content, random, 40)
    return content[:a] + random.bytes(b - a) + content[b:]


def _lie_in_text(content, random):
    """Another number in place of one that is written as text, mostly of the header."""
    reach = HEADER if random.random() < 0.7 else len(content)
    numbers = list(re.finditer(rb"-?\d+(\.\d+)?", content[:reach]))
    if not numbers:
        return content
    number = numbers[random.integers(len(numbers))]
    return content[: number.start()] + LIES[random.integers(len(LIES))] + content[number.end() :]


def _lie_in_bytes(content, random):
    """A huge, negative or zero integer of four or eight bytes, mostly in the header."""
    reach = min(HEADER if random.random() < 0.7 else len(content), len(content))
    at, word = int(random.integers(0, reach + 1)), WORDS[random.integers(len(WORDS))]
    return content[:at] + word + content[at + len(word) :]


def _nest(content, random):
    if random.random() < 0.8:  # large, so rare
        return _flip(content, random)
    at = int(random.integers(0, len(content) + 1))
    return content[:at] + NESTS[random.integers(len(NESTS))] + content[at:]


def _span(content, random, longest=None):
    a, b = sorted(int(end) for end in random.integers(0, len(content) + 1, 2))
    return a, min(b, a + longest) if longest else b


DAMAGES: tuple[Callable[[bytes, np.random.Generator], bytes], ...] = (
    _flip, _cut_end, _swap, _noise, _lie_in_text, _lie_in_bytes, _nest,
)  # fmt: skip


def main() -> None:
    """Attacks the readers that the command line names; the exit status tells of no fault, only of a crash."""
    warnings.simplefilter("ignore")
    logging.disable()
    folder, budget, *names = sys.argv[1:]
    for name in names:
        subfolder, start = Path(folder, name), time.process_time()
        subfolder.mkdir()
        for fault in attack(name, subfolder, float(budget) / len(names)):
            print(fault, flush=True)
        print(name, f"{time.process_time() - start:.1f}", file=sys.stderr)


if __name__ == "__main__":
    main()
