"""One object of a class: from its source to a mesh with salient points."""

from types import SimpleNamespace

import cv2

from stages.kit import Stopwatch
from stages.kit.fetch import FetchError
from stages.meshes import MeshError
from stages.meshes.collect import prepare
from stages.meshes.sources import SOURCES
from stages.salient_points import look
from stages.salient_points.methods import find_all, method_named
from stages.salient_points.options import Options

from .files import write_object


def items(settings, objects=()):
    """{name: Item} of the source that the settings name, all of it or the given objects.

    Raises MeshError or FetchError, which say what to set or to fetch, where the source is not there.
    """
    chosen = SimpleNamespace(folder=settings.folder, up=settings.up, unit="unknown", objects=list(objects))
    try:
        return {item.name: item for item in SOURCES[settings.source](chosen)}
    except FetchError as error:
        reason = str(error).replace("meshes.folder", "classes.folder")
        raise FetchError(f"{reason}; or do without: `python -m stages.compose classes=household`") from None
    except MeshError as error:
        raise MeshError(str(error).replace("meshes.folder", "classes.folder")) from None


def process(name, folder, settings, seed):
    """Reads, cleans and normalises one object and finds its points; its rows, or one with the reason of a refusal.

    The first row also carries, under `known`, what goes into classes.csv.
    """
    cv2.setNumThreads(1)  # a worker is one core, and `seconds` are of one core
    try:
        with Stopwatch() as reading:
            mesh, known = prepare(items(settings, [name])[name])
    except MeshError as error:
        return [{"object": name, "metric": "faces", "value": None, "note": str(error)}]
    channels = dict.fromkeys(channel for method in settings.methods for channel in method_named(method).channels)
    with Stopwatch() as looking:
        sight = look(mesh, list(channels), renderer="raycast")
    found, seconds = find_all(mesh, sight, settings.methods, Options(seed=seed, name=name), settings.count)
    write_object(folder / f"{name}.npz", mesh, {method: result.points for method, result in found.items()})
    rows = [{"object": name, "metric": "faces", "value": known["faces"], "seconds": reading.seconds, "known": known}]
    for method, result in found.items():
        shared = looking.seconds if method_named(method).channels else 0.0
        row = {"object": name, "method": method, "metric": "points", "value": len(result.points)}
        rows.append(row | {"seconds": seconds[method] + shared})
    return rows
