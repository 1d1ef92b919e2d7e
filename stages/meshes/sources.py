"""The collections of meshes: one function per collection, each with its up axis, unit and licence.

MATLAB files of versions 5 to 7 are read by our own code (MathWorks, MAT-File Format, chapter 1), since scipy 1.17
crashes on some damaged files (its pull request 25349).
"""

import math
import re
import struct
import sys
import zipfile
import zlib
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path, PurePosixPath
from typing import Any

import numpy as np

from haptic_glance.base.fetch import LARGEST, FetchError, fetch_package, read_members, zipped
from haptic_glance.mesh.files import FORMATS
from haptic_glance.mesh.gltf import SUFFIXES as GLTF
from haptic_glance.mesh.headers import MeshError
from stages.engine.run import only_reads

from . import Params
from .furniture import FURNITURE, LICENCES, files_beside, furniture_files, material_files

HOUSEHOLD_WHEEL = "MyoSuite-2.2.0-py3-none-any.whl"
HOUSEHOLD_HASH = "1ae4bceff62b289ca490328566bb1c0afe2bfb097dd23c597916f127fae41ebd"
# Left out: human (an open body), table (a plate), and the second of each pair of identical meshes: coffeemug,
# cubemiddle, stamp, rubberduck, wristwatch.
HOUSEHOLD = (
    "airplane", "alarmclock", "apple", "banana", "binoculars", "bowl", "camera", "cubelarge", "cubemedium",
    "cubesmall", "cup", "cylinderlarge", "cylindermedium", "cylindersmall", "doorknob", "duck", "elephant",
    "eyeglasses", "flashlight", "flute", "fryingpan", "gamecontroller", "hammer", "hand", "headphones", "knife",
    "lightbulb", "mouse", "mug", "phone", "piggybank", "pyramidlarge", "pyramidmedium", "pyramidsmall", "scissors",
    "spherelarge", "spheremedium", "spheresmall", "stanfordbunny", "stapler", "teapot", "toothbrush", "toothpaste",
    "toruslarge", "torusmedium", "torussmall", "train", "watch", "waterbottle", "wineglass",
)  # fmt: skip


@dataclass(frozen=True)
class Content:
    """Reads a file, or the files beside it, when it is called or sent to another machine: there the bytes go along.

    An item that holds one names the bytes in `made_of`, so the file need not be declared where it lies below data/.
    """

    read: Callable[[], Any]

    def __call__(self) -> Any:
        with only_reads([], []):
            return self.read()

    def __reduce__(self) -> tuple[type, tuple]:
        try:
            content = self.read()
            return Content, (partial(type(content), content),)
        except (OSError, ValueError, RuntimeError) as error:  # said where it is called: one such file ends no run
            return Content, (partial(_refuse, error),)


def _refuse(error):
    raise error


@dataclass(frozen=True)
class MeshFile:
    """One mesh of a source: its name and file, a function that reads the bytes of the file, and metadata.

    suffix: the format, for example `.stl`; up: the axis that points up, or `auto`; unit: of the coordinates; beside: a
    function that reads the files of its materials (files_beside).
    """

    name: str
    file: str
    suffix: str
    content: Callable[[], bytes]
    up: str
    unit: str
    licence: str
    creator: str = "not stated"
    beside: Callable[[], dict[str, bytes]] = dict


def household(settings: Params) -> list[MeshFile]:
    """Fifty everyday objects of 3 to 24 cm: the object_sim meshes in the wheel of MyoSuite."""
    wheel = fetch_package("MyoSuite==2.2.0", HOUSEHOLD_WHEEL, HOUSEHOLD_HASH)
    names = _select_objects(HOUSEHOLD, settings.objects)
    return [_household_file(wheel, name) for name in names]


def _household_file(wheel, name):
    member = f"myosuite/simhive/object_sim/{name}/{name}.stl"
    return MeshFile(name, member, ".stl", Content(partial(_member, wheel, member)), "z", "m", "Apache-2.0")


def furniture(settings: Params) -> list[MeshFile]:
    """Thirty objects of ten classes, see FURNITURE, from a Debian package. All have +y up."""
    extract, metadata = furniture_files()
    return [
        _furniture_file(extract, name, *metadata[name]) for name in _select_objects(tuple(FURNITURE), settings.objects)
    ]


def catalogue(settings: Params) -> list[MeshFile]:
    """All 820 models of the same package, named LIBRARY__ENTRY. All have +y up."""
    extract, metadata = furniture_files(everything=True)
    return [
        _furniture_file(extract, name, *metadata[name]) for name in _select_objects(tuple(metadata), settings.objects)
    ]


