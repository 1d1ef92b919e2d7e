"""Readers of recorded touches for networks, each with a `Recorded` as its result.

`read_bigs`, BiGS (T5.1.4): a Barrett hand with three BioTac fingertips grasps a box, a ball and a cylinder. Paper:
Chebotar, Hausman, Su, Molchanov, Kroemer, Sukhatme, Schaal, BiGS: BioTac grasp stability dataset, ICRA 2016 workshop on
grasping and manipulation datasets (T [104]); each finger has 19 electrodes, sampled at 100 Hz. The layout of the
published files is not known here, so a plain layout is read: `OBJECT/success/GRASP/FINGER.csv`, OBJECT one of box,
ball, cylinder, GRASP any name, three fingers, each a table without a header, one sample per line, with the readings of
electrodes 1 to 19 in columns separated by commas. Other folders than `success`, such as `failure`, are ignored, as in
the thesis. To get it: download the data set from the authors' page named in the paper, and write the electrode readings
of each finger of each grasp into such a table.

`grasp_images`: grasps by BioTac SP fingertips as colour images, one finger per channel, similar to BiGS. BiGS has a
series of 700 samples per finger, BTS3 one instant of 24 electrodes. So the electrodes are arranged as on the finger and
the gaps are filled. As there, three parts make the three colours.

`read_vitac`, ViTac (T5.1.1): pieces of cloth, pressed by a GelSight sensor and photographed from above. Paper: Luo,
Yuan, Adelson, Cohn, Fuentes, ViTac: feature sharing between vision and tactile sensing for cloth texture recognition,
ICRA 2018 (T [106]), 100 pieces of cloth. Two layouts:
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

`read_vt60`, VT-60 (T5.1.2): 60 objects of ten classes, touched with the BathTip sensor and photographed. Paper:
Corradi, Hall, Iravani, Object recognition combining vision and touch, Robotics and Biomimetics 4(2), 2017, with the
data set's address; the sensor is that of their Bayesian tactile object recognition, ICRA 2015 (T [107]). Layout, from
the first author's own code for this data set (deep_visuotactile_classification: tools/vt60_tools.py and the paths
printed in its notebooks): `touch/NN_CLASS/0I/*.jpg` and `vision/NN_CLASS/0I/*.jpg`, ten classes NN = 01 to 10 and six
objects I = 1 to 6 of each; a touch is called `touch_I_img_J_name_OBJECT_at_X_Y_Z.jpg`, a photograph
`IMG_inst_I_img_J_validframeID_F.jpg`. The folders and counts are certain. The names of classes 02 to 10 are not known
here, so a class is named by the text after its number. To get it: download the data from the link in the paper, unpack
it, and give the folder that holds `touch` and `vision`.

`pressure_images`: real pressure images (28 x 50 cells). A series of readings of a finger's cells becomes one picture of
all readings or of one instant (T5.1.4).
"""

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from PIL import Image
from scipy.interpolate import griddata

from haptic_glance.base.files import open_picture
from stages.classification.touch_readers import Grasps

PICTURES = (".jpg", ".jpeg", ".png", ".bmp")
SIZE = 224  # pixels a side to which camera pictures are resized: the input size of the networks


@dataclass(frozen=True, eq=False)
class Recorded:
    """Recorded touches as images; those of one class and group are in the order of the recording.

    images (k, r, c) u1 of one channel or (k, r, c, 3) u1; labels (k,) i8 into classes; groups (k,) strings: the object
    or the recording that a touch belongs to, so that a split can keep it together, or None where it is not known.
    Raises ValueError for parts that do not fit together, fewer than two classes, or a class without touches.
    """

    images: np.ndarray
    labels: np.ndarray
    classes: list[str]
    groups: np.ndarray | None

    def __post_init__(self) -> None:
        shape = self.images.shape
        if self.images.dtype != np.uint8 or len(shape) not in (3, 4) or shape[3:] not in ((), (3,)):
            raise ValueError(f"images must be u1 of shape (k, r, c) or (k, r, c, 3), got {self.images.dtype} {shape}")
        if len(self.labels) != len(self.images) or (self.groups is not None and len(self.groups) != len(self.images)):
            raise ValueError(f"{len(self.images)} images need as many labels and groups")
        counts = np.bincount(self.labels, minlength=len(self.classes))
        if len(self.classes) < 2 or len(counts) > len(self.classes) or not counts.all():
            empty = [name for name, count in zip(self.classes, counts, strict=False) if not count]
            raise ValueError(
                f"two classes or more are needed, each with touches; classes without any: {', '.join(empty) or '-'}"
            )


