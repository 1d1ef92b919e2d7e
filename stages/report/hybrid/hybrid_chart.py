"""The hybrid network and its smaller kinds: accuracy against the size of the file."""

from stages.kit.files import write_table
from stages.report.items import Figure
from stages.report.networks import SPLITS
from stages.report.style import INK, plt, save

from .section_5_5 import METHODS
from .section_5_5 import build as table

SHOWN = {"vision": ("by sight", "#0072B2"), "touch": ("by touch", "#D55E00")}


def build(results):
    frame = table(results).frame
    frame = frame[frame["objects"] == frame["objects"].iloc[0]]  # not those of another data set in one picture
    first = frame["shared_layers"].iloc[0]
    frame = frame[(frame["shared_layers"] == first) | (frame["network"] == "hybrid")]
    splits = list(dict.fromkeys(frame["split"]))
    figure, panels = plt.subplots(1, len(splits), figsize=(4.6 * len(splits), 3.8), squeeze=False, sharey=True)
    for axes, split in zip(panels[0], splits, strict=True):
        mine = frame[frame["split"] == split]
        _draw(axes, mine[mine["shared_layers"] == first])
        _draw_others(axes, mine[mine["network"] == "hybrid"])
        axes.set_xticks(mine["megabytes"], [f"{value:.1f}" for value in mine["megabytes"]], fontsize=8)
        axes.minorticks_off()
        axes.set_title(SPLITS[split].replace("touches", "items"))
    panels[0, 0].set_ylabel("accuracy, %")
    panels[0, -1].legend(fontsize=8.5, loc="upper right")
    figure.tight_layout()
    folder = results.reports / "tradeoff"
    smallest = frame.loc[frame["megabytes"].idxmin(), "network"]
    others = [layers for layers in dict.fromkeys(frame["shared_layers"]) if layers != first]
    hollow = (
        f" Hollow: layers {', '.join(others)} shared instead of {first}, as far from the hybrid as on the same items."
    )
    return Figure(
        "One network for sight and touch: accuracy against size",
        "Accuracy by sight and by touch against megabytes on disk, for two networks, the hybrid and its smaller kinds.",
        "Up and left is better. Logarithmic size; bars: 95 % intervals. The smallest file is the "
        f"{METHODS[smallest]}: {frame['megabytes'].min():.1f} MB, {frame['size_ratio'].max():.1f} times less than two "
        f"networks.{hollow if others else ''}",
        [save(figure, folder / "hybrid.png"), _write(frame, folder / "hybrid.csv")],
    )


def _draw(axes, frame):
    frame = frame.sort_values("megabytes")
    for sense, (words, tint) in SHOWN.items():
        axes.plot(frame["megabytes"], 100 * frame[sense], "o-", color=tint, ms=6, lw=1, mec="white", label=words)
        for row in frame.itertuples():
            bar = [100 * getattr(row, f"{sense}_low"), 100 * getattr(row, f"{sense}_high")]
            axes.plot([row.megabytes] * 2, bar, color=tint, lw=1.2, alpha=0.5)
    axes.set_xscale("log")
    for row in frame.itertuples():
        name = METHODS[row.network].replace("hybrid, weights of ", "")
        axes.annotate(name, (row.megabytes, 2), rotation=90, fontsize=8, color=INK, ha="center", va="bottom")
    axes.set_ylim(0, 102)
    axes.set_xlabel("size of the file, MB")
    axes.grid(axis="y")


def _draw_others(axes, frame):
    """Hybrids that share other layers than the first, by their gain over it on the items that both were tested on."""
    for row in frame[1:].itertuples():
        for sense, (_, tint) in SHOWN.items():
            place = 100 * frame[sense].iloc[0] + getattr(row, f"{sense}_gain")
            axes.plot(row.megabytes, place, "o", mfc="white", mec=tint, ms=6)
        axes.annotate(row.shared_layers, (row.megabytes, 2), rotation=90, fontsize=8, color=INK, ha="center",
                      va="bottom")  # fmt: skip


def _write(frame, path):
    write_table(path, frame)
    return path