def _furniture_file(extract, name, creator, unit):
    library, _, entry = name.partition("__")
    library, entry = FURNITURE.get(name, (library, entry))
    content = Content(partial(_member, extract, f"{name}.obj"))
    beside = Content(partial(material_files, extract, name))
    return MeshFile(
        name, f"{library}/{entry}.obj", ".obj", content, "y", unit, LICENCES[library], creator, beside=beside
    )


def folder(settings: Params) -> list[MeshFile]:
    """The user's own meshes: every mesh, point cloud and depth image below a folder (haptic_glance.mesh.files)."""
    root = Path(settings.folder).expanduser()
    if not settings.folder or not root.is_dir():
        raise MeshError(f"meshes.folder={settings.folder!r} is not a folder: set it to the folder of your meshes")
    everything = sorted(path for path in root.rglob("*") if not path.is_dir() and not _is_hidden(root, path))
    files = [path for path in everything if path.suffix.lower() in FORMATS]
    if not files:
        raise MeshError(f"meshes.folder={settings.folder!r} holds no mesh file ({', '.join(FORMATS)})")
    if len(files) < len(everything):
        formats = sorted({path.suffix or path.name for path in everything} - {path.suffix for path in files})
        ignored = len(everything) - len(files)
        print(f"meshes: {ignored} files of other formats ignored ({', '.join(formats)})", file=sys.stderr)
    by_name = {}
    for path in files:
        name = wanted = str(path.relative_to(root).with_suffix("")).replace("/", "__").replace("\\", "__")
        if name in by_name:
            name = f"{name}_{path.suffix[1:].lower()}"
        while name in by_name:
            name += "_"
        by_name[name] = path
        if name != wanted:
            namesake = by_name[wanted].relative_to(root)
            print(f"meshes: {path.relative_to(root)} is named {name}, since {namesake} is {wanted}", file=sys.stderr)
    chosen = _select_objects(tuple(by_name), settings.objects)
    if left_out := sorted(set(by_name) - set(chosen)):
        where = "meshes.objects and meshes.classes"
        print(f"meshes: {len(left_out)} of {len(by_name)} are not in {where}: {', '.join(left_out)}", file=sys.stderr)
    return [_folder_file(root, name, by_name[name], settings) for name in chosen]


def _is_hidden(root: Path, path: Path) -> bool:
    """Whether a file below a root, or a folder around it, has a name such as `._cup.stl`, which macOS leaves."""
    return any(part.startswith(".") for part in path.relative_to(root).parts)


def _folder_file(root, name, path, settings):
    # glTF defines its axis and unit (version 2.0, section 3.4); the other formats define neither.
    up, unit = ("y", "m") if path.suffix.lower() in GLTF else (settings.up, settings.unit)
    file = str(path.relative_to(root))
    beside = Content(partial(files_beside, path))
    return MeshFile(name, file, path.suffix.lower(), Content(path.read_bytes), up, unit, "unknown", beside=beside)


# What meshes.folder must hold for these sources: (source, file names, where it is published). They are not fetched
# automatically, since their pages state no hash and some no licence.
GAZE = ("gaze", "Models_3D/*.obj and dataset_*/*.txt", "GitHub: FandosA/3D_Mesh_Saliency_Prediction_PyTorch")
GAZE_CLOUDS = ("gaze_clouds", "NAME.txt", GAZE[2])
PRINCETON = ("princeton", "LabeledDB_new/CLASS/ID.off", "https://segeval.cs.princeton.edu")
INTEREST_POINTS = (
    "interest_points",
    "MODEL_DATASET/*.mat and OUTPUT_DATA/GROUND_TRUTH_B/*.mat",
    "https://www.itl.nist.gov/iad/vug/sharp/benchmark/3DInterestPoint",
)
FIXATION_MAPS = (
    "fixation_maps",
    "3DModels-Simplif/*.obj, FixationMaps/*norm.txt and CentricityAndVisibilityMaps/*_visibility.txt (FixationMaps.zip"
    " and CentricityAndVisibilityMaps.zip, both unpacked)",
    "https://perso.liris.cnrs.fr/guillaume.lavoue/data/saliency",
)


def gaze(settings: Params) -> list[MeshFile]:
    """Nineteen meshes with the gaze of 32 people in virtual reality. All have +y up. Most are those of T [236]."""
    files = match_files(collection_files(settings.folder, *GAZE), r"Models_3D/([^/]+)\.obj")
    return _mesh_files(files, settings, "y")


