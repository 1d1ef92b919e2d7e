"""T figure 3.34: the fused attention of networks on the surface, beside people and other models."""

from stages.report.drawing import colour_bar, show, square_grid, vivid
from stages.report.items import Figure
from stages.report.results import NotRun
from stages.report.style import label, save
from stages.report.tables._fixation import MODELS, NARROWED, spoken_network, stored, stored_networks, untrained

RIVALS = ("enhanced", "mesh_saliency")  # of stages.salient_points
COUNT = 4
ROWS = 260  # pixels a side of a picture


def build(results):
    names, marked = objects(results)
    files = {name: stored(results, name) for name in names}
    methods = [each for each in stored_networks(files[names[0]]) if f"{each}.{NARROWED}" in files[names[0]]]
    if not methods:
        raise NotRun(f"no fused maps of {names[0]}", "fixation", runnable=False)
    rivals = results.saliency(names[0]).those_of(RIVALS)
    titles = [f"EWIGC_L4\n{spoken_network(each).replace(', ', chr(10))}" for each in methods] + list(map(label, rivals))
    figure, grid = square_grid(len(names), bool(marked) + len(titles), side=1.6, right=0.9)
    for row, name in zip(grid, names, strict=True):
        mesh = results.mesh(name)
        for axes, values in zip(row, fields(results, name, files[name], methods, rivals, marked), strict=True):
            show(axes, mesh, vivid(values), rows=ROWS)
        row[0].text(-0.04, 0.5, name, rotation=90, va="center", ha="right", transform=row[0].transAxes)
    for axes, title in zip(grid[0], ([marked] if marked else []) + titles, strict=True):
        axes.set_title(title, fontsize=9, fontweight="normal", loc="center")
    colour_bar(figure, [0.945, 0.2, 0.012, 0.6], "over the 98 % quantile")
    said = {"marks": " Marks: by a vision model, no human subjects; spread along the surface."}.get(marked, "")
    controls = " Random weights: a control." if any(map(untrained, methods)) else ""
    return Figure(
        "Figure 3.34: fused attention on the surface",
        f"Meshes of {', '.join(names)}, coloured from dark (low) to yellow (high): {marked + ', ' if marked else ''}"
        f"{', '.join(title.replace(chr(10), ' ') for title in titles)}.",
        f"{MODELS[NARROWED]}: the highest of four levels of four tasks' maps, fused (T eq. 3.25), the mean over the "
        f"views that see a vertex. Each map over its own 98 % quantile.{controls}{said}",
        [save(figure, results.reports / "figures/figure_3_34.png", dpi=115)],
    )


def objects(results):
    """(names, what their truth is called): those with people's attention first; without any, None."""
    names = results.choose(results.settings.figure_objects, len(results.objects), "fixation")
    try:
        taught = set(results.taught(names, len(names)))
        dataset = results.measurements("fixation")["dataset"].iloc[0]
    except NotRun:
        return names[:COUNT], None
    found = [name for name in names if name in taught]
    return (found[:COUNT], "human gaze" if dataset == "gaze" else "marks") if found else (names[:COUNT], None)


def fields(results, name, arrays, methods, rivals, marked):
    """The saliencies (n,) of one row: people's where there are, the networks', the rivals'."""
    saliency = results.saliency(name)
    truth = [results.lesson(name)["density"]] if marked else []
    seen = [arrays[f"{method}.{NARROWED}"].astype(float) for method in methods]
    return [*truth, *seen, *(saliency[rival].astype(float) for rival in rivals)]
