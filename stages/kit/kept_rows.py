"""Rows of many items on the disk, not in memory, read again one item at a time."""

import itertools
import json
import tempfile
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any

Row = dict[str, Any]


class KeptRows(Sequence[Row]):
    """Rows in parts, one after the other; `+=` and `append` add to them. What a reader changes in a row is not kept."""

    def __init__(self, *parts: Sequence[Row]) -> None:
        self.parts = list(parts)

    def __iadd__(self, rows: Iterable[Row]) -> "KeptRows":
        self.parts.append(rows if isinstance(rows, KeptRows) else list(rows))
        return self

    def append(self, row: Row) -> None:
        """Adds one row."""
        self.parts.append([row])

    def __iter__(self) -> Iterator[Row]:
        return itertools.chain.from_iterable(self.parts)

    def __len__(self) -> int:
        return sum(map(len, self.parts))

    def __getitem__(self, place: Any) -> Any:
        return list(self)[place] if isinstance(place, slice) else next(itertools.islice(self, place, None))


class ItemRows(KeptRows):
    """The rows of items, put in any order and read in that of the names; in a file that ends with this object."""

    def __init__(self, folder: Path, names: Iterable[str]) -> None:
        super().__init__()
        self._file = tempfile.TemporaryFile(dir=folder)  # noqa: SIM115 (read after the run, too)
        self._places: dict[str, tuple[int, int]] = dict.fromkeys(names, (-1, 0))  # where a line starts, its rows

    def put(self, name: str, rows: Sequence[Row]) -> None:
        """Keeps the rows of an item."""
        self._places[name] = self._file.seek(0, 2), len(rows)
        self._file.write(json.dumps(rows).encode() + b"\n")

    def __iter__(self) -> Iterator[Row]:
        for start, _ in self._places.values():
            if start >= 0:
                self._file.seek(start)
                yield from json.loads(self._file.readline())

    def __len__(self) -> int:
        return sum(count for _, count in self._places.values())
