"""Rendered frames of a scene at any levels, their error against the full scene, and the plan of a level per frame.

The displacement of a pixel is the distance from the surface point visible in it to the other mesh of the same object,
in pixels at that point's depth. It is measured both ways, over the pixels of the object in the one frame and in the
other: a part that has shrunk shows in the first, one that sticks out in the second.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from haptic_glance.mesh.mesh import Mesh

from .camera import Scene
from .chain import Level
from .level_renders import (
    Rendering,
    nearest_two,
    pixel_box,
    rays_of,
    render_level,
    shade,
    structure_lost,
    structures_lost,
)

RECENT = 8  # errors remembered for each frame of a scene
QUANTILE = 0.99  # of an object's pixels are within the error: one in a hundred may be a sliver on an edge


@dataclass(frozen=True)
class FrameError:
    """Error of a rendered frame against the full one, compared with the tolerance: the largest of `objects` (o,).

    displacements (p,): pixels, of all objects and both ways, for means and quantiles.
    """

    error: float
    objects: np.ndarray
    displacements: np.ndarray


class Frames:
    """The frames of a scene, rendered object by object and joined by depth; renderings are cached.

    full: the finest Level of each object.
    """

    def __init__(self, scene: Scene, meshes: Mapping[str, Mesh], full: Sequence[Level]) -> None:
        self.scene, self.full = scene, list(full)
        self.poses = scene.poses(meshes)
        self.boxes = [[pixel_box(camera, pose) for pose in self.poses] for camera in scene.cameras]
        self.in_view = np.array([[b > t and r > left for t, b, left, r in row] for row in self.boxes])
        self.shape = self.in_view.shape
        self._renderings: dict[tuple, Rendering] = {}
        self._displacements: dict[tuple, np.ndarray] = {}
        self._colors: dict[tuple, np.ndarray] = {}
        self._checks: dict[tuple, FrameError] = {}

    @cached_property
    def distance(self) -> np.ndarray:
        """(frames, objects) metres from the eye to the middle of each object."""
        eyes = np.array([camera.eye for camera in self.scene.cameras])
        middles = np.array([pose.corners().mean(axis=0) for pose in self.poses])
        return np.linalg.norm(eyes[:, None] - middles[None], axis=2)

    @cached_property
    def scale(self) -> np.ndarray:
        """(frames, objects) pixels per unit of each mesh at its nearest visible point; 0 where it is not visible."""
        scale = np.zeros(self.shape)
        for frame, item in np.argwhere(self.in_view):
            depth = self.rendering(frame, item, self.full[item]).depth
            if len(depth):
                scale[frame, item] = self.poses[item].scale * self.scene.cameras[frame].focal / depth.min()
        return scale

    def rendering(self, frame: int, item: int, level: Level) -> Rendering:
        """The Rendering of an object at a level, in one frame."""
        key = frame, item, level
        if key not in self._renderings:
            self._renderings[key] = render_level(level, self.scene.cameras[frame], self.poses[item])
        return self._renderings[key]

    def colors(self, frame: int, item: int, level: Level) -> np.ndarray:
        """(k, 3) f4 rgb, 0 to 255, of a Rendering; those of the full meshes are cached."""
        key = frame, item
        if level is self.full[item] and key in self._colors:
            return self._colors[key]
        rendering = self.rendering(frame, item, level)
        colors = shade(level, rendering, self.scene.cameras[frame], self.poses[item]).astype(np.float32)
        if level is self.full[item]:
            self._colors[key] = colors
        return colors

    @cached_property
    def _others(self):
        """[frame] -> depths of the nearest two objects at full detail, and the index of the nearest."""
        return [self._nearest_two(frame, self.full) for frame in range(self.shape[0])]

    def _nearest_two(self, frame, levels):
        """`nearest_two` of the Renderings of a frame with one level per object."""
        renderings = [self.rendering(frame, item, level) for item, level in enumerate(levels)]
        return nearest_two(renderings, int(np.prod(self.scene.cameras[frame].size)))

    def visible(self, frame: int, item: int, level: Level) -> np.ndarray:
        """(k,) boolean: the pixels of a Rendering that no other object, at full detail, hides."""
        first, second, owner = self._others[frame]
        rendering = self.rendering(frame, item, level)
        limit = np.where(owner[rendering.pixels] == item, second[rendering.pixels], first[rendering.pixels])
        return rendering.depth < limit

    def measure(self, pairs: Iterable[tuple[int, int, Level, Level]]) -> None:
        """Computes the displacements of many (frame, object, level, other level), one query per pair of meshes."""
        missing, groups = {}, {}
        for frame, item, first, second in pairs:
            for source, target in ((first, second), (second, first)):
                if (frame, item, source, target) not in self._displacements:
                    missing[frame, item, source, target] = None
        for frame, item, source, target in missing:
            groups.setdefault((source, target), []).append((frame, item))
        for (source, target), places in groups.items():
            renderings = [self.rendering(frame, item, source) for frame, item in places]
            cameras = [(self.scene.cameras[frame], self.poses[item]) for frame, item in places]
            rays = [rays_of(rendering, *pair) for rendering, pair in zip(renderings, cameras, strict=True)]
            points = np.concatenate([positions for positions, _ in rays])
            distances = target.surface.nearest(points)[0] if source is not target else np.zeros(len(points))
            ends = np.cumsum([len(rendering.pixels) for rendering in renderings])[:-1]
            for (frame, item), rendering, part in zip(places, renderings, np.split(distances, ends), strict=True):
                pixels = self.poses[item].scale * self.scene.cameras[frame].focal / rendering.depth
                self._displacements[frame, item, source, target] = (part * pixels).astype(np.float32)

    def between(self, frame: int, item: int, first: Level, second: Level) -> float:
        """Error on the screen of one level of an object against another, with the other objects at full detail."""
        if first is second:
            return 0.0
        if self.scene.kind == "ssim":
            return structure_lost(self, frame, item, first, second)
        self.measure([(frame, item, first, second)])
        return _quantile(
            np.concatenate([self.moved(frame, item, *pair) for pair in ((first, second), (second, first))])
        )

    def moved(self, frame: int, item: int, level: Level, base: Level) -> np.ndarray:
        """(k,) f4: displacements from `base` of the pixels that show an object at level `level`; `measure` comes first.

        The other objects, at full detail, hide some of the object's pixels.
        """
        return self._displacements[frame, item, level, base][self.visible(frame, item, level)]

    def check(self, frame: int, levels: Sequence[Level]) -> FrameError:
        """The FrameError of a rendered frame with one level per object, over the pixels in which each is visible.

        The latest of each frame are remembered: two plans of a search often show a frame at the same levels.
        """
        key = frame, tuple(levels)
        self._checks[key] = error = self._checks.pop(key, None) or self._check(*key)
        if len(self._checks) > RECENT * len(self.scene.cameras):
            del self._checks[next(iter(self._checks))]
        return error

    def _check(self, frame, levels):
        self.measure([(frame, item, self.full[item], level) for item, level in enumerate(levels)])
        sides = [[np.zeros(0, np.float32)] for _ in levels]
        owners = self._others[frame][2], self.owners(frame, levels)
        for owner, sources, targets in zip(owners, (self.full, levels), (levels, self.full), strict=True):
            for item, (source, target) in enumerate(zip(sources, targets, strict=True)):
                visible = owner[self.rendering(frame, item, source).pixels] == item
                sides[item].append(self._displacements[frame, item, source, target][visible])
        moves = [np.concatenate(side) for side in sides]
        errors = np.array([_quantile(side) for side in moves])
        if self.scene.kind == "ssim":
            errors = structures_lost(self, frame, levels)
        return FrameError(float(errors.max()), errors, np.concatenate(moves))

    def weighted(self, frame: int, item: int, level: Level, values: np.ndarray) -> tuple[float, float]:
        """(sum of displacement times value, sum of values) over the pixels that show an object in the full frame.

        values (n,): per vertex of the full mesh, for example its saliency.
        """
        full = self.full[item]
        self.measure([(frame, item, full, level)])
        rendering, visible = self.rendering(frame, item, full), self.visible(frame, item, full)
        weights = values[full.mesh.faces[rendering.faces[visible]]].mean(axis=1)
        return float(self._displacements[frame, item, full, level][visible] @ weights), float(weights.sum())

    def displacements(self, frame: int, item: int, level: Level) -> np.ndarray:
        """(k,) f4: the displacement of each pixel of an object's Rendering at a level from the full mesh."""
        self.measure([(frame, item, self.full[item], level)])
        return self._displacements[frame, item, level, self.full[item]]

    def owners(self, frame: int, levels: Sequence[Level]) -> np.ndarray:
        """(h * w,) the object that each pixel shows, -1 for none."""
        return self._nearest_two(frame, levels)[2]


def _quantile(values):
    return float(np.quantile(values, QUANTILE)) if len(values) else 0.0


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
        visible = self.frames.scale > 0
        where = np.argwhere((np.diff(self.levels, axis=0) != 0) & visible[1:] & visible[:-1])
        return [(int(f) + 1, int(o), self._jump(f + 1, o)) for f, o in where]

    def _jump(self, frame, item):
        before, after = (self.chains[item][self.levels[k, item]] for k in (frame - 1, frame))
        return self.frames.between(frame, item, before, after)
