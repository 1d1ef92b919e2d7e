"""Disturbs a few objects in many ways and measures what each method finds again, and where it breaks.

Reads data/SET/meshes and data/SET/weights. Writes data/SET/stability/NAME.npz (each method's worst case at a middle
severity, for the picture) and reports/measurements/SET/stability.csv.gz: one row per object, method, perturbation,
severity and metric.
`repeatability`: share of the points found again within 2 % of the diagonal; `chance`: the same of random points;
`drift`: one minus the correlation of the saliency; `points`: how many of the points pass the method's own threshold;
`nss` and `auc`: agreement of the saliency with people, read at the vertices of the undisturbed object, where the set
knows what they looked at.
Perturbation `none` is the object as it is. Where random numbers are drawn, a value is the mean of the draws; a pair,
such as `noise+tilt`, has one draw of both, each at its middle severity. Seconds include an even share of the rendering
and the maps that all methods share.

The points that the methods `used` find at the middle severities (those of the first draw) are used, too: `lod_mean` and
`lod_salient` are the errors of the undisturbed object when it is simplified around them (perturbation `plain`: around
nothing), `recognised` the share of touches there that are recognised among ten objects (stages.stability.uses).

The objects `broken` are also damaged in the ways of stages.stability.broken.DAMAGES, and every backend of
haptic_glance.lod simplifies them: a row `faces` a case (method: the backend; perturbation: the damage; severity: the
faces asked for; budget, kept, soft: what was asked; outcome: valid, refused, ruined or crash, with the reason in
`note`) and, where a mesh came back, a row `error`, its Metro mean, beside the `limit` of ruin. Settings: section
`stability` of params.yaml.
"""

import dataclasses
import functools
from collections import Counter
from collections.abc import Iterator, Sequence
from pathlib import Path

from haptic_glance.base.files import read_arrays, read_mesh, write_arrays
from haptic_glance.look.agreement import GroundTruth
from haptic_glance.look.points.methods import split_runnable
from haptic_glance.look.points.options import Options
from haptic_glance.look.weights import read_learned_weights
from stages.engine.run import Rows, StageRun
from stages.engine.settings import Workspace, workspace_of_arguments

from . import COLUMNS, Params
from .disturbance import AND, Disturbance, disturbances, parts_of
from .simplification import OUTCOMES, middle_severity, simplification_rows, summarise, summarise_simplification
from .subject import Findings, Subject, mean_of_draws, worst_arrays
from .uses import FOLDER, SET, Uses, recognise


def process(name: str, folder: Path, data: Path, settings: Params, seed: int) -> Rows:
    """Disturbs one object in every way, breaks and simplifies it if that is asked for; returns the rows."""
    mesh = read_mesh(data / "meshes" / f"{name}.npz")
    learned = read_learned_weights(data / "weights", name, mesh)
    methods, _ = split_runnable(settings.methods, learned)
    options = Options(learned, seed=seed, name=name)
    subject = Subject(mesh, methods, options, settings.count, settings.size, truth_of(data, name))
    rows, cases, middle = subject.unperturbed_rows(), [], middle_severities(settings)
    for draws in asked(settings):
        part, case = measured(subject, draws)
        rows += part
        if case and draws[0].parts[0] in middle.items() and draws[0].severity is not None:
            cases.append((draws[0], case))
    write_arrays(folder / f"{name}.npz", **worst_arrays(subject, cases))
    if settings.used:
        uses = Uses(subject, split_runnable(settings.used, learned)[0])
        for disturbance, case in cases:
            uses.add(disturbance, case)
        write_arrays(folder / FOLDER / f"{name}.npz", **uses.touches)
        rows += uses.rows
    return rows + simplification_rows(mesh, name, seed) if name in settings.broken else rows


def asked(settings: Params) -> Iterator[list[Disturbance]]:
    """The draws of each disturbance that the settings ask for: every severity, then the pairs."""
    for perturbation in settings.perturbations:
        for severity in settings.severities[perturbation]:
            yield disturbances([(perturbation, severity)], settings.draws)
    for pair in settings.pairs:
        yield disturbances(parts_of(pair, middle_severities(settings)), draws=1)


