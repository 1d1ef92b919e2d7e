"""Objects in classes, three per class, from the Debian package sweethome3d-furniture, with the files beside a mesh.

Each object was inspected from both sides, since names mislead ("Clothes horse" is not an animal). It stands upright,
is complete and solid, shows the outer side of its faces, and has 1,000 to 60,000 faces.
"""

import hashlib
import io
import re
import zipfile
from collections.abc import Callable
from pathlib import Path, PurePosixPath

import numpy as np

from haptic_glance.base.fetch import FetchError, cache_folder, debian_files, fetch_debian, read_members, zipped
from haptic_glance.base.files import whole_file
from haptic_glance.base.lazy import trimesh
from haptic_glance.mesh.gltf import names_in
from haptic_glance.mesh.materials import obj_vertices

PACKAGE = "sweethome3d-furniture_1.8-1_all.deb"
HASH = "3ccb90c63f9525e887a767b9cd5c8b6933b8b6b2973a615a5359ee68a2118668"
FOLDER = "usr/share/sweethome3d/furniture"
CATALOGUE = "PluginFurnitureCatalog.properties"
UP = 1  # index of the axis that points up in all its models: y
LICENCES = {
    "BlendSwap-CC-0": "CC0-1.0", "BlendSwap-CC-BY": "CC-BY-3.0", "KatorLegaz": "CC-BY-3.0-US",
    "Reallusion": "CC-BY-3.0-US", "Scopia": "CC-BY-3.0",
}  # fmt: skip

# name: (library, entry of its catalogue). Eight classes as close as possible to those of T figure 4.18, then two more.
FURNITURE = {
    "horse": ("BlendSwap-CC-BY", "horse"),
    "dog": ("Scopia", "dog"),
    "rabbit": ("Scopia", "rabbit"),
    "oldtimer": ("BlendSwap-CC-BY", "carrito-de-madera"),
    "family_car": ("Scopia", "renault-scenic"),
    "small_car": ("Scopia", "smart-car"),
    "dining_chair": ("BlendSwap-CC-0", "chair"),
    "shell_chair": ("Scopia", "plastic_chair"),
    "kitchen_chair": ("Scopia", "white_kitchen_chair"),
    "dome_lamp": ("BlendSwap-CC-0", "desklamp"),
    "table_lamp": ("BlendSwap-CC-BY", "lamp"),
    "vase_lamp": ("KatorLegaz", "pedestal-vase-lamp"),
    "standing_woman": ("Reallusion", "holdingFemale01"),
    "sitting_woman": ("Reallusion", "sitFemale02"),
    "lying_man": ("Reallusion", "lyingDownMale01"),
    "cushion_sofa": ("Scopia", "clear_sofa"),
    "long_sofa": ("BlendSwap-CC-BY", "sofa3"),
    "rattan_sofa": ("Scopia", "rattanSofa"),
    "round_table": ("BlendSwap-CC-0", "oakTable"),
    "low_table": ("Scopia", "ext_table"),
    "office_table": ("Scopia", "wooden_office_alder_table"),
    "ribbed_vase": ("Scopia", "vase2"),
    "urn": ("Scopia", "jar"),
    "slender_vase": ("Scopia", "vase3"),
    "beer_bottle": ("BlendSwap-CC-BY", "beer_bottle"),
    "yogurt_bottle": ("BlendSwap-CC-0", "yogurtBottle"),
    "medicine_bottle": ("Scopia", "medicoscopia_bottle"),
    "boots": ("BlendSwap-CC-0", "bootie"),
    "pumps": ("Scopia", "woman_shoes"),
    "slippers": ("BlendSwap-CC-0", "slippers"),
}


def furniture_files(everything: bool = False) -> tuple[Path, dict[str, tuple[str, str]]]:
    """(path of an archive in the cache with NAME.obj for each name of FURNITURE, {name: (creator, unit)}).

    The files of its materials are below NAME/, empty where the package lacks one.

    everything: for each of the 820 entries instead, named LIBRARY__ENTRY. The archive is made from the package of
    119.8 MB when it is missing; its file name depends on what is in it. The unit is a length in cm: models differ in
    scale, and the catalogue states their height. Raises FetchError, saying which file to put where, when the package
    cannot be fetched.
    """
    suffix = "all" if everything else hashlib.sha256(repr(FURNITURE).encode()).hexdigest()[:8]
    extract = cache_folder() / f"furniture-1.8-1-coloured-{suffix}.zip"
    if not zipfile.is_zipfile(extract):
        _extract(fetch_debian(PACKAGE, HASH), extract, everything)
    with zipfile.ZipFile(extract) as archive:
        comments = {
            entry.filename.removesuffix(".obj"): entry.comment.decode() for entry in archive.infolist() if entry.comment
        }
    metadata = {name: (comment.split("\n")[0], comment.split("\n")[1]) for name, comment in comments.items()}
    return extract, metadata


