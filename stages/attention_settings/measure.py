"""Everything that the model of gaze takes from pictures of one object, and what each part of it costs."""

from collections.abc import Callable, Sequence
from pathlib import Path

import cv2
import numpy as np

from stages.conspicuity import CHANNELS, ViewMaps, conspicuity, facing
from stages.conspicuity.channels import mask_at_size
from stages.kit import Mesh, Stopwatch, Viewpoint
from stages.kit.files import read_arrays, read_mesh, write_arrays, write_json
from stages.kit.run import Rows
from stages.salient_points import best_viewpoints
from stages.views import FOUR, TWELVE, greedy_views, render
from stages.weights import vertex_features

VIEWS: dict[str, Callable[[Mesh], Sequence[Viewpoint]]] = {
    "one": lambda mesh: TWELVE[:1],
    "two": lambda mesh: (FOUR[0], FOUR[2]),
    "four": lambda mesh: FOUR,
    "greedy four": lambda mesh: greedy_views(mesh, 4)[0],
    "best": best_viewpoints,
    "twelve": lambda mesh: TWELVE,
}


def process(name: str, folder: Path, data: Path, pictures: list[str]) -> Rows:
    """Measures one object from each of `pictures` (VIEWS-ROWS) and writes PICTURES/NAME.npz and .json (seconds).

    The arrays: `feature X` (n,) of the fixation model and `map X` (n,) of each channel, on the vertices.
    """
    cv2.setNumThreads(1)  # a worker is one core, and `seconds` are of one core
    mesh = read_mesh(data / "meshes" / f"{name}.npz")
    for picture in pictures:
        views, rows = parse(picture)
        features, maps, seconds = measure(mesh, VIEWS[views](mesh), rows)
        arrays = {f"feature {key}": values for key, values in features.items()}
        write_arrays(folder / picture / f"{name}.npz", **arrays, **{f"map {key}": maps[key] for key in maps})
        write_json(folder / picture / f"{name}.json", seconds)
    return []


def parse(picture: str) -> tuple[str, int]:
    """(set of viewpoints, rows) of VIEWS-ROWS. Raises ValueError for another form or an unknown set."""
    views, _, rows = picture.rpartition("-")
    if views not in VIEWS or not rows.isdigit():
        raise ValueError(f"attention_settings.pictures: {picture!r} is not VIEWS-ROWS, VIEWS of {', '.join(VIEWS)}")
    return views, int(rows)


def stored(path: Path, kind: str) -> dict[str, np.ndarray]:
    """{name: (n,)} of the arrays of a kind, feature or map, that `process` wrote."""
    return {key.partition(" ")[2]: values for key, values in read_arrays(path).items() if key.startswith(f"{kind} ")}


def measure(
    mesh: Mesh, viewpoints: Sequence[Viewpoint], rows: int
) -> tuple[dict[str, np.ndarray], dict[str, np.ndarray], dict[str, float]]:
    """({feature: (n,)}, {channel: (n,)} on the vertices, {part: seconds})."""
    view_maps, seconds = photograph(mesh, viewpoints, rows)
    on_vertices = {}
    for channel in CHANNELS:
        with Stopwatch() as watch:
            on_vertices[channel] = view_maps.vertex_values(view_maps.maps[channel])
        seconds[channel] += watch.seconds
    with Stopwatch() as watch:
        features = vertex_features(mesh, view_maps.viewpoints, view_maps.facing, on_vertices)
    return features, on_vertices, seconds | {"features": watch.seconds}


def photograph(mesh: Mesh, viewpoints: Sequence[Viewpoint], rows: int) -> tuple[ViewMaps, dict[str, float]]:
    """(all nine maps at one image size, {part: seconds})."""
    size, shape = (rows, rows * 4 // 3), (rows // 4, rows // 3)
    seconds = dict.fromkeys(("pictures", "facing", *CHANNELS), 0.0)
    found, masks = [], []
    for viewpoint in viewpoints:
        with Stopwatch() as watch:
            view = render(mesh, viewpoint, size, "raster")
        seconds["pictures"] += watch.seconds
        maps = {}
        for channel in CHANNELS:
            with Stopwatch() as watch:
                maps |= conspicuity(mesh, view, [channel], shape)
            seconds[channel] += watch.seconds
        found.append(maps)
        masks.append(mask_at_size(view.mask, shape))
    with Stopwatch() as watch:
        stacked = {channel: np.stack([maps[channel] for maps in found]) for channel in CHANNELS}
        view_maps = ViewMaps(mesh, viewpoints, stacked, np.stack(masks))
    seconds["view_maps"] = watch.seconds
    with Stopwatch() as watch:
        facing(mesh, viewpoints)
    seconds["facing"] = watch.seconds
    return view_maps, seconds
