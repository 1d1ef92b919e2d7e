"""ViTac (T5.1.1): pieces of cloth, pressed by a GelSight sensor and photographed from above.

Paper: Luo, Yuan, Adelson, Cohn, Fuentes, ViTac: feature sharing between vision and tactile sensing for cloth texture
recognition, ICRA 2018 (T [106]), 100 pieces of cloth. Two layouts:
- `NUMBERt/*.jpg` by touch and `NUMBERv/*.jpg` by the camera, NUMBER that of the cloth: from the code published with
  Lee, Bollegala, Luo, "Touching to see" and "Seeing to feel", ICRA 2019 (vis_tac_cross_modal: alexnet/txt_gen.py,
  images/rename.py and the sample folders in cgan/dataset, where a `_test` behind the name marks a test part, which is
  read as well). Its cloths are 11 22 23 35 50 57 65 75 87 91 100 107: twelve, as many as the thesis takes, but that
  these are the thesis's is our guess. A picture is called RECORDING_NUMBER.jpg: it was cut from a larger one or a film.
- `CDNNNN` by touch and `visNNNN` by the camera, NNNN the number of the cloth, for all 100: named so in a report on
  pruning networks for it (King's College London, 2024). How these folders look inside could not be established: the
  pictures may lie at any depth, and where some path says `press` only those count, as in that report.
To get it: on a machine with a network take the data link of either paper, unpack it, and give the folder that holds
those of the cloths.
"""

import re

from .touches import SIZE, collect, folder, pictures

WANTED = "ViTac: a folder of pictures a cloth, 11t and 11v (or CD0011 and vis0011) for the cloth 11 by touch and camera"
FOLDERS = {"touch": r"(?:(\d+)t(?:_test)?|CD(\d+))", "camera": r"(?:(\d+)v(?:_test)?|vis(\d+))"}


def read_vitac(path, sense="touch", size=SIZE):
    """The Recorded of ViTac, sense `touch` or `camera`; classes are cloths by number; groups: the recording.

    Pictures are brought to size x size pixels. A group is the larger picture or the film that a picture was cut from,
    as its name says; photographs of one cloth may all be of one group. Raises ValueError that names what is missing.
    """
    if sense not in FOLDERS:
        raise ValueError(f"unknown sense {sense!r}, known: {', '.join(FOLDERS)}")
    found = {}
    for home in sorted(folder(path, WANTED).iterdir()):
        if match := re.fullmatch(FOLDERS[sense], home.name):
            found.setdefault(int(match[1] or match[2]), []).append(home)
    if len(found) < 2:
        raise ValueError(f"{path} holds {len(found)} folders of cloths by {sense}; wanted is {WANTED}")
    return collect({str(number): _cloth(number, found[number]) for number in sorted(found)}, size)


def _cloth(number, homes):
    files = [(file, file.relative_to(home)) for home in homes for file in pictures(home, WANTED, anywhere=True)]
    pressed = [pair for pair in files if "press" in str(pair[1]).lower()]
    return [
        (file, f"{number}/{inside.with_name(file.stem.rpartition('_')[0] or file.stem).as_posix()}")
        for file, inside in pressed or files
    ]
