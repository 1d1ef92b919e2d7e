"""A level for each object in each frame: the faces, the errors of the rendered frames, and the switches."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from .frames import FrameError, Frames
from .lod_chain import Level


@dataclass(frozen=True, eq=False)
class Plan:
    """A level for each object in each frame: levels (f, o) i8 into chains, the LOD chain of each object."""

    levels: np.ndarray
    chains: Sequence[Sequence[Level]]
    frames: Frames

    @cached_property
    def faces(self) -> np.ndarray:
        """(f, o) faces of each object in each frame; 0 out of view."""
        counts = [[chain[k].faces for k, chain in zip(row, self.chains, strict=True)] for row in self.levels]
        return np.array(counts) * self.frames.in_view

    @cached_property
    def checks(self) -> list[FrameError]:
        """The FrameError of each rendered frame."""
        return [self.frames.check(frame, self.shown(frame)) for frame in range(len(self.levels))]

    @property
    def errors(self) -> np.ndarray:
        """(f,) the error of each rendered frame, which is compared with the tolerance."""
        return np.array([check.error for check in self.checks])

    def shown(self, frame: int) -> list[Level]:
        """The Level of each object in a frame."""
        return [chain[k] for chain, k in zip(self.chains, self.levels[frame], strict=True)]

    @cached_property
    def jumps(self) -> list[tuple[int, int, float]]:
        """[(frame, object, jump)]: how far the picture of an object jumps where its level switches in plain view.

        Where no pixel shows it before or after, nothing jumps: its box reaches into the view before it does.
        """
        shown = self.frames.scale > 0
        where = np.argwhere((np.diff(self.levels, axis=0) != 0) & shown[1:] & shown[:-1])
        return [(int(f) + 1, int(o), self._jump(f + 1, o)) for f, o in where]

    def _jump(self, frame, item):
        before, after = (self.chains[item][self.levels[k, item]] for k in (frame - 1, frame))
        return self.frames.between(frame, item, before, after)
