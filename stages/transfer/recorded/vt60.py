"""VT-60 (T5.1.2): 60 objects of ten classes, touched with the BathTip sensor and photographed.

Paper: Corradi, Hall, Iravani, Object recognition combining vision and touch, Robotics and Biomimetics 4(2), 2017, with
the data set's address; the sensor is that of their Bayesian tactile object recognition, ICRA 2015 (T [107]).
Layout, from the first author's own code for this data set (deep_visuotactile_classification: tools/vt60_tools.py and
the paths printed in its notebooks): `touch/NN_CLASS/0I/*.jpg` and `vision/NN_CLASS/0I/*.jpg`, ten classes NN = 01 to 10
and six objects I = 1 to 6 of each; a touch is called `touch_I_img_J_name_OBJECT_at_X_Y_Z.jpg`, a photograph
`IMG_inst_I_img_J_validframeID_F.jpg`. The folders and counts are certain. The names of classes 02 to 10 are not known
here, so a class is named by the text after its number.
To get it: download the data from the link in the paper, unpack it, and give the folder that holds
`touch` and `vision`.
"""

import re
from pathlib import Path

from .touches import SIZE, Recorded, collect, existing_folder, pictures

LAYOUT = "VT-60: touch/NN_CLASS/0I/*.jpg and vision/NN_CLASS/0I/*.jpg, classes 01 to 10, objects 01 to 06 of each"
SENSES = {"touch": "touch", "camera": "vision"}
CLASSES, OBJECTS = 10, 6


def read_vt60(path: str | Path, sense: str = "touch", size: int = SIZE) -> Recorded:
    """The Recorded of VT-60, sense `touch` or `camera`; groups: the object, CLASS/0I, as the authors split it.

    Pictures are not cropped, and resized to size x size pixels. Raises ValueError that names the first folder or
    picture missing.
    """
    if sense not in SENSES:
        raise ValueError(f"unknown sense {sense!r}, known: {', '.join(SENSES)}")
    root = existing_folder(existing_folder(path, LAYOUT) / SENSES[sense], LAYOUT)
    files = {}
    for number in range(1, CLASSES + 1):
        home = _class_folder(root, number)
        name = home.name.partition("_")[2]
        files[name] = []
        for instance in range(1, OBJECTS + 1):
            here = existing_folder(home / f"{instance:02d}", LAYOUT)
            files[name] += [(file, f"{name}/{here.name}") for file in pictures(here, LAYOUT)]
    return collect(files, size)


def _class_folder(root, number):
    found = [home for home in sorted(root.iterdir()) if re.match(rf"{number:02d}_.", home.name)]
    if len(found) != 1:
        raise ValueError(f"{root} holds {len(found)} folders {number:02d}_CLASS, one is needed; expected is {LAYOUT}")
    return found[0]
