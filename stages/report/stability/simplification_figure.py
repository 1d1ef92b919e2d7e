"""Which broken meshes can be simplified to how few faces, by which backend, and how the error grows until it breaks."""

import numpy as np
from matplotlib.colors import ListedColormap
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from stages.report.items import Figure
from stages.report.results import Results
from stages.report.style import CYCLE, INK, PALE, label, plt, save
from stages.stability.qem_error_curve import LEAST_ERROR
from stages.stability.simplification import BUDGETS, KEPT_BUDGETS, OUTCOMES, SMALLEST
from stages.stability.specimen import KEPT

from .simplification import simplified

COLOURS = {"valid": "#9CD3C0", "refused": PALE, "ruined": "#D55E00", "crash": "#000000"}
STYLES = ("-", "--", ":")  # of the backends
LETTERS = {"valid": "", "refused": "–", "ruined": "×", "crash": "!"}
SHOWN = ("sound", "wide_holes", "fins", "needles", "islands", "noise_0.01", "snapped", "far")  # lines of the chart


def build(results: Results) -> Figure:
    cases = simplified(results)
    errors = results.rows("stability", metric="error")
    backends, damages = (list(dict.fromkeys(cases[column])) for column in ("method", "perturbation"))
    figure, grid = plt.subplots(
        2, len(backends) + 1, figsize=(5.2 * len(backends) + 4.6, 0.235 * len(damages) + 3.4), squeeze=False,
        gridspec_kw={"height_ratios": [0.235 * len(damages), 1.8], "hspace": 0.16, "wspace": 0.34},
    )  # fmt: skip
    plain = cases[(cases["kept"] == "none") & cases["soft"].isna()]
    kept = cases[(cases["kept"] != "none") & (cases["perturbation"] == "sound")]
    for backend, (upper, lower) in zip(backends, grid.T, strict=False):
        _squares(upper, plain[plain["method"] == backend], "perturbation", damages, [*BUDGETS, SMALLEST])
        upper.set_title(label(backend))
        _squares(lower, kept[kept["method"] == backend], "kept", list(KEPT)[1:], [*KEPT_BUDGETS, SMALLEST])
        lower.set_ylabel("vertices kept,\nsound object")
        lower.set_xlabel("faces asked for")
    _curves(grid[0, -1], errors[(errors["kept"] == "none") & errors["soft"].isna()], backends)
    grid[1, -1].set_axis_off()
    _legend(grid[1, -1], grid[0, -1], backends)
    path = save(figure, results.reports / "figures/stability_simplification.png")
    objects = ", ".join(dict.fromkeys(cases["item"]))
    return Figure(
        "Broken meshes, simplified",
        f"Grids of {len(damages)} kinds of damage against the faces asked for, coloured by outcome, and a chart of the "
        f"error against the faces, for {', '.join(map(label, backends))}.",
        f"The worst outcome over {objects}. Valid: the surface that came back passes every check; refused: an error "
        "says why there is none; ruined: it came back unsound. `smallest`: the face count that a refusal names; white: "
        "none was named. Chart: mean error of what came back, nothing kept, mean over the objects; crosses are ruined, "
        "and a line ends where every object is refused.",
        [path],
    )


def _squares(axes, cases, column, lines, budgets):
    """Coloured squares, a row a damage or kept set, a column a budget; the worst over the objects."""
    rank = cases.assign(rank=cases["outcome"].map(OUTCOMES.index))
    worst = rank.pivot_table(index=column, columns="budget", values="rank", aggfunc="max")
    worst = worst.reindex(lines, columns=budgets)
    axes.imshow(worst, cmap=ListedColormap([COLOURS[name] for name in OUTCOMES]), vmin=0, vmax=3, aspect="auto")
    for (down, across), value in np.ndenumerate(worst.to_numpy()):
        if value == value:
            name = OUTCOMES[int(value)]
            paint = "white" if name == "crash" else INK
            axes.text(across, down, LETTERS[name], ha="center", va="center", fontsize=9, color=paint)
    words = [f"{int(budget):,}" if budget.isdigit() else budget for budget in budgets]
    axes.set_xticks(range(len(budgets)), words, fontsize=8, rotation=30)
    axes.set_yticks(range(len(lines)), [label(line) for line in lines], fontsize=8)
    axes.set_xticks(np.arange(len(budgets) - 1) + 0.5, minor=True)
    axes.set_yticks(np.arange(len(lines) - 1) + 0.5, minor=True)
    axes.grid(which="minor", color="white", lw=1)
    axes.tick_params(which="both", length=0)
    axes.spines[:].set_visible(False)


def _curves(axes, errors, backends):
    for damage, colour in zip(SHOWN, CYCLE, strict=True):
        for backend, style in zip(backends, STYLES, strict=False):
            here = errors[(errors["perturbation"] == damage) & (errors["method"] == backend)]
            here = here[here["budget"] != SMALLEST].assign(percent=100 * here["value"].clip(lower=LEAST_ERROR))
            means = here.groupby("budget").agg({"severity": "mean", "percent": "mean"}).sort_values("severity")
            axes.plot(means["severity"], means["percent"], ls=style, marker=".", color=colour, lw=1.2)
            bad = here[here["outcome"] == "ruined"]
            axes.plot(bad["severity"], bad["percent"], "x", color=colour, ms=8, mew=1.6)
        axes.plot([], [], color=colour, label=label(damage))
    axes.set(xscale="log", yscale="log", xlabel="faces asked for", ylabel="mean error, % of the diagonal")
    axes.set_title("error until it breaks")
    axes.grid(True)


def _legend(axes, curves, backends):
    outcomes = [Patch(color=COLOURS[name], label=f"{name} {LETTERS[name]}") for name in OUTCOMES]
    pairs = zip(backends, STYLES, strict=False)
    styles = [Line2D([], [], color=INK, ls=style, label=label(name)) for name, style in pairs]
    axes.add_artist(axes.legend(handles=[*outcomes, *styles], loc="upper left", fontsize=8))
    axes.legend(*curves.get_legend_handles_labels(), loc="upper right", fontsize=8)