def gaze_clouds(settings: Params) -> list[MeshFile]:
    """Fourteen point clouds with gaze of the same experiment, whose meshes are not published. All have +y up."""
    files = match_files(collection_files(settings.folder, *GAZE_CLOUDS), r"([^/]+)\.txt")
    return _mesh_files(files, settings, "y", ".xyz")


def princeton(settings: Params) -> list[MeshFile]:
    """The Princeton segmentation benchmark (Chen 2009): 19 classes of closed meshes, named CLASS_ID.

    Most have +y up. Ants, bearings, and some airplanes, chairs, tables and people have other poses.
    """
    files = match_files(collection_files(settings.folder, *PRINCETON), r"LabeledDB_new/([^/]+/[^/]+)\.off")
    return _mesh_files(files, settings, "y")


def interest_points(settings: Params) -> list[MeshFile]:
    """The 43 models of the 3D interest point benchmark (Dutagaci 2012, T [7]): MATLAB files with V and F."""
    files = match_files(collection_files(settings.folder, *INTEREST_POINTS), r"MODEL_DATASET/([^/]+)\.mat")
    converted = {name: (path, partial(_off_bytes, content)) for name, (path, content) in files.items()}
    return _mesh_files(converted, settings, settings.up, ".off")


def fixation_maps(settings: Params) -> list[MeshFile]:
    """The 32 models of T3.3 with fixation density maps of three views (Lavoue 2018, T [236])."""
    files = match_files(collection_files(settings.folder, *FIXATION_MAPS), r"3DModels-Simplif/([^/]+)\.obj")
    return _mesh_files(files, settings, settings.up)


def _mesh_files(files, settings, up, suffix=None):
    return [
        MeshFile(
            name, files[name][0], suffix or Path(files[name][0]).suffix, files[name][1], up, "unknown", "not stated"
        )
        for name in _select_objects(tuple(files), settings.objects)
    ]


def collection_files(folder: str | Path, source: str, files: str, url: str) -> dict[str, Callable[[], bytes]]:
    """All files of a collection in a folder or zip archive: dict path -> function that reads the bytes.

    source, files, url: the collection, its files and where it is published, for the message. Raises FetchError, in one
    line that says what to get, from where, and where to put it, when the collection is missing.
    """
    root = Path(folder).expanduser()
    if folder and root.is_dir():
        return {path.relative_to(root).as_posix(): Content(path.read_bytes) for path in sorted(root.rglob("*.*"))}
    if folder and zipfile.is_zipfile(root):
        with zipped(root) as archive:
            return {name: Content(partial(_member, root, name)) for name in sorted(archive.namelist())}
    raise FetchError(
        f"meshes.folder={str(folder)!r} does not hold the {source} data: get {files} from {url}, put it there as a"
        " folder or a zip archive with these names inside, or set meshes.folder to the folder or archive"
    )


def _member(archive, name):
    return next(read_members(archive, [name]))[1]


ABOUT = re.compile("read[-_ ]?me|licen[cs]e", re.IGNORECASE)  # files about a collection


def match_files(files: Mapping[str, Callable[[], bytes]], pattern: str) -> dict[str, tuple[str, Callable[[], bytes]]]:
    """The files whose path ends with a regular expression: dict name -> (path, function that reads the bytes).

    The name is the group of the expression, with / as _. Hidden files, readmes and licences are skipped. Raises
    FetchError when no file matches, and when two files have one name.
    """
    names = [path for path in files if "/." not in path and not ABOUT.fullmatch(PurePosixPath(path).stem)]
    matches = [(re.search(rf"(?:^|/){pattern}$", path), path) for path in names]
    matched = {}
    for match, path in matches:
        if match and (name := match[1].replace("/", "_")) in matched:
            raise FetchError(f"{matched[name][0]} and {path} are both of {name}: keep one, or join them in one file")
        if match:
            matched[name] = path, files[path]
    if not matched:
        form = re.sub(r"\(.*\)", "NAME", pattern).replace("[^/]+", "*").replace("\\", "")
        raise FetchError(f"none of the {len(files)} files is called {form}: is it the published archive?")
    return matched


def _off_bytes(content):
    """A model of the interest point benchmark as the bytes of an OFF file, with exact coordinates."""
    vertices, faces = read_mat(content(), ("V", "F"))
    if any(values.dtype.kind not in "iuf" or values.ndim != 2 or values.shape[1] != 3 for values in (vertices, faces)):
        raise MeshError(f"V and F must be numeric arrays with three columns, got {vertices.shape} and {faces.shape}")
    rows = [" ".join(map(repr, row)) for row in vertices.tolist()]
    rows += [f"3 {a} {b} {c}" for a, b, c in (faces.astype(int) - 1).tolist()]
    return "\n".join(["OFF", f"{len(vertices)} {len(faces)} 0", *rows, ""]).encode()