def middle_severities(settings: Params) -> dict[str, float]:
    """The middle severity of each perturbation."""
    return {name: middle_severity(settings.severities[name]) for name in settings.perturbations}


def measured(subject: Subject, draws: Sequence[Disturbance]) -> tuple[Rows, Findings | None]:
    """(rows of a disturbance, the mean of its draws; the Findings of the first draw, or None where it failed)."""
    rows, first = [], None
    for disturbance in draws:
        try:
            case = subject.disturbed(disturbance)
        except ValueError as error:
            rows.append(subject.failed_rows(disturbance, str(error)))
            continue
        rows.append(subject.rows(disturbance, case))
        first = case if disturbance.draw == 0 else first
    return mean_of_draws(rows), first


def truth_of(data: Path, name: str) -> GroundTruth | None:
    """The gaze of people on an object, where the set knows it."""
    path = data / "weights" / "ground_truth" / f"{name}.npz"
    if not path.exists():
        return None
    gaze = read_arrays(path)
    return GroundTruth(gaze["amounts"], gaze["density"], gaze["areas"])


def check(settings: Params) -> None:
    """Raises ValueError that names a setting with which nothing can be measured."""
    if not settings.perturbations or not settings.methods:
        raise ValueError("stability.perturbations and stability.methods must name at least one each")
    bare = [name for name in settings.perturbations if not settings.severities.get(name)]
    if bare:
        raise ValueError(f"stability.severities has none for {', '.join(bare)}: give at least one")
    odd = [pair for pair in settings.pairs if AND not in pair or {*pair.split(AND)} - {*settings.perturbations}]
    if odd:
        raise ValueError(
            f"stability.pairs: {', '.join(odd)}; join two of stability.perturbations by {AND}: "
            f"{', '.join(settings.perturbations)}"
        )
    strange = [method for method in settings.used if method not in settings.methods]
    if strange:
        raise ValueError(
            f"stability.used: {', '.join(strange)}; add to stability.methods: {', '.join(settings.methods)}"
        )
    if min(settings.count, settings.most, settings.draws) < 1:
        raise ValueError("stability: count, most and draws must be 1 or more")


def chosen(settings: Params, names: Sequence[str]) -> Sequence[str]:
    """The objects to disturb: those of the settings that are there, or else the first of all."""
    selected = [name for name in settings.objects if name in names] or names
    return selected[: settings.most]


def run(workspace: Workspace) -> None:
    """Runs the stage on the data set of a workspace."""
    settings = workspace.settings(Params)
    check(settings)
    common = dataclasses.replace(settings, objects=[], most=0)  # what an object depends on
    with StageRun(workspace, "stability", COLUMNS, inputs=("meshes", "weights")) as stage:
        objects = chosen(settings, stage.objects)
        work = functools.partial(process, data=workspace.data, settings=common, seed=stage.seed)
        rows = stage.each(work, objects, reads=("meshes/{}.npz", "weights"))
        if settings.used:
            options = {"objects": objects, "severities": middle_severities(settings), "seed": stage.seed}
            stage.each(functools.partial(recognise, made=stage.folder, **options), [f"sets of {SET}"], ["stability"])
        stage.metrics(summarise(rows) | {"simplified": summarise_simplification(rows)})
    broken = sum(value is not None for value in summarise(rows)["breaking_point"].values())
    outcomes = Counter(row["outcome"] for row in rows if row["metric"] == "faces")
    print(
        f"stability: {len(objects)} objects, {len(settings.perturbations)} perturbations, "
        f"{broken} breaking points within range; broken meshes simplified: "
        + ", ".join(f"{outcomes[outcome]} {outcome}" for outcome in OUTCOMES)
    )


if __name__ == "__main__":
    run(workspace_of_arguments(__doc__, "stability"))