def collect(files: Mapping[str, Sequence[tuple[Path, str]]], size: int) -> Recorded:
    """The Recorded of pictures: files {class: [(file, group)]}, resized to size x size pixels in colour."""
    pairs = [pair for group in files.values() for pair in group]
    return Recorded(
        images=np.stack([read_picture(file, size) for file, _ in pairs]),
        labels=np.repeat(np.arange(len(files)), [len(group) for group in files.values()]),
        classes=list(files),
        groups=np.array([group for _, group in pairs]),
    )


def read_picture(file: Path, size: int) -> np.ndarray:
    """(size, size, 3) u1: a picture file; raises ValueError, which names the file, where it is not a picture."""
    image = open_picture(file.read_bytes(), file)
    if image.mode.startswith("I"):  # 16 bits of grey, which convert would cut off at 255
        image = Image.fromarray((np.asarray(image) >> 8).astype(np.uint8))
    return np.asarray(image.convert("RGB").resize((size, size), Image.Resampling.BILINEAR))


def existing_folder(path: str | Path, layout: str) -> Path:
    """The folder of an unpacked data set; raises ValueError where it is not one. layout: what it must hold."""
    path = Path(path)
    if not path.is_dir():
        raise ValueError(f"{path} is not a folder: give the unpacked {layout}")
    return path


def pictures(path: Path, layout: str, anywhere: bool = False) -> list[Path]:
    """The pictures in a folder (or anywhere below it), sorted by name; raises ValueError where there are none."""
    files = [file for file in (path.rglob("*") if anywhere else path.glob("*")) if file.suffix.lower() in PICTURES]
    if not files:
        raise ValueError(f"{path} holds no picture ({' '.join(PICTURES)}); expected is {layout}")
    return sorted(files, key=natural_key)


def natural_key(file: Path) -> tuple[str, list[int], str]:
    """A sort key for file names by the numbers in them: 2 before 10."""
    digits = "".join(letter if letter.isdigit() else " " for letter in file.stem).split()
    return str(file.parent), [int(number) for number in digits], file.name


BIGS_LAYOUT = "BiGS: OBJECT/success/GRASP/FINGER.csv, OBJECT box, ball, cylinder, three fingers, 19 columns, 700 lines"
OBJECTS = ("ball", "box", "cylinder")
FINGERS, ELECTRODES = 3, 19
SAMPLES = 700  # 7 x 3 cells x 700 samples are 70 x 70 x 3 numbers
GRID = [  # electrodes from above, tip first, in columns by their position y = +, 0, - on the finger; 0: none
    [9, 7, 8], [11, 10, 1], [12, 17, 2], [13, 0, 3], [14, 0, 4], [15, 18, 5], [16, 19, 6],
]  # fmt: skip


def read_bigs(path: str | Path, instant: bool = False) -> Recorded:
    """The Recorded of BiGS: one 70 x 70 x 3 image per finger of a successful grasp; groups: the grasp, OBJECT/GRASP.

    A finger's readings minus its first are arranged in 7 x 3 cells, cut to the first 700 samples, and reshaped.
    instant: 7 x 3 of one instant instead, on which the thesis's networks failed (T5.1.4, T5.4). Raises ValueError that
    names what is missing.
    """
    root, series, labels, groups = existing_folder(path, BIGS_LAYOUT), [], [], []
    for label, name in enumerate(OBJECTS):
        for grasp in sorted(existing_folder(root / name / "success", BIGS_LAYOUT).iterdir()):
            fingers = sorted(grasp.glob("*.csv"))
            if len(fingers) != FINGERS:
                raise ValueError(
                    f"{grasp} holds {len(fingers)} tables, {FINGERS} are needed; expected is {BIGS_LAYOUT}"
                )
            series += [_changes(file) for file in fingers]
            labels += [label] * FINGERS
            groups += [f"{name}/{grasp.name}"] * FINGERS
    if not series:
        raise ValueError(f"{root} holds no grasp; expected is {BIGS_LAYOUT}")
    picture = strongest_instant if instant else colour_image
    images = np.stack([picture(grey) for grey in as_grey(np.stack(series))])
    return Recorded(images, np.array(labels), list(OBJECTS), np.array(groups))


def electrode_grid(readings: np.ndarray) -> np.ndarray:
    """(n, 7, 3): readings (n, 19) of the electrodes as a tactile image of n instants (T figure 5.2b).

    Follows the electrodes' positions in the manufacturer's manual: five in the middle column, seven on each side. The
    two cells of the middle column without an electrode get the mean of their neighbours on both sides. The thesis names
    the 7 x 3 image but not the order of its cells, which is chosen here.
    """
    grid = np.array(GRID)
    image = readings[:, np.maximum(grid - 1, 0)].astype(np.float32)
    for row in np.flatnonzero(grid[:, 1] == 0):
        image[:, row, 1] = image[:, row, [0, 2]].mean(axis=1)
    return image