SOURCES = {
    "household": household, "furniture": furniture, "catalogue": catalogue, "folder": folder, "gaze": gaze,
    "gaze_clouds": gaze_clouds, "princeton": princeton, "interest_points": interest_points,
    "fixation_maps": fixation_maps,
}  # fmt: skip


def _select_objects(available, wanted):
    names, wanted_names = set(available), set(wanted)
    missing = [name for name in wanted if name not in names]
    if missing:
        raise MeshError(
            f"meshes.objects names {', '.join(missing)}, which the source does not have. It has {', '.join(available)}"
        )
    return [name for name in available if not wanted or name in wanted_names]


MATRIX, COMPRESSED, CELLS, TEXT = 14, 15, 1, 4
NUMBERS = {1: "i1", 2: "u1", 3: "i2", 4: "u2", 5: "i4", 6: "u4", 7: "f4", 9: "f8", 12: "i8", 13: "u8"}
TEXTS = {2: "latin-1", 4: "utf-16", 16: "utf-8", 17: "utf-16", 18: "utf-32"}
CLASSES = {6: "f8", 7: "f4", 8: "i1", 9: "u1", 10: "i2", 11: "u2", 12: "i4", 13: "u4", 14: "i8", 15: "u8"}


def read_mat(content: bytes, names: Sequence[str]) -> list[np.ndarray]:
    """The variables `names` of a MATLAB file's bytes: real arrays, text (an array of one str), or cells (of objects).

    Raises MeshError when the file is unreadable or a variable is missing.
    """
    order = {b"\x00\x01IM": "<", b"\x01\x00MI": ">"}.get(content[124:128])
    if order is None:
        raise MeshError("unreadable as a MATLAB file before version 7.3")
    try:
        pairs = _variables(memoryview(content)[128:], order)
        variables = {name: value for name, value in pairs if value is not None}
    except Exception as error:  # struct, zlib and numpy raise many types
        raise MeshError(f"unreadable as a MATLAB file before version 7.3 ({type(error).__name__}: {error})") from None
    missing = [name for name in names if name not in variables]
    if missing:
        raise MeshError(f"the MATLAB file has no variable {', '.join(missing)}")
    return [variables[name] for name in names]


def _variables(content, order):
    for kind, body in _elements(content, order):
        if kind == COMPRESSED:
            yield from _variables(memoryview(zlib.decompressobj().decompress(body, LARGEST)), order)
        elif kind == MATRIX:
            yield _matrix(body, order)


def _elements(content: memoryview, order: str) -> Iterator[tuple[int, memoryview]]:
    """Yields (data type, bytes) of the elements one after another."""
    offset = 0
    while offset < len(content):
        kind, size = struct.unpack_from(f"{order}II", content, offset)
        start = offset + 8
        if kind >> 16:  # a small element: size and type share four bytes, the data have the other four
            kind, size, start = kind & 0xFFFF, kind >> 16, offset + 4
        if start + size > len(content):
            raise ValueError(f"an element of {size} bytes, {len(content) - start} follow")
        yield kind, content[start : start + size]
        offset = start + size if kind == COMPRESSED else max(offset + 8, start + size + -(start + size) % 8)


def _matrix(body, order):
    """(name, value) of a matrix; None for a value of another class, such as structures and sparse arrays."""
    if not len(body):
        return "", np.zeros((0, 0))
    (_, flags), (_, sizes), (_, name), *parts = _elements(body, order)
    kind, shape = np.frombuffer(flags, f"{order}u4")[0] & 0xFF, np.frombuffer(sizes, f"{order}i4").tolist()
    return bytes(name).decode("latin-1"), _value(kind, shape, parts, order)


def _value(kind, shape, parts, order):
    if kind == CELLS:
        if len(parts) != math.prod(shape):
            raise ValueError(f"{len(parts)} cells instead of {shape}")
        cells = np.empty(len(parts), dtype=object)
        cells[:] = [_matrix(body, order)[1] for _, body in parts]
        return cells.reshape(shape, order="F")
    if kind == TEXT:
        data_type, text = parts[0]
        wide = "" if TEXTS[data_type] in ("latin-1", "utf-8") else "-le" if order == "<" else "-be"
        return np.array([bytes(text).decode(TEXTS[data_type] + wide)])
    if kind in CLASSES:
        data_type, values = parts[0]
        return np.frombuffer(values, order + NUMBERS[data_type]).reshape(shape, order="F").astype(CLASSES[kind])
    return None
