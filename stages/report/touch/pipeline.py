"""The whole pipeline on one object, for the README."""

from stages.report.drawing import show, vivid
from stages.report.items import Figure
from stages.report.results import NotRun
from stages.report.style import GREY, INK, PALE, label, plt, save

from .bars import draw_bars
from .one_touch import table_4_1, table_4_2
from .rows import at_random

STEPS = [
    "1  See it",
    "2  Find what stands out",
    "3  Spend the faces there",
    "4  Touch it there",
    "5  Know what it is",
]
NEEDED = ["random", "itti", "enhanced"]  # bars
LEFT = [0.0, 0.2, 0.41, 0.63, 0.84]  # of the panels, as parts of the figure's width
WIDTH, SIDE = 0.17, 3  # of a panel; imprints a side
SIZE = (16, 3.9)  # inches


def build(results):
    name = results.choose([results.settings.hero_object], 1, stage="imprints")[0]
    mesh, (_, coarse) = results.mesh(name), results.lods(name, "enhanced-soft")[-1]
    accuracy, classes = _accuracy(results)
    points = results.strong_points(name)["enhanced"]
    figure = plt.figure(figsize=SIZE)
    height = WIDTH * SIZE[0] / SIZE[1]
    panels = [figure.add_axes([left, 0.12, WIDTH, height]) for left in LEFT]
    for left, step in zip(LEFT, STEPS, strict=True):
        figure.text(left, 0.92, step, fontsize=13, fontweight="bold", color=INK)
    show(panels[0], mesh, rows=800)
    show(panels[1], mesh, vivid(results.saliency(name)["enhanced"]), points=points, rows=800)
    show(panels[2], coarse, wires=True, rows=800)
    _imprints(panels[3], results.imprints(name)["enhanced"])
    places = draw_bars(panels[4], accuracy, ["knn"], chance=1 / classes)
    names = [label(name).partition(" (")[0].replace(" ", "\n") for name in places]
    panels[4].set_xticks(list(places.values()), names, fontsize=9)
    panels[4].set_title(f"kNN, one touch, {classes} objects", fontsize=9.5, fontweight="normal", color=GREY, pad=4)
    words = [
        name,
        "saliency, and where to touch",
        f"{len(mesh.faces):,} faces become {len(coarse.faces):,}",
        "what a pressure array feels (black: first)",
    ]
    for left, said in zip(LEFT, words, strict=False):
        figure.text(left, 0.03, said, fontsize=10, color=GREY)
    path = save(figure, results.reports / "figures/pipeline.png", dpi=120)
    return Figure(
        "From sight to touch",
        f"Five steps on {name}: its render; its surface coloured by saliency with points; a simplified mesh; nine "
        "tactile imprints; bars of recognition accuracy for blind and guided touch.",
        f"Steps 1 to 4 show {name}; step 5 is kNN on one touch of {classes} objects; diamonds: the thesis.",
        [path],
    )


def _imprints(panel, images):
    panel.set_axis_off()
    for place, image in enumerate(images[: SIDE * SIDE]):
        down, across = divmod(place, SIDE)
        cell = panel.inset_axes([across / SIDE, 1 - (down + 1) / SIDE, 0.94 / SIDE, 0.94 / SIDE])
        cell.imshow(image, cmap="gray", vmin=0, vmax=1)
        cell.set(xticks=[], yticks=[])
        for spine in cell.spines.values():
            spine.set(visible=True, color=PALE, linewidth=0.6)


def _accuracy(results):
    """(tidy table, number of objects): of the group six, or of four where there is no six."""
    try:
        name, frame = "six", table_4_1(results).frame
    except NotRun:
        name, frame = "four", table_4_2(results).frame
    for method in NEEDED:  # a picture of only some of them would mislead
        at_random(results, group=name, classifier="knn", variant="plain", method=method)
    return frame, results.classes(name)
