"""All disturbed touches of one object."""

from pathlib import Path

from haptic_glance.base.files import files_below, read_mesh, write_arrays
from haptic_glance.know import features
from haptic_glance.look.weights.weights import GLANCE
from stages.imprints import read_imprints
from stages.kit.run import Rows
from stages.salient_points import read_saliency

from .perturbations import PERTURBATIONS
from .perturbations.coarse_mesh import SOFT
from .recognition import perturbation_severities
from .schema import Params
from .touches import Touches

DRAWS = 3  # of a random perturbation; the repetitions use them in turn
STORED_IMPRINTS = 4  # touches per perturbation whose imprints are stored for the figure


def touches_of(name: str, data: Path, settings: Params, count: int, seed: int) -> Touches:
    """The first `count` Touches of an object, with the simplified meshes that exist. data: data/SET."""
    found = read_imprints(data / "imprints" / f"{name}.npz")[settings.method]
    levels = {path.stem: read_mesh(path) for path in files_below(data / "lod" / name) if _is_used_level(path.stem)}
    saliency = read_saliency(data / "salient_points" / f"{name}.npz").get(GLANCE)
    mesh, cells = read_mesh(data / "meshes" / f"{name}.npz"), found.images.shape[1:]
    return Touches(name, mesh, found.vertices[:count], cells, float(found.pitch), saliency, levels, seed)


def _is_used_level(level):
    return level.rpartition("_")[0] in ("qem", SOFT)


def process(name: str, folder: Path, data: Path, settings: Params, count: int, seed: int) -> Rows:
    """Writes all disturbed touches of one object; returns a row per severity that is not available."""
    touches, rows = touches_of(name, data, settings, count, seed), []
    kept = {"clean": features(touches.images), "positions": touches.positions}
    kept |= {"images.clean": touches.images, "shown.clean": touches.images[:STORED_IMPRINTS]}
    for key, severity in perturbation_severities(settings.severities):
        perturbation = PERTURBATIONS[key]
        for draw in range(DRAWS if perturbation.random_draws else 1):
            if perturbation.apply is None:
                break
            try:
                perturbed = perturbation.apply(touches, severity, draw)
            except ValueError as error:
                note = f"{key} {severity:g} left out: {name}: {error}"
                where = {"item": name, "perturbation": key, "severity": severity}
                rows.append(where | {"metric": "accuracy", "value": None, "note": note})
                break
            kept[f"{key}.{severity:g}.{draw}"] = features(perturbed.images)
            if settings.denoisers:
                kept[f"images.{key}.{severity:g}.{draw}"] = perturbed.images
            if perturbed.positions is not None:
                kept[f"{key}.{severity:g}.{draw}.positions"] = perturbed.positions
            if draw == 0:
                kept[f"shown.{key}.{severity:g}"] = perturbed.images[:STORED_IMPRINTS]
    write_arrays(folder / f"{name}.npz", **kept)
    return rows
