"""What the sensor feels at the points of each method."""

from stages.report.items import Figure
from stages.report.style import PALE, label, plt, save

METHODS = ("random", "enhanced")
COUNT, TOUCHES = 4, 6


def build(results):
    names = results.choose(results.settings.figure_objects, COUNT, stage="imprints")
    methods = results.imprints(names[0]).those_of(METHODS)
    width = len(methods) * TOUCHES
    figure, grid = plt.subplots(len(names), width, figsize=(0.82 * width + 0.6, 0.92 * len(names) + 0.3), squeeze=False)
    for axes in grid.flat:
        axes.set_xticks([])
        axes.set_yticks([])
        for spine in axes.spines.values():
            spine.set(visible=True, color=PALE, linewidth=0.6)
    for down, name in enumerate(names):
        images = results.imprints(name)
        for block, method in enumerate(methods):
            for touch, image in enumerate(images[method][:TOUCHES]):
                grid[down, block * TOUCHES + touch].imshow(image, cmap="gray", vmin=0, vmax=1)
        grid[down, 0].set_ylabel(name, rotation=0, ha="right", va="center", labelpad=8)
    figure.subplots_adjust(wspace=0.06, hspace=0.06)
    for block, method in enumerate(methods):
        axes = grid[0, block * TOUCHES]
        axes.set_title(f"{label(method)}, first {TOUCHES} points", pad=6)
        for row in grid[:, block * TOUCHES :]:
            for one in row:
                box = one.get_position()
                one.set_position([box.x0 + 0.012 * (block > 0), box.y0, box.width, box.height])
    path = save(figure, results.reports / "figures/imprints.png")
    rows, columns = results.imprints(names[0])[methods[0]].shape[1:]
    return Figure(
        "Imprints",
        f"Rows of grey tactile images of {', '.join(names)}; " + " beside ".join(map(label, methods)) + ".",
        f"Simulated pressure array of {rows} x {columns} sensels; black is pressed first, white is farthest away.",
        [path],
    )
