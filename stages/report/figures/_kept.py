"""Pictures of data that no run of this project has at hand: drawn once, where the data were, and kept in reports."""

import shutil
from pathlib import Path

from stages.kit.files import read_json, write_json
from stages.report.items import Figure
from stages.report.results import NotRun


def keep(figure, name, folder):
    """Copies a built Figure to FOLDER/NAME.png, and what is said of it to NAME.json."""
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    shutil.copyfile(figure.paths[0], folder / f"{name}.png")
    write_json(folder / f"{name}.json", {"title": figure.title, "alt": figure.alt, "caption": figure.caption})


def kept(results, name):
    """The Figure that `keep` left in reports/fixation, with its picture among the report's; NotRun where none is."""
    source = results.reports / "fixation" / f"{name}.png"
    if not source.exists():
        why = f"no fixation/{source.name}: `make fixation` draws it where the meshes with gaze are"
        raise NotRun(why, "fixation", runnable=False)
    path = results.reports / "figures" / f"{name}_gaze.png"
    path.parent.mkdir(parents=True, exist_ok=True)
    shutil.copyfile(source, path)
    said = read_json(source.with_suffix(".json"))
    return Figure(f"{said['title']}, on meshes with human gaze", said["alt"], said["caption"], [path])
