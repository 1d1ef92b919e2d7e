"""Touches that others recorded: T4.2.4's protocol on a real pressure array, slip and recognition by fingertips."""

from dataclasses import dataclass
from pathlib import Path

from stages.engine.settings import setting

COLUMNS = {
    "classifier": "a name of haptic_glance.know.CLASSIFIERS, or majority: always the commonest answer",
    "scaling": "of pressure images before the classifier: a name of haptic_glance.know.classifiers.SCALINGS",
    "repetition": "number of the random split, or of the drawn set of classes",
    "train": "touches trained on",
    "test": "touches tested on",
    "classes": "number of classes of the set",
    "chosen": "the classes of the set",
    "task": "of grasps: slip (does the object slip) or recognition (which object is it)",
    "palm": "of grasps: direction of the palm, or all",
    "scaled": "of grasps: by mean and deviation of the training part, or each part by its own",
    "components": "of grasps: principal components, or electrodes where there is no reduction",
    "count": "of grasps: grasps tested on",
}


@dataclass
class Params:
    """Section `recorded` of params.yaml; also what the other stages on recorded touches read."""

    kind: str = setting(
        "",
        "what was recorded: pressure_images, biotac_grasps, vitac, vt60 or bigs; conf/data says so",
    )
    folder: str = setting("", "the folder or zip archive of the recordings")
    repetitions: int = setting(
        20,
        "number of random splits, and of random sets of classes",
        least=1,
    )

    def path(self, root: Path) -> Path:
        """The folder of the recordings; a relative folder counts from the repository root."""
        return root / Path(self.folder).expanduser()
