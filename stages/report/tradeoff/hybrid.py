"""The hybrid network and its smaller kinds: accuracy against the size of the file."""

from stages.kit.files import write_table
from stages.report.items import Figure
from stages.report.style import INK, plt, save
from stages.report.tables._transfer import SPLITS
from stages.report.tables.section_5_5 import METHODS
from stages.report.tables.section_5_5 import build as table

SHOWN = {"vision": ("by sight", "#0072B2"), "touch": ("by touch", "#D55E00")}


def build(results):
    frame = table(results).frame
    splits = list(dict.fromkeys(frame["split"]))
    figure, panels = plt.subplots(1, len(splits), figsize=(4.6 * len(splits), 3.8), squeeze=False, sharey=True)
    for axes, split in zip(panels[0], splits, strict=True):
        _draw(axes, frame[frame["split"] == split])
        axes.set_title(SPLITS[split].replace("touches", "items"))
    panels[0, 0].set_ylabel("accuracy, %")
    panels[0, -1].legend(fontsize=8.5, loc="upper right")
    figure.tight_layout()
    folder = results.reports / "tradeoff"
    smallest = frame.loc[frame["megabytes"].idxmin(), "network"]
    return Figure(
        "One network for sight and touch: accuracy against size",
        "Accuracy by sight and by touch against megabytes on disk, for two networks, the hybrid and its smaller kinds.",
        "Up and left is better. Logarithmic size; bars: 95 % intervals. The smallest file is the "
        f"{METHODS[smallest]}: {frame['megabytes'].min():.1f} MB, {frame['size_ratio'].max():.1f} times less than two "
        "networks.",
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
    axes.set_xticks(frame["megabytes"], [f"{value:.1f}" for value in frame["megabytes"]], fontsize=8)
    axes.minorticks_off()
    for row in frame.itertuples():
        name = METHODS[row.network].replace("hybrid, weights of ", "")
        axes.annotate(name, (row.megabytes, 2), rotation=90, fontsize=8, color=INK, ha="center", va="bottom")
    axes.set_ylim(0, 102)
    axes.set_xlabel("size of the file, MB")
    axes.grid(axis="y")


def _write(frame, path):
    write_table(path, frame)
    return path
