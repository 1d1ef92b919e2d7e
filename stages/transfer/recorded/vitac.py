"""ViTac (T5.1.1): pieces of cloth, pressed by a GelSight sensor and photographed from above.

Paper: Luo, Yuan, Adelson, Cohn, Fuentes, ViTac: feature sharing between vision and tactile sensing for cloth texture
recognition, ICRA 2018 (T [106]), 100 pieces of cloth. Two layouts:
- `NUMBERt/*.jpg` by touch and `NUMBERv/*.jpg` by the camera, NUMBER that of the cloth: from the code published with
  Lee, Bollegala, Luo, "Touching to see" and "Seeing to feel", ICRA 2019 (vis_tac_cross_modal: alexnet/txt_gen.py,
  images/rename.py and the sample folders in cgan/dataset, where the suffix `_test` marks a test part, which is read as
  well). Its cloths are 11 22 23 35 50 57 65 75 87 91 100 107. They are twelve, as in the thesis, and are assumed to be
  the same. A picture is named RECORDING_NUMBER.jpg and was cut from a larger picture or a film.
- `CDNNNN` by touch and `visNNNN` by the camera, NNNN the number of the cloth, for all 100: these names are from a
  report on pruning networks for it (King's College London, 2024). The contents of these folders are not known here: the
  pictures may be at any depth, and where paths contain `press` only those are used, as in that report.
To get it: download the data from the link in either paper, unpack it, and give the folder that holds those of the
cloths.
"""

import re
from pathlib import Path

from .touches import SIZE, Recorded, collect, existing_folder, pictures

LAYOUT = (
    "ViTac: a folder of pictures per cloth, 11t and 11v (or CD0011 and vis0011) for the cloth 11 by touch and camera"
)
FOLDERS = {"touch": r"(?:(\d+)t(?:_test)?|CD(\d+))", "camera": r"(?:(\d+)v(?:_test)?|vis(\d+))"}


def read_vitac(path: str | Path, sense: str = "touch", size: int = SIZE) -> Recorded:
    """The Recorded of ViTac, sense `touch` or `camera`; classes are cloths by number; groups: the recording.

    Pictures are resized to size x size pixels. A group is the larger picture or the film that a picture was cut from,
    according to its name; photographs of one cloth may all be in one group. Raises ValueError that names what is
    missing.
    """
    if sense not in FOLDERS:
        raise ValueError(f"unknown sense {sense!r}, known: {', '.join(FOLDERS)}")
    found = {}
    for home in sorted(existing_folder(path, LAYOUT).iterdir()):
        if match := re.fullmatch(FOLDERS[sense], home.name):
            found.setdefault(int(match[1] or match[2]), []).append(home)
    if len(found) < 2:
        raise ValueError(f"{path} holds {len(found)} folders of cloths by {sense}; expected is {LAYOUT}")
    return collect({str(number): _cloth(number, found[number]) for number in sorted(found)}, size)


def _cloth(number, homes):
    files = [(file, file.relative_to(home)) for home in homes for file in pictures(home, LAYOUT, anywhere=True)]
    pressed = [pair for pair in files if "press" in str(pair[1]).lower()]
    return [
        (file, f"{number}/{inside.with_name(file.stem.rpartition('_')[0] or file.stem).as_posix()}")
        for file, inside in pressed or files
    ]
