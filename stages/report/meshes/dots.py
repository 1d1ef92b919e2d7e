"""Methods as rows of dots: the mean over objects, with the interval of the paired difference from one of them."""

from stages.kit.stats import interval
from stages.report.style import GREY, INK, METHOD_COLOURS, PALE

HELD = {"enhanced": METHOD_COLOURS["enhanced"], "qem": GREY}  # colours of names


def draw_dots(axes, table, methods, tint, base=None, name=None, down=0.0):
    """Draws the means of a frame objects x methods as dots, the first method on top.

    base: the method that the others are compared with: a line about each dot is the 95 % interval of the paired
    difference from it, and a dashed line its own mean; None: the line is the interval of the mean itself. down: how
    far below the middle of its row a dot is drawn, where a panel has several a row.
    """
    zero, middle = (table[base], table[base].mean()) if base else (0.0, 0.0)
    for y, method in enumerate(methods):
        mean, low, high = interval(table[method] - zero)
        axes.plot([middle + low, middle + high], [y + down] * 2, color=tint, lw=1.6, alpha=0.5)
        axes.plot(middle + mean, y + down, "o", color=tint, ms=4.2, mec="white", mew=0.5)
    if base:
        axes.axvline(middle, color=tint, lw=0.9, ls="--", zorder=0)
    if name:
        axes.plot([], [], "o", color=tint, ms=4, label=name)


def dress(panels, titles, names, methods, pad=6):
    """Titles above the panels of one row, names of the methods at the left, ours and plain QEM in their colours."""
    for axes, title in zip(panels, titles, strict=True):
        axes.set_title(title, fontsize=9.5, fontweight="normal", pad=pad)
        axes.grid(axis="x")
        axes.hlines(range(len(methods)), 0, 1, transform=axes.get_yaxis_transform(), color=PALE, lw=0.4, zorder=0)
        axes.tick_params(axis="y", length=0)
        axes.tick_params(axis="x", labelsize=8)
        axes.spines["left"].set_visible(False)
    panels[0].set_yticks(range(len(methods)), names, fontsize=8.5)
    panels[0].set_ylim(len(methods) - 0.4, -0.6)
    for text, method in zip(panels[0].get_yticklabels(), methods, strict=True):
        text.set_color(HELD.get(method, INK))
    panels[0].figure.subplots_adjust(wspace=0.12)
