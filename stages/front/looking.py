"""What all methods that need pictures find on a mesh, with the seconds that each would take by itself."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from haptic_glance.base.timing import Stopwatch
from haptic_glance.look.camera import Viewpoint
from haptic_glance.look.channels import ViewMaps, conspicuity
from haptic_glance.look.channels.channels import mask_at_size
from haptic_glance.look.points.methods import METHODS
from haptic_glance.look.points.options import Options
from haptic_glance.look.views import TWELVE, render, viewpoint_set
from haptic_glance.mesh.mesh import Mesh

from .space import SPACE, Choice, settings_of

MOST = max(SPACE["points"])  # places that are looked for; fewer are the first of these
LOOKING = [name for name in SPACE["method"] if METHODS[name].channels]  # methods that need pictures
CHANNELS = tuple(dict.fromkeys(channel for name in LOOKING for channel in METHODS[name].channels))


def looks(mesh: Mesh, choice: Choice, options: Options) -> Iterator[tuple[str, np.ndarray]]:
    """(METHOD-VIEWPOINTS points, (k,)) and (... seconds, ()) of all methods that look, at one image size.

    Pictures, maps and lines of sight are made once, and each method pays for those that it needs by itself.
    """
    settings = settings_of(choice)
    pictures, cost = {}, {}
    for viewpoint in TWELVE:
        pictures[viewpoint], cost[viewpoint] = _picture(mesh, viewpoint, settings)
    for name in SPACE["viewpoints"]:
        viewpoints = viewpoint_set(name)
        maps = {channel: np.stack([pictures[one][channel] for one in viewpoints]) for channel in CHANNELS}
        mask = np.stack([pictures[one]["mask"] for one in viewpoints])
        with Stopwatch() as lines:
            sight = ViewMaps(replace(mesh), viewpoints, maps, mask)
            sight.vertex_values(sight.maps[CHANNELS[0]])  # factors the equations of the smoothing, which all need
        for method in LOOKING:
            with Stopwatch() as finding:
                points = METHODS[method].find(sight.mesh, sight, options, MOST).points
            parts = ("picture", *METHODS[method].channels)
            seconds = sum(cost[one][part] for one in viewpoints for part in parts)
            yield f"{method}-{name} points", points
            yield f"{method}-{name} seconds", np.array(seconds + lines.seconds + finding.seconds)


def _picture(mesh: Mesh, viewpoint: Viewpoint, settings) -> tuple[dict[str, np.ndarray], dict[str, float]]:
    """({channel: its map, "mask"}, {"picture", channel: seconds}) of one view."""
    size = tuple(settings.conspicuity.size)
    with Stopwatch() as watch:
        view = render(mesh, viewpoint, settings.views.size, settings.views.renderer)
        maps = {"mask": mask_at_size(view.mask, size)}
    seconds = {"picture": watch.seconds}
    for channel in CHANNELS:
        with Stopwatch() as watch:
            maps |= conspicuity(mesh, view, [channel], size)
        seconds[channel] = watch.seconds
    return maps, seconds
