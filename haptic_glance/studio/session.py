"""The state of one browser window. It is free of viser, so that it can be tested and outlives a lost connection."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from .specimen import Look, Specimen


@dataclass(frozen=True)
class Settings:
    """The options that the studio was started with, for all windows.

    files: what can be opened besides uploads. up: their axis, None for the files' own, or their shapes'. marks: the
    folder of the marks. panel: the one that is shown first, by its title.
    """

    files: Sequence[Path] = ()
    up: str | None = None
    marks: Path = Path("data/annotations")
    annotator: str = ""
    panel: str = "Look"


@dataclass
class Session:
    """specimen: the mesh on the table. method, other: of the saliency shown, and of the one beside it, if any.

    count: of points, None for the method's own. kept: what a panel keeps of this mesh, by its title; it is emptied when
    another mesh comes. For a page that is loaded again: panel, the title of the one shown; controls, their values;
    view, the camera's position (3,) and the place (3,) that it looks at.
    """

    specimen: Specimen | None = None
    method: str = "glance"
    other: str | None = None
    count: int | None = None
    kept: dict[str, Any] = field(default_factory=dict)
    panel: str = ""
    controls: dict[str, dict[str, Any]] = field(default_factory=dict)
    view: tuple[np.ndarray, np.ndarray] | None = None

    def put(self, specimen: Specimen) -> None:
        """Another mesh on the table, or the same one turned."""
        self.specimen, self.kept = specimen, {}

    @property
    def on_table(self) -> Specimen:
        """The Specimen; ValueError that says what to do where there is none."""
        if self.specimen is None:
            raise ValueError("there is no mesh yet: open or upload one first")
        return self.specimen

    def look(self) -> Look:
        """The Look of the chosen method at the mesh on the table."""
        return self.on_table.look(self.method, self.count)
