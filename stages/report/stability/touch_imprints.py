"""What the array feels at one place under every perturbation, from mild to harsh."""

from stages.kit.files import read_arrays
from stages.report.items import Figure
from stages.report.results import NotRun, Results
from stages.report.style import PALE, label, plt, save
from stages.touch_stability import PERTURBATIONS

MOST = 6  # severities
TOUCH = 0


def build(results: Results) -> Figure:
    folder = results.folder("touch_stability")
    names = [name for name in results.settings.figure_objects if (folder / f"{name}.npz").exists()]
    names = names or sorted(path.stem for path in folder.glob("*.npz"))
    if not names:
        raise NotRun("no data/touch_stability", "touch_stability")
    stored = read_arrays(folder / f"{names[0]}.npz")
    shown = {one: _severities(stored, one) for one in PERTURBATIONS}
    shown = {one: severities for one, severities in shown.items() if severities and not PERTURBATIONS[one].in_training}
    half = -(-len(shown) // 2)
    figure, grid = plt.subplots(half, 2 * (MOST + 2), figsize=(12.5, 0.86 * half), squeeze=False)
    for axes in grid.flat:
        axes.set_axis_off()
    for k, (perturbation, severities) in enumerate(shown.items()):
        row = grid[k % half, (MOST + 2) * (k // half) :]
        row[0].text(1.0, 0.5, label(perturbation), ha="right", va="center", fontsize=9, transform=row[0].transAxes)
        _picture(row[1], stored["shown.clean"][TOUCH], "none")
        for axes, severity in zip(row[2:], severities[:MOST], strict=False):
            _picture(axes, stored[f"shown.{perturbation}.{severity}"][TOUCH], severity)
    figure.subplots_adjust(wspace=0.06, hspace=0.35)
    return Figure(
        "One touch under every perturbation",
        f"Grey tactile images of one place of {names[0]}, undisturbed and under rising severities of "
        + ", ".join(map(label, shown)) + ".",
        f"{names[0]}, the first point; black is pressed first, white is farthest away. Units as in the table of "
        "breaking points.",
        [save(figure, results.reports / "figures/touch_stability_imprints.png")],
    )  # fmt: skip


def _severities(stored, perturbation):
    """The severities of a perturbation as they stand in the file's keys, from mild to harsh."""
    keys = [key.removeprefix(f"shown.{perturbation}.") for key in stored if key.startswith(f"shown.{perturbation}.")]
    return sorted(keys, key=lambda key: abs(float(key) - PERTURBATIONS[perturbation].unharmed))


def _picture(axes, image, title):
    axes.set_axis_on()
    axes.imshow(image, cmap="gray", vmin=0, vmax=1)
    axes.set_xticks([])
    axes.set_yticks([])
    for spine in axes.spines.values():
        spine.set(visible=True, color=PALE, linewidth=0.6)
    axes.set_title(title, fontsize=7, fontweight="normal", loc="center", pad=2)
