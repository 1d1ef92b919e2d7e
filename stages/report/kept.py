"""Figures of data sets that the default run leaves out: drawn where their data is, and kept in the repository."""

from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

from matplotlib.figure import Figure as Drawing

from haptic_glance.base.files import read_json, write_json

from .items import Figure
from .results import NotRun, Results, there


class Kept(Figure):
    """A figure whose words stand beside it in NAME.json, so that both outlast the data; drawing empty: they did."""

    def write(self, folder: Path) -> None:
        """Writes NAME.png and NAME.json, where there is something new."""
        words = folder / f"{self.name}.json"
        if self.drawing.axes:
            super().write(folder)
            write_json(words, self.words)
        self.paths = [words.with_suffix(".png"), words]


def last_drawn(results: Results, name: str, stage: str) -> Kept:
    """The figure as it was drawn last time; NotRun where it never was."""
    here = results.out if (results.out / f"figures/{name}.json").exists() else results.reports
    words = here / f"figures/{name}.json"
    why = f"no figures/{name}.png: run the stage {stage} on its data set"
    there(words.with_suffix(".png"), why, stage, runnable=False)
    return Kept(Drawing(), read_json(there(words, why, stage, runnable=False)))


def as_printed(build: Callable[[Results], Figure], dataset: str, results: Results, stage: str = "lod") -> Figure:
    """The figure on the set of a protocol as printed, where that set is the first; else as it was drawn there.

    Where it never was, or of one's own meshes, it is of the first set. `build` has the figure's name.
    """
    if results.sets[:1] == [dataset]:
        figure = build(results)
        return Kept(figure.drawing, figure.words, dpi=figure.dpi)
    if not results.own_meshes:
        with suppress(NotRun):
            found = last_drawn(results, build.__name__, stage)
            results.read.add(dataset)
            return found
    return build(results)
