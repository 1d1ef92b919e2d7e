"""A level for each object in each frame: the faces it takes, the errors of the rendered frames, and the switches."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from .frames import Frames
from .ladder import Level


@dataclass(frozen=True, eq=False)
class Plan:
    """A level for each object in each frame. levels (f, o) i8 into ladders, a tuple of Levels for each object; frames
    and the scene say what it is for.
    """

    levels: np.ndarray
    ladders: tuple[tuple[Level, ...], ...]
    frames: Frames

    @cached_property
    def faces(self):
        """(f, o) faces of each object in each frame; 0 out of view."""
        counts = [[ladder[k].faces for k, ladder in zip(row, self.ladders, strict=True)] for row in self.levels]
        return np.array(counts) * self.frames.in_view

    @cached_property
    def checks(self):
        """A FrameError for each rendered frame."""
        return [self.frames.check(frame, self.shown(frame)) for frame in range(len(self.levels))]

    @property
    def errors(self):
        """(f,) the error of each rendered frame, held against the tolerance."""
        return np.array([check.error for check in self.checks])

    def shown(self, frame):
        """The Level of each object in a frame."""
        return [ladder[k] for ladder, k in zip(self.ladders, self.levels[frame], strict=True)]

    @cached_property
    def steps(self):
        """[(frame, object, step)]: how far the picture of an object jumps where its level switches."""
        where = np.argwhere(np.diff(self.levels, axis=0) != 0)
        return [(int(f) + 1, int(o), self._step(f + 1, o)) for f, o in where]

    def _step(self, frame, item):
        before, after = (self.ladders[item][self.levels[k, item]] for k in (frame - 1, frame))
        return self.frames.between(frame, item, before, after)
