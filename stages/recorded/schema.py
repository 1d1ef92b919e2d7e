"""The settings of the recorded stage, and what its rows hold."""

from dataclasses import dataclass
from pathlib import Path

COLUMNS = {
    "classifier": "a name of stages.classification.CLASSIFIERS, or majority: always the commonest answer",
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

    kind: str  # what was recorded: pressure_images, biotac_grasps; of other stages also vitac, vt60, bigs, schunk
    folder: str  # the folder or zip archive of the recordings
    repetitions: int  # random splits, and sets of classes drawn at random

    def path(self, root: Path) -> Path:
        """Where the recordings lie; a relative folder counts from the repository root."""
        return root / Path(self.folder).expanduser()