def _extract(package, extract, everything):
    with whole_file(extract) as part, zipfile.ZipFile(part, "w", zipfile.ZIP_DEFLATED) as target:
        for path, stream in debian_files(package):
            library = path.removeprefix(f"{FOLDER}/").removesuffix(".sh3f")
            if library not in LICENCES:
                continue
            archive = io.BytesIO(stream.read())
            entries = _entries(next(read_members(archive, [CATALOGUE]))[1])
            models = {
                re.sub(r"[^\w-]", "_", f"{library}__{entry}"): (library, entry)
                for entry in sorted(filter(None, entries))
            }
            for name, (where, entry) in (models if everything else FURNITURE).items():
                if where == library:
                    _copy(archive, entries[entry], name, target)


def _copy(archive, entry, name, target):
    model = PurePosixPath(entry["model"].lstrip("/"))
    ((_, content),) = read_members(archive, [str(model)])
    member = zipfile.ZipInfo(f"{name}.obj")
    height = np.ptp(obj_vertices(content)[:, UP])  # of a carpet or a poster this may be zero
    unit = f"{float(entry['height']) / height:.3g} cm" if height > 0 else "unknown"
    member.comment = f"{entry['creator']}\n{unit}".encode()
    target.writestr(member, content, zipfile.ZIP_DEFLATED)

    def read(beside):
        try:
            return next(read_members(archive, [str(model.parent / beside)]))[1]
        except FetchError as error:
            raise OSError(str(error)) from None

    for beside, data in files_named(content, ".obj", read).items():
        target.writestr(f"{name}/{beside}", data, zipfile.ZIP_DEFLATED)


def material_files(extract: Path, name: str) -> dict[str, bytes]:
    """{name: bytes} of the files of an object's materials in the archive of `furniture_files`."""
    with zipped(extract) as zip_file:
        paths = [path for path in zip_file.namelist() if path.startswith(f"{name}/")]
        return {path.removeprefix(f"{name}/"): zip_file.read(path) for path in paths}


def _entries(catalogue):
    """{entry: {property: value}} of a catalogue: Java properties PROPERTY#NUMBER=VALUE, id#NUMBER=LIBRARY#ENTRY."""
    numbered = {}
    for key, number, value in re.findall(r"^(\w+)#(\d+)=(.*?)\s*$", catalogue.decode("latin-1"), re.M):
        numbered.setdefault(number, {})[key] = value
    return {entry["id"].partition("#")[2]: entry for entry in numbered.values()}


NAMES = {  # what names a file, by the suffix of the file in which it stands
    ".obj": re.compile(rb"^[ \t]*mtllib[ \t]+(.+?)\s*$", re.M),
    ".mtl": re.compile(rb"^[ \t]*map_Kd[ \t]+(.+?)\s*$", re.M | re.I),
    ".depth": re.compile(rb'"image"\s*:\s*"([^"]+)"'),
    ".ply": re.compile(rb"^comment[ \t]+TextureFile[ \t]+(.+?)\s*$", re.M | re.I),
}


def files_beside(path: Path) -> dict[str, bytes]:
    """{name: bytes} of the files that an OBJ, its materials, a PLY, a .gltf or a .depth name, as they spell them.

    A file that is not there, or not below the folder of the mesh, is empty.
    """
    return files_named(path.read_bytes(), path.suffix, trimesh.resolvers.FilePathResolver(str(path)).get)


def files_named(content: bytes, suffix: str, read: Callable[[str], bytes]) -> dict[str, bytes]:
    """As `files_beside`, of the bytes of a mesh file; read(name, relative to it) raises OSError or ValueError."""
    files: dict[str, bytes] = {}
    pending = _named(content, suffix)
    while pending:
        name = pending.pop(0)
        try:
            files[name] = read(name.replace("\\", "/"))
        except (OSError, ValueError):
            files[name] = b""
        pending += [other for other in _named(files[name], Path(name).suffix) if other not in files]
    return files


def _named(content, suffix):
    if suffix.lower() == ".gltf":
        return names_in(content)
    header = content.partition(b"end_header")[0] if suffix.lower() == ".ply" else content
    pattern = NAMES.get(suffix.lower())
    return [name.decode("utf-8", "replace") for name in pattern.findall(header)] if pattern else []