def _changes(file):
    """(7, 3, 700) f4: how a finger's readings differ from its first."""
    try:
        readings = np.loadtxt(file, delimiter=",", ndmin=2)
    except ValueError as error:
        raise ValueError(f"{file} is not a table of numbers ({error}); expected is {BIGS_LAYOUT}") from None
    if readings.shape[1] != ELECTRODES or len(readings) < SAMPLES or not np.isfinite(readings).all():
        lines, columns = readings.shape
        raise ValueError(
            f"{file}: {lines} lines of {columns} numbers, all finite; expected is {BIGS_LAYOUT}, or remove it"
        )
    return np.moveaxis(electrode_grid(readings[:SAMPLES] - readings[0]), 0, 2)


CELLS = (12, 11)
# Where electrodes 1 to 24 of a BioTac SP lie in 12 rows and 11 columns: the distribution of 12 x 11 cells in the code
# with Zapata-Impata, Gil, Torres, Non-matrix tactile sensors: how can be exploited their local connectivity for
# predicting grasp stability?, IROS 2018 workshop RoboTac (biotac-sp-images: code/Dataset Processing).
ROWS = [0, 1, 4, 5, 6, 7, 8, 9, 10, 11, 0, 1, 4, 5, 6, 7, 8, 9, 10, 11, 2, 3, 3, 5]
COLUMNS = [1, 2, 0, 1, 3, 0, 1, 4, 2, 1, 9, 8, 10, 9, 7, 10, 9, 6, 8, 9, 5, 4, 6, 5]
DEVIATIONS = 3  # standard deviations of an electrode's readings within the range of grey values
TARGETS = ("objects", "slipped")


def grasp_images(grasps: Grasps, target: str = "objects") -> Recorded:
    """The Recorded of Grasps (`touch_readers.read_grasps`): images (k, 12, 11, 3), groups: the object.

    target: the classes, `objects` for the grasped objects or `slipped` for `slipped` and `stable`. Red is the first
    finger, green the middle one, blue the thumb. Each electrode's readings are scaled by their own mean and deviation
    over the grasps of objects that the authors do not keep for testing (no label is used); grey 128 is the mean. Values
    are interpolated linearly between the electrodes and are those of the nearest one outside. Sorted by object and
    palm, then as in the files, whatever the target.
    """
    if target not in TARGETS:
        raise ValueError(f"unknown target {target!r}, known: {', '.join(TARGETS)}")
    names = grasps.objects if target == "objects" else np.where(grasps.slipped, "slipped", "stable")
    order = np.lexsort((np.arange(len(names)), grasps.palms, grasps.objects))
    classes, labels = np.unique(names[order], return_inverse=True)
    images = electrode_images(_scaled(grasps)[order])
    return Recorded(images, labels.astype(np.int64), classes.tolist(), grasps.objects[order])


def electrode_images(values: np.ndarray) -> np.ndarray:
    """(k, 12, 11, 3) u1: values (k, 72) in -1..1 of three fingers, 24 electrodes each, as images; 0 is grey 128."""
    fingers = np.asarray(values).reshape(-1, 3, 24) @ _filling().T
    grey = np.round(128 + 127 * np.clip(fingers, -1, 1)).astype(np.uint8)
    return np.moveaxis(grey.reshape(-1, 3, *CELLS), 1, 3)


def _scaled(grasps):
    """(n, 72) in -1..1 for readings within DEVIATIONS."""
    training = grasps.electrodes[~grasps.test]
    spread = training.std(axis=0)
    return (grasps.electrodes - training.mean(axis=0)) / (DEVIATIONS * np.where(spread > 0, spread, 1))


def _filling():
    """(132, 24): the weight of each electrode in the value of a cell."""
    positions, cells = np.transpose([ROWS, COLUMNS]), np.indices(CELLS).reshape(2, -1).T
    linear, nearest = (griddata(positions, np.eye(len(positions)), cells, method=how) for how in ("linear", "nearest"))
    return np.where(np.isnan(linear), nearest, linear)


VITAC_LAYOUT = (
    "ViTac: a folder of pictures per cloth, 11t and 11v (or CD0011 and vis0011) for the cloth 11 by touch and camera"
)
TOUCHED = re.compile(r"(\d+)t(?:_test)?|CD(\d+)")  # folders of a cloth by touch


