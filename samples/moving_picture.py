"""Makes moving_picture.webp of the README: a sample mesh from look to name. `python samples/moving_picture.py` (needs
[pipeline] and the household meshes that `make repro` leaves in data/). Only what is measured is drawn: the beliefs are
those of haptic_glance.know at the places that people look at first."""

from pathlib import Path

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from PIL import Image

from haptic_glance import find_points, saliency, simplify
from haptic_glance.gallery.demo import sample
from haptic_glance.know import Belief, known_objects, learn, stand
from haptic_glance.lod.mesh_pictures import vivid
from haptic_glance.look.camera import Viewpoint
from haptic_glance.mesh import Mesh, load, normalise, rotate_to_z_up
from haptic_glance.touch import Surface, sensor_normals
from stages.charts.drawing import picture, visible

OUT = Path(__file__).with_name("moving_picture.webp")
HOUSEHOLD = Path("data/household/meshes")
NAME = "dromedary"
SIZE, DPI = (7.2, 3.2), 100  # inches of a frame; pixels an inch
ROWS, ZOOM = 420, (slice(36, 392), slice(32, 388))  # of the picture, and the part that shows the mesh at every turn
FRAME, HOLD = 90, 1800  # milliseconds of a frame, of the last one of a step
LEVELS = (2000, 500)
PLACES, SHOWN = 15, 6  # places that people look at; names in the chart of beliefs
AWAY, NEAR = 0.8, 0.02  # diameters: where the hand starts from a place, and how near to it it must arrive
INK, GREY, BLUE, RED = "#222222", "#767676", "#0072B2", "#D81B1B"


class Film:
    """Frames and how long each is shown."""

    def __init__(self) -> None:
        self.frames: list[Image.Image] = []
        self.milliseconds: list[int] = []

    def add(self, image: np.ndarray, step: str, text: str, milliseconds: int = FRAME, panel=None, dots=()) -> None:
        """One frame: the mesh's picture on the left with dots (row, column, label), words and a panel on the right."""
        figure = Figure(figsize=SIZE, dpi=DPI)
        canvas = FigureCanvasAgg(figure)
        axes = figure.add_axes((0, 0, SIZE[1] / SIZE[0], 1))
        axes.imshow(image[ZOOM], interpolation="bilinear")
        axes.set_axis_off()
        for row, column, label in dots:
            place = column - ZOOM[1].start, row - ZOOM[0].start
            axes.plot(*place, "o", color=RED, ms=11, mec="white", mew=1)
            axes.text(*place, label, color="white", fontsize=7, ha="center", va="center_baseline")
        figure.text(0.47, 0.86, step, fontsize=17, fontweight="bold", color=INK)
        figure.text(0.47, 0.76, text, fontsize=11, color=GREY)
        if panel:
            panel(figure)
        canvas.draw()
        self.frames.append(Image.fromarray(np.asarray(canvas.buffer_rgba())[..., :3].copy()))
        self.milliseconds.append(milliseconds)

    def write(self, path: Path) -> None:
        """Writes the animation."""
        first, *others = self.frames
        first.save(path, save_all=True, append_images=others, duration=self.milliseconds, loop=0, quality=62, method=6)


def main() -> None:
    """Draws all steps."""
    mesh = normalise(rotate_to_z_up(load(sample())))
    mesh = Mesh(mesh.vertices, mesh.faces)  # as clay
    values, film = saliency(mesh), Film()
    looks(film, mesh, values)
    levels(film, mesh, values)
    touches(film, mesh, values)
    film.write(OUT)
    print(f"{OUT}: {len(film.frames)} frames, {OUT.stat().st_size / 1e3:.0f} kB")


def view(turn: float = 0.0) -> Viewpoint:
    """The viewpoint of all steps, turned by some degrees."""
    return Viewpoint(310 + turn, 18)


