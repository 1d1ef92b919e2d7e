"""Objects in classes, three a class, from the catalogue of furniture that Debian carries (sweethome3d-furniture).

Each was looked at from both sides, since names mislead ("Clothes horse" is no animal): it stands upright, is whole and
firm to the touch, shows the outer side of its faces, and has from 1,000 to 60,000 of them. Materials are left in the
package, since the stages store no texture.
"""

import hashlib
import io
import re
import zipfile

import numpy as np

from stages.kit.fetch import cache_folder, debian_files, fetch_debian, read_members
from stages.kit.files import whole_file

from .painted import vertices_of

PACKAGE = "sweethome3d-furniture_1.8-1_all.deb"
HASH = "3ccb90c63f9525e887a767b9cd5c8b6933b8b6b2973a615a5359ee68a2118668"
FOLDER = "usr/share/sweethome3d/furniture"
CATALOGUE = "PluginFurnitureCatalog.properties"
UP = 1  # the axis that is up in all its models: y
LICENCES = {
    "BlendSwap-CC-0": "CC0-1.0", "BlendSwap-CC-BY": "CC-BY-3.0", "KatorLegaz": "CC-BY-3.0-US",
    "Reallusion": "CC-BY-3.0-US", "Scopia": "CC-BY-3.0",
}  # fmt: skip

# name: (library, entry of its catalogue). Eight classes as in T figure 4.18, as near as it gets, then two in reserve.
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


def furniture_files():
    """(path of the extract, {name: (creator, unit)}): an archive in the cache with NAME.obj of every one of FURNITURE.

    Made once from the package of 119.8 MB, which is only needed for that; the extract's own name follows the list. The
    unit is a length in cm, since some models are drawn at a scale of their own and the catalogue says how tall they
    are. FetchError says which file to put where when the package cannot be fetched.
    """
    listed = hashlib.sha256(repr(FURNITURE).encode()).hexdigest()[:8]
    extract = cache_folder() / f"furniture-1.8-1-{listed}.zip"
    if not zipfile.is_zipfile(extract):
        _extract(fetch_debian(PACKAGE, HASH), extract)
    with zipfile.ZipFile(extract) as stored:
        known = {name: tuple(stored.getinfo(f"{name}.obj").comment.decode().split("\n")) for name in FURNITURE}
    return extract, known


def _extract(package, extract):
    with whole_file(extract) as part, zipfile.ZipFile(part, "w", zipfile.ZIP_DEFLATED) as chosen:
        for path, stream in debian_files(package):
            library = path.removeprefix(f"{FOLDER}/").removesuffix(".sh3f")
            if library not in LICENCES:
                continue
            archive = io.BytesIO(stream.read())
            entries = _entries(next(read_members(archive, [CATALOGUE]))[1])
            for name, (where, entry) in FURNITURE.items():
                if where == library:
                    _copy(archive, entries[entry], name, chosen)


def _copy(archive, entry, name, chosen):
    ((_, content),) = read_members(archive, [entry["model"].lstrip("/")])
    member = zipfile.ZipInfo(f"{name}.obj")
    unit = float(entry["height"]) / np.ptp(vertices_of(content)[:, UP])
    member.comment = f"{entry['creator']}\n{unit:.3g} cm".encode()
    chosen.writestr(member, content, zipfile.ZIP_DEFLATED)


def _entries(catalogue):
    """{entry: {property: value}} of a catalogue: Java properties PROPERTY#NUMBER=VALUE, id#NUMBER=LIBRARY#ENTRY."""
    numbered = {}
    for key, number, value in re.findall(r"^(\w+)#(\d+)=(.*?)\s*$", catalogue.decode("latin-1"), re.M):
        numbered.setdefault(number, {})[key] = value
    return {entry["id"].partition("#")[2]: entry for entry in numbered.values()}
