"""What the cameras see of the scene at any levels, and how far that lies from the full scene, on the screen.

The displacement of a pixel is the distance from the surface point seen in it to the other mesh of the same object, in
pixels at that point's depth. It is taken both ways, over the pixels in which the object is seen in the one frame and
in the other: a part that has shrunk shows in the first, one that sticks out in the second.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from .look import look, nearest, nearest_two, pixel_box, rays_of, shade
from .pictures import structure_lost, structures_lost

QUANTILE = 0.99  # of an object's pixels lie within the error: one in a hundred may be a sliver on an edge


@dataclass(frozen=True)
class FrameError:
    """A rendered frame against the full one. error: what is held against the tolerance, the largest of `objects` (o,).

    displacements (p,): pixels, all objects and both ways, for means and quantiles.
    """

    error: float
    objects: np.ndarray
    displacements: np.ndarray


class Frames:
    """The frames of a scene, rendered object by object and joined by depth; what was rendered once is kept.

    full: a Level an object, the mesh as it is. An object hides another by depth, as in a picture of them all.
    """

    def __init__(self, scene, meshes, full):
        self.scene, self.full = scene, full
        self.poses = scene.poses(meshes)
        self.boxes = [[pixel_box(camera, pose) for pose in self.poses] for camera in scene.cameras]
        self.in_view = np.array([[b > t and r > left for t, b, left, r in row] for row in self.boxes])
        self.shape = self.in_view.shape
        self._looks, self._reach, self._colors = {}, {}, {}

    @cached_property
    def distance(self):
        """(frames, objects) metres from the eye to the middle of each object."""
        eyes = np.array([camera.eye for camera in self.scene.cameras])
        middles = np.array([pose.corners().mean(axis=0) for pose in self.poses])
        return np.linalg.norm(eyes[:, None] - middles[None], axis=2)

    @cached_property
    def scale(self):
        """(frames, objects) pixels that a unit of each mesh takes where it is seen nearest; 0 where it is not seen."""
        found = np.zeros(self.shape)
        for frame, item in np.argwhere(self.in_view):
            depth = self.look(frame, item, self.full[item]).depth
            if len(depth):
                found[frame, item] = self.poses[item].scale * self.scene.cameras[frame].focal / depth.min()
        return found

    def look(self, frame, item, level):
        """The Look of an object at a level, in one frame."""
        key = frame, item, level
        if key not in self._looks:
            self._looks[key] = look(level, self.scene.cameras[frame], self.poses[item])
        return self._looks[key]

    def colors(self, frame, item, level):
        """(k, 3) f4 rgb, 0 to 255, of a Look; those of the full meshes are kept, as every comparison needs them."""
        key = frame, item
        if level is self.full[item] and key in self._colors:
            return self._colors[key]
        seen = self.look(frame, item, level)
        found = shade(level, seen, self.scene.cameras[frame], self.poses[item]).astype(np.float32)
        if level is self.full[item]:
            self._colors[key] = found
        return found

    @cached_property
    def _others(self):
        """[frame] -> depths of the nearest two objects at full detail, and which is the nearest."""
        return [nearest_two(*self._looks_of(frame, self.full)) for frame in range(self.shape[0])]

    def _looks_of(self, frame, levels):
        """(Looks of a frame with a level an object, pixels of the frame)."""
        looks = [self.look(frame, item, level) for item, level in enumerate(levels)]
        return looks, int(np.prod(self.scene.cameras[frame].size))

    def visible(self, frame, item, level):
        """(k,) boolean: the pixels of a Look that no other object, at full detail, hides."""
        first, second, owner = self._others[frame]
        seen = self.look(frame, item, level)
        limit = np.where(owner[seen.pixels] == item, second[seen.pixels], first[seen.pixels])
        return seen.depth < limit

    def measure(self, wanted):
        """Prepares the displacements of many (frame, object, level, other level) at once, a call a pair of meshes."""
        missing, groups = {}, {}
        for frame, item, *pair in wanted:
            for one, other in (pair, pair[::-1]):
                if (frame, item, one, other) not in self._reach:
                    missing[frame, item, one, other] = None
        for frame, item, one, other in missing:
            groups.setdefault((one, other), []).append((frame, item))
        for (one, other), places in groups.items():
            looks = [self.look(*place, one) for place in places]
            points = np.concatenate([self._points(*place, seen) for place, seen in zip(places, looks, strict=True)])
            found = other.surface.nearest(points)[0] if one is not other else np.zeros(len(points))
            ends = np.cumsum([len(seen.pixels) for seen in looks])[:-1]
            for place, seen, part in zip(places, looks, np.split(found, ends), strict=True):
                pixels = self._pixels_a_unit(*place, seen)
                self._reach[(*place, one, other)] = (part * pixels).astype(np.float32)

    def _points(self, frame, item, seen):
        return rays_of(seen, self.scene.cameras[frame], self.poses[item])[0]

    def _pixels_a_unit(self, frame, item, seen):
        return self.poses[item].scale * self.scene.cameras[frame].focal / seen.depth

    def between(self, frame, item, one, other):
        """Error on the screen of one level of an object against another, the other objects at full detail."""
        if one is other:
            return 0.0
        if self.scene.kind == "ssim":
            return structure_lost(self, frame, item, one, other)
        self.measure([(frame, item, one, other)])
        sides = [self._reach[frame, item, a, b][self.visible(frame, item, a)] for a, b in ((one, other), (other, one))]
        return _quantile(np.concatenate(sides))

    def check(self, frame, levels):
        """The FrameError of a rendered frame with a level an object: only what is really seen in it counts."""
        self.measure([(frame, item, self.full[item], level) for item, level in enumerate(levels)])
        sides = [[np.zeros(0, np.float32)] for _ in levels]
        for shown, others in ((self.full, levels), (levels, self.full)):
            owner = self.owners(frame, shown)
            for item, pair in enumerate(zip(shown, others, strict=True)):
                mine = owner[self.look(frame, item, pair[0]).pixels] == item
                sides[item].append(self._reach[(frame, item, *pair)][mine])
        found = [np.concatenate(side) for side in sides]
        errors = np.array([_quantile(side) for side in found])
        if self.scene.kind == "ssim":
            errors = structures_lost(self, frame, levels)
        return FrameError(float(errors.max()), errors, np.concatenate(found))

    def weighted(self, frame, item, level, values):
        """(sum of displacement times value, sum of values) over the pixels that show an object in the full frame.

        values (n,): one a vertex of the full mesh, say its saliency.
        """
        full = self.full[item]
        self.measure([(frame, item, full, level)])
        seen, shown = self.look(frame, item, full), self.visible(frame, item, full)
        weights = values[full.mesh.faces[seen.faces[shown]]].mean(axis=1)
        return float(self._reach[frame, item, full, level][shown] @ weights), float(weights.sum())

    def displacements(self, frame, item, level):
        """(k,) f4 pixels that each pixel of an object's Look at a level is off the full mesh."""
        self.measure([(frame, item, self.full[item], level)])
        return self._reach[frame, item, level, self.full[item]]

    def owners(self, frame, levels):
        """(h * w,) which object each pixel shows, -1 for none."""
        return nearest(*self._looks_of(frame, levels))


def _quantile(values):
    return float(np.quantile(values, QUANTILE)) if len(values) else 0.0
