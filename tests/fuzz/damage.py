"""Damaged copies of a file: flipped bits, cuts, swapped parts, noise, lies in headers, huge counts, deep nesting."""

import re
from collections.abc import Callable, Sequence

import numpy as np

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