def looks(film: Film, mesh: Mesh, values: np.ndarray) -> None:
    """The mesh turns once; then the colours of where people look come."""
    for turn in np.arange(0, 360, 20):
        film.add(picture(mesh, viewpoint=view(turn), rows=ROWS), "A mesh", f"{len(mesh.faces):,} faces")
    clay, seen = (picture(mesh, colours, viewpoint=view(), rows=ROWS) for colours in (None, vivid(values)))
    for share in np.linspace(0, 1, 9):
        film.add((1 - share) * clay + share * seen, "Where people look", "predicted by a model of human gaze")
    film.milliseconds[-1] = HOLD


def levels(film: Film, mesh: Mesh, values: np.ndarray) -> None:
    """Fewer and fewer faces, finer where people look."""
    for faces in (None, *LEVELS):
        small = simplify(mesh, faces, weights=values) if faces else mesh
        image = picture(small, wires=True, viewpoint=view(), rows=ROWS)
        film.add(image, "Fewer faces", f"{len(small.faces):,} of {len(mesh.faces):,}, finer where people look", HOLD)


def touches(film: Film, mesh: Mesh, values: np.ndarray) -> None:
    """Touches at the places that people look at first, and the belief after each."""
    objects, _ = known_objects(HOUSEHOLD)
    if not objects:  # the dromedary alone would be known before the first touch
        raise SystemExit(f"no meshes in {HOUSEHOLD}: `dvc repro meshes@household` fetches them")
    library, there = learn({NAME: mesh, **objects}), stand(mesh)
    surface, belief = Surface(there), library.belief()
    seen = picture(mesh, vivid(values), viewpoint=view(), rows=ROWS)
    points = find_points(mesh, count=PLACES)
    dots: list[tuple] = []
    for vertex, normal in zip(points, sensor_normals(there, points), strict=True):
        approach = library.approach(there.vertices[vertex] + AWAY * normal, -normal)
        travel, imprint = approach.feel(surface)
        if abs(travel - AWAY) > NEAR:  # the hand meets another part first
            continue
        belief, k = belief.after(approach, travel, imprint), len(belief.touches) + 1
        rows, columns = visible(mesh, np.array([vertex]), view(), ROWS)
        dots += [(row, column, str(k)) for row, column in zip(rows, columns, strict=True)]

        def panel(figure: Figure, image: np.ndarray = imprint / approach.array.depth, belief: Belief = belief) -> None:
            show_imprint(figure, image)
            show_belief(figure, belief.probabilities)

        text = f"one of {len(library.names)} objects: a {belief.known}" if belief.known else "an array of 8 x 8 cells"
        step = f"Known after {k} touch{'es' * (k > 1)}" if belief.known else f"Touch {k}"
        film.add(seen, step, text, 2 * HOLD if belief.known else 900, panel, dots)
        if belief.known:
            return


def show_imprint(figure: Figure, image: np.ndarray) -> None:
    """What the array feels, unsmoothed; black is pressed first."""
    axes = figure.add_axes((0.47, 0.12, 0.24, 0.54))
    axes.imshow(image, cmap="gray", vmin=0, vmax=1)
    axes.set(xticks=[], yticks=[])
    figure.text(0.47, 0.04, "what it feels", fontsize=9, color=GREY)


def show_belief(figure: Figure, probabilities: dict[str, float]) -> None:
    """Bars of the likeliest objects."""
    axes = figure.add_axes((0.86, 0.12, 0.12, 0.54))
    names = list(probabilities)[:SHOWN]
    axes.barh(names, [100 * probabilities[name] for name in names], color=BLUE)
    axes.set(xlim=(0, 100), xticks=[0, 50, 100])
    axes.invert_yaxis()
    axes.tick_params(labelsize=8, length=0)
    axes.spines[["top", "right"]].set_visible(False)
    figure.text(0.86, 0.68, "belief, %", fontsize=9, color=GREY)


if __name__ == "__main__":
    main()
