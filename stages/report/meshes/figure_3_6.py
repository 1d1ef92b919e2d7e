"""T figure 3.6: the points of every detector on one object."""

from stages.report.drawing import show, square_grid
from stages.report.items import Figure
from stages.report.results import Results
from stages.report.style import save

NAMES = {  # the thesis's, in its order; then those of later sections, ours and chance
    "harris": "3DH", "mesh_saliency": "MS", "salient_points": "SP", "corners": "SDC", "sift": "3DS",
    "VisAttCurvP": "VisAttCurvP", "VisAttAll": "VisAttAll", "VisAttSymP": "VisAttSymP", "VisAttEnt": "VisAttEnt",
    "Curv": "Curv", "VisAttCurv": "VisAttCurv", "VisAttCurvSym": "VisAttCurvSym", "VisAttSym": "VisAttSym",
    "VisAttCurvSymCon": "VisAttCurvSymCon", "itti": "VisAtt", "VisAttCon": "VisAttCon", "2Sym": "2Sym",
    "SymLat": "SymLat", "heat_kernel": "HKS", "SymRad": "SymRad",
    "guided_ed": "ED", "guided_ssim": "SSIM", "thesis_ssim": "SSIM, table 3.1", "svm": "SVM", "enhanced": "ours",
    "random": "blind",
}  # fmt: skip
COLUMNS = 7


def build(results: Results) -> Figure:
    name = results.choose(results.settings.figure_objects, 1)[0]
    found, mesh = results.strong_points(name), results.mesh(name)
    methods = found.those_of(list(NAMES))
    down = -(-len(methods) // COLUMNS)
    figure, grid = square_grid(down, COLUMNS, side=1.6, gap=0.3)
    for axes, method in zip(grid.flat, methods, strict=False):
        show(axes, mesh, points=found[method])
        axes.set_title(f"{NAMES[method]}: {len(found[method])}", fontsize=9, fontweight="normal", loc="center", pad=3)
    for axes in grid.flat[len(methods) :]:
        axes.set_axis_off()
    path = save(figure, results.reports / "figures/figure_3_6.png")
    few, many = (pick(methods, key=lambda method: len(found[method])) for pick in (min, max))
    return Figure(
        "Figure 3.6: the points of each detector",
        f"{len(methods)} pictures of {name}, each with the points of one detector.",
        f"{name}, in the thesis's order and by its short names, then those of later sections, ours and chance; the "
        "number is that of all points that pass the detector's own threshold, "
        f"from {len(found[few])} ({NAMES[few]}) to "
        f"{len(found[many])} ({NAMES[many]}). Red: those on the side that is seen.",
        [path],
    )
