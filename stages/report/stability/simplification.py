"""The outcome of simplifying broken meshes: valid, refused, ruined or crash, and how the error grows."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from stages.report.drawing import CYCLE, INK, PALE, label, plt
from stages.report.items import Figure, Table
from stages.report.results import Results
from stages.report.tables import grouped
from stages.stability.simplification import BUDGETS, KEPT_BUDGETS, OUTCOMES, SMALLEST
from stages.stability.surface import KEPT, LARGEST_ERROR, LEAST_ERROR, RUIN

STAGE = "stability"
COLOURS = {"valid": "#9CD3C0", "refused": PALE, "ruined": "#D55E00", "crash": "#000000"}
STYLES = ("-", "--", ":")  # of the backends
LETTERS = {"valid": "", "refused": "–", "ruined": "×", "crash": "!"}
SHOWN = ("sound", "wide_holes", "fins", "needles", "islands", "noise_0.01", "snapped", "far")  # lines of the chart


def table(results: Results) -> Table:
    """Cases by outcome, a line a kind of damage and simplifier; the fewest faces, and seconds of each."""
    cases = results.measured(STAGE, metric="faces")
    frame = pd.DataFrame([
        {"damage": damage, "backend": backend, **_outcomes(group)}
        for (damage, backend), group in grouped(cases, ["perturbation", "method"])
    ])  # fmt: skip
    count_columns = [*OUTCOMES, "smallest_named", "smallest_had"]
    total = frame.groupby("backend", sort=False)[count_columns].sum().reset_index().assign(damage="all", least=np.nan)
    text_rows = [
        {"damage": label(row["damage"]), "simplifier": label(row["backend"]), **{name: row[name] for name in OUTCOMES}}
        | {"least": row["least"], "smallest had": f"{row['smallest_had']} of {row['smallest_named']}"}
        for row in pd.concat([frame, total]).to_dict("records")
    ]  # fmt: skip
    valid = cases.loc[(cases["outcome"] == "valid") & (cases["budget"] != SMALLEST)].fillna({"soft": ""})
    keys, backends = ["item", "perturbation", "budget", "kept", "soft"], cases["method"].unique()
    means = valid.pivot_table("seconds", index=keys, columns="method").dropna().mean()  # of what all backends can
    times = [f"{label(peer)} {means[peer]:.4f} ({means[peer] / means[backends[0]]:.2g} times)" for peer in backends]
    objects = ", ".join(dict.fromkeys(cases["item"]))
    words = {"ruin": RUIN, "largest": 100 * LARGEST_ERROR, "objects": objects}
    return Table(frame, pd.DataFrame(text_rows), words | {"times": ", ".join(times)})


def _outcomes(cases: pd.DataFrame) -> dict[str, Any]:
    """One damage and backend: cases by outcome, fewest faces, median seconds, and why the worst case failed."""
    is_valid = cases.loc[cases["budget"] == SMALLEST, "outcome"] == "valid"
    bad = cases.loc[cases["outcome"].isin(OUTCOMES[1:])].sort_values("outcome", ascending=False)
    return {
        **{outcome: (cases["outcome"] == outcome).sum() for outcome in OUTCOMES}, "least": least_valid(cases),
        "smallest_named": len(is_valid), "smallest_had": sum(is_valid), "seconds": cases["seconds"].median(),
        "worst": next(iter(bad["note"]), ""),
    }  # fmt: skip


def least_valid(cases: pd.DataFrame) -> float:
    """The fewest faces, nothing kept, from which on every object gave a valid mesh at every count; or NaN."""
    plain = cases.loc[(cases["kept"] == "none") & cases["soft"].isna() & (cases["budget"] != SMALLEST)]
    counts = plain.assign(valid=plain["outcome"] == "valid").groupby("budget").agg({"severity": "max", "valid": "all"})
    counts = counts.sort_values("severity", ascending=False)
    return min(counts.loc[counts["valid"].cummin(), "severity"], default=np.nan)


def figure(results: Results) -> Figure:
    """Draws to how few faces each backend simplifies broken meshes, and the error until it breaks."""
    cases, errors = results.measured(STAGE, metric="faces"), results.rows(STAGE, metric="error")
    backends, damages = (list(dict.fromkeys(cases[column])) for column in ("method", "perturbation"))
    height = 0.235 * len(damages)
    drawing, grid = plt.subplots(
        2, len(backends) + 1, figsize=(5.2 * len(backends) + 4.6, height + 3.4), squeeze=False,
        gridspec_kw={"height_ratios": [height, 1.8], "hspace": 0.16, "wspace": 0.34},
    )  # fmt: skip
    for backend, (upper, lower) in zip(backends, grid.T, strict=False):
        runs = cases.loc[cases["method"] == backend]
        plain = runs.loc[(runs["kept"] == "none") & runs["soft"].isna()]
        _squares(upper, plain, "perturbation", damages, [*BUDGETS, SMALLEST])
        upper.set_title(label(backend))
        kept_runs = runs.loc[(runs["kept"] != "none") & (runs["perturbation"] == "sound")]
        _squares(lower, kept_runs, "kept", list(KEPT)[1:], [*KEPT_BUDGETS, SMALLEST])
        lower.set(ylabel="vertices kept,\nsound object", xlabel="faces asked for")
    curves, legend = grid[:, -1]
    styles = dict(zip(backends, STYLES, strict=False))
    _curves(curves, errors.loc[(errors["kept"] == "none") & errors["soft"].isna()], styles)
    legend.set_axis_off()
    handles = [Patch(color=COLOURS[name], label=f"{name} {LETTERS[name]}") for name in OUTCOMES]
    lines = [Line2D([], [], color=INK, ls=style, label=label(name)) for name, style in styles.items()]
    legend.add_artist(legend.legend(handles=[*handles, *lines], loc="upper left", fontsize=8))
    legend.legend(*curves.get_legend_handles_labels(), loc="upper right", fontsize=8)
    words = {"damages": len(damages), "backends": ", ".join(map(label, backends))}
    return Figure(drawing, words | {"objects": ", ".join(dict.fromkeys(cases["item"]))})


def _squares(axes: Axes, cases: pd.DataFrame, column: str, lines: list[str], budgets: list[str]) -> None:
    """Coloured squares, a row a damage or kept set, a column a budget; the worst over the objects."""
    rank = cases.assign(rank=cases["outcome"].map(OUTCOMES.index))
    worst = rank.pivot_table("rank", index=column, columns="budget", aggfunc="max").reindex(lines, columns=budgets)
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


def _curves(axes: Axes, errors: pd.DataFrame, styles: Mapping[str, str]) -> None:
    """Mean error over the objects against the faces, a colour a damage and a style a backend."""
    errors = errors.loc[errors["budget"] != SMALLEST]
    errors = errors.assign(percent=100 * np.maximum(errors["value"], LEAST_ERROR))
    for damage, colour in zip(SHOWN, CYCLE, strict=True):
        for backend, style in styles.items():
            group = errors.loc[(errors["perturbation"] == damage) & (errors["method"] == backend)]
            means = group.groupby("budget").agg({"severity": "mean", "percent": "mean"}).sort_values("severity")
            axes.plot(means["severity"], means["percent"], ls=style, marker=".", color=colour, lw=1.2)
            bad = group.loc[group["outcome"] == "ruined"]
            axes.plot(bad["severity"], bad["percent"], "x", color=colour, ms=8, mew=1.6)
        axes.plot([], [], color=colour, label=label(damage))
    axes.set(xscale="log", yscale="log", title="error until it breaks")
    axes.set(xlabel="faces asked for", ylabel="mean error, % of the diagonal")
    axes.grid(True)