def read_vitac(path: str | Path, size: int = SIZE) -> Recorded:
    """The Recorded of ViTac by touch; classes are cloths by number; groups: the recording.

    Pictures are resized to size x size pixels. A group is the larger picture or the film that a picture was cut from,
    according to its name. Raises ValueError that names what is missing.
    """
    homes = {}
    for home in sorted(existing_folder(path, VITAC_LAYOUT).iterdir()):
        if match := TOUCHED.fullmatch(home.name):
            homes.setdefault(int(match[1] or match[2]), []).append(home)
    if len(homes) < 2:
        raise ValueError(f"{path} holds {len(homes)} folders of cloths by touch; expected is {VITAC_LAYOUT}")
    return collect({str(number): _cloth(number, homes[number]) for number in sorted(homes)}, size)


def _cloth(number, homes):
    files = [(file, file.relative_to(home)) for home in homes for file in pictures(home, VITAC_LAYOUT, anywhere=True)]
    press_files = [pair for pair in files if "press" in str(pair[1]).lower()]
    return [
        (file, f"{number}/{inside.with_name(file.stem.rpartition('_')[0] or file.stem).as_posix()}")
        for file, inside in press_files or files
    ]


VT60_LAYOUT = "VT-60: touch/NN_CLASS/0I/*.jpg and vision/NN_CLASS/0I/*.jpg, classes 01 to 10, objects 01 to 06 of each"
CLASSES, VT60_OBJECTS = 10, 6


def read_vt60(path: str | Path, size: int = SIZE) -> Recorded:
    """The Recorded of VT-60 by touch; groups: the object, CLASS/0I, as the authors split it.

    Pictures are not cropped, and resized to size x size pixels. Raises ValueError that names the first folder or
    picture missing.
    """
    root = existing_folder(existing_folder(path, VT60_LAYOUT) / "touch", VT60_LAYOUT)
    files = {}
    for number in range(1, CLASSES + 1):
        home = _class_folder(root, number)
        name = home.name.partition("_")[2]
        files[name] = []
        for instance in range(1, VT60_OBJECTS + 1):
            folder = existing_folder(home / f"{instance:02d}", VT60_LAYOUT)
            files[name] += [(file, f"{name}/{folder.name}") for file in pictures(folder, VT60_LAYOUT)]
    return collect(files, size)


def _class_folder(root, number):
    homes = [home for home in sorted(root.iterdir()) if re.match(rf"{number:02d}_.", home.name)]
    if len(homes) != 1:
        raise ValueError(
            f"{root} holds {len(homes)} folders {number:02d}_CLASS, one is needed; expected is {VT60_LAYOUT}"
        )
    return homes[0]


SPREAD = 0.99  # share of the readings within the range of grey values; the others are clipped


def as_grey(changes: np.ndarray) -> np.ndarray:
    """Changes of readings, of any shape, as u1: grey 128 is no change, and one factor scales the whole set."""
    span = np.quantile(np.abs(changes), SPREAD) or 1
    return np.round(128 + 127 * np.clip(changes / span, -1, 1)).astype(np.uint8)


def colour_image(series: np.ndarray) -> np.ndarray:
    """(side, side, 3): a tactile series (rows, columns, samples) as one colour image, by Matlab's reshape (T5.1.4).

    In Matlab the first axis varies fastest. Of BiGS's 7 x 3 x 700 values, that of row r, column c, sample t has index
    n = r + 7 c + 21 t, and pixel (i, j) of channel k has index n = i + 70 j + 4900 k. So the colours are the three
    thirds of the seven seconds, 233 1/3 samples each. The 21 cells of a sample are below one another, and a column of
    pixels has 3 1/3 samples. Raises ValueError for a number of values that is not three times a square.
    """
    series = np.asarray(series)
    side = math.isqrt(series.size // 3)
    return series.reshape(side, side, 3, order="F")


def strongest_instant(series: np.ndarray) -> np.ndarray:
    """(rows, columns): the instant of a series (rows, columns, samples) u1 whose grey differs most from 128.

    The thesis takes readings "acquired while grasping" and does not say which (T5.1.4); this one has the most to tell.
    """
    change = np.abs(series.astype(np.int64) - 128).sum(axis=(0, 1))
    return series[..., change.argmax()]


def pressure_images(touches: Mapping[str, np.ndarray]) -> Recorded:
    """The Recorded of {class: (k, rows, columns) in 0..1}, as stages.classification's read_pressure_images returns.

    Gandarias, Garcia-Cerezo, Gomez-de-Gabriel, IEEE Sensors Journal 19(16), 2019: 22 classes, 50 touches each. groups
    is None: the recordings that touches belong to are not published. Touches with neighbouring numbers are similar, so
    runs of them can be held out.
    """
    return Recorded(
        images=np.round(255 * np.concatenate(list(touches.values()))).astype(np.uint8),
        labels=np.repeat(np.arange(len(touches)), [len(images) for images in touches.values()]),
        classes=list(touches),
        groups=None,
    )
