"""All disturbed touches of one object."""

from stages.classification import features
from stages.imprints import read_imprints
from stages.kit.files import read_mesh, write_arrays
from stages.kit.run import DATA
from stages.salient_points import read_saliency

from .perturbations import PERTURBATIONS
from .recognise import pairs
from .touches import Touches

DRAWS = 3  # of a perturbation that is a matter of luck; the repetitions take them in turn
SHOWN = 4  # touches whose imprints are kept for the picture
SALIENCY = "enhanced"  # what simplification spares, as lod's enhanced-soft


def touches_of(name, settings, count, seed):
    """The first `count` Touches of an object, with the simplified meshes that are there."""
    found = read_imprints(DATA / "imprints" / f"{name}.npz")[settings.method]
    levels = {path.stem: read_mesh(path) for path in sorted((DATA / "lod" / name).glob("*.npz")) if _wanted(path.stem)}
    saliency = read_saliency(DATA / "salient_points" / f"{name}.npz").get(SALIENCY)
    mesh, cells = read_mesh(DATA / "meshes" / f"{name}.npz"), found.images.shape[1:]
    return Touches(name, mesh, found.vertices[:count], cells, float(found.pitch), saliency, levels, seed)


def _wanted(level):
    return level.rpartition("_")[0] in ("qem", "enhanced-soft")


def process(name, folder, settings, count, seed):
    """Makes all disturbed touches of one object; returns a row where a perturbation cannot be had."""
    touches, rows = touches_of(name, settings, count, seed), []
    kept = {"clean": features(touches.images), "positions": touches.positions}
    kept["shown.clean"] = touches.images[:SHOWN]
    for key, severity in pairs(settings.severities):
        known = PERTURBATIONS[key]
        for draw in range((DRAWS if known.drawn else 1) if known.disturb else 0):
            try:
                felt = known.disturb(touches, severity, draw)
            except ValueError as error:
                note = f"{key} {severity:g} left out: {name}: {error}"
                rows.append(
                    {"perturbation": key, "severity": severity, "metric": "accuracy", "value": None, "note": note}
                )
                break
            kept[f"{key}.{severity:g}.{draw}"] = features(felt.images)
            if known.moves:
                kept[f"{key}.{severity:g}.{draw}.positions"] = felt.positions
            if draw == 0:
                kept[f"shown.{key}.{severity:g}"] = felt.images[:SHOWN]
    write_arrays(folder / f"{name}.npz", **kept)
    return rows
