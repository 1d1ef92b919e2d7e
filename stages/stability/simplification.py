"""Broken meshes, hopeless budgets and odd kept sets, through every simplifier: valid, refused, ruined or crash?

`valid`: a mesh came back and nothing is wrong with it (stages.stability.checks); `refused`: an error said why there is
none; `ruined`: a mesh came back that is not sound, or another one on the second run; `crash`: any other error.
"""

import traceback
import warnings
from dataclasses import dataclass

import numpy as np

from stages.kit import Mesh, Stopwatch
from stages.lod import BACKENDS, simplify
from stages.lod.targets import face_count
from stages.lod.warm_up import warm_up

from .broken import BROKEN
from .checks import complaints, surface_error
from .plain_curve import PlainCurve
from .specimen import KEPT, RINGS, WEIGHTS, Case, Specimen

OUTCOMES = ("valid", "refused", "ruined", "crash")
BUDGETS = ("4", "16", "64", "256", "1024", "50%", "90%")
SMALLEST = "smallest"  # the budget that an InfeasibleTarget names: it must be possible
TWICE = ("50%",)  # budgets at which the same is asked again, for the same bytes
KEPT_ON, KEPT_BUDGETS = ("sound", "wide_holes", "fins", "soup", "everything"), ("256", "1024", "50%", "90%")
SOFT_ON, SOFT_BUDGETS = ("sound", "islands"), ("256", "50%")


@dataclass(frozen=True, eq=False)
class Answer:
    """What came of a case. smallest: the face count that a refusal names, 0 without; mesh: what came back, or None."""

    outcome: str
    note: str
    asked: int
    seconds: float
    mesh: Mesh | None = None
    error: float = np.nan
    limit: float = np.nan
    smallest: int = 0


def ask(specimen, case, backend, asked=None):
    """The Answer of a backend to a case; asked: the face count where the case's budget is SMALLEST."""
    asked = asked or face_count(case.budget, len(specimen.mesh.faces))
    kept, weights = specimen.kept(case), specimen.weights(case)

    def work():
        return simplify(specimen.mesh, asked, kept, RINGS, backend=backend, **weights)

    with warnings.catch_warnings(), Stopwatch() as watch:
        warnings.simplefilter("error", RuntimeWarning)
        try:
            found, problem = work(), None
        except Exception as error:  # that is the question
            found, problem = None, error
    if found is None:
        return _no_mesh(problem, asked, watch.seconds)
    frozen = specimen.kept_faces(kept)
    limit, apart = specimen.limit(asked, len(frozen)), surface_error(specimen.mesh, found)
    said = complaints(specimen.surface, found, asked, kept, frozen)
    if not apart <= limit:
        said.append(f"mean error {apart:.2g} of the diagonal; {limit:.2g} is a ruin")
    if case.budget in TWICE and not _same(found, work()):
        said.append("another mesh on the second run")
    return Answer("ruined" if said else "valid", "; ".join(said), asked, watch.seconds, found, apart, limit)


def cases_of(damage):
    """The cases that a damage is tried with."""
    cases = [Case(budget) for budget in BUDGETS]
    if damage in KEPT_ON:
        cases += [Case(budget, kept) for kept in list(KEPT)[1:] for budget in KEPT_BUDGETS]
    if damage in SOFT_ON:
        cases += [Case(budget, soft=soft) for soft in WEIGHTS for budget in SOFT_BUDGETS]
    return cases


def answers(specimen, backend, cases):
    """Yields (Case, Answer); after the first refusal of a kept set that names a smallest count, also that one."""
    told = set()
    for case in cases:
        answer = ask(specimen, case, backend)
        yield case, answer
        if answer.smallest and (case.kept, case.soft) not in told:
            told.add((case.kept, case.soft))
            least = Case(SMALLEST, case.kept, case.soft)
            yield least, ask(specimen, least, backend, answer.smallest)


def simplification_rows(mesh, name, seed, damages=tuple(BROKEN), backends=tuple(BACKENDS)):
    """Rows of one object: `faces` of every case (0 where nothing came back) and, where a mesh did, its `error`."""
    curve, rows = PlainCurve(mesh), []
    for backend in backends:
        warm_up(backend)
    for damage in damages:
        specimen = Specimen(mesh, curve, damage, name, seed)
        for backend in backends:
            for case, answer in answers(specimen, backend, cases_of(damage)):
                rows += _rows(name, damage, backend, case, answer)
    return rows


def _rows(name, damage, backend, case, answer):
    row = {
        "object": name, "method": backend, "perturbation": damage, "severity": answer.asked, "budget": case.budget,
        "kept": case.kept, "soft": case.soft, "outcome": answer.outcome, "limit": answer.limit, "note": answer.note,
        "seconds": answer.seconds,
    }  # fmt: skip
    rows = [row | {"metric": "faces", "value": 0 if answer.mesh is None else len(answer.mesh.faces)}]
    return rows if answer.mesh is None else [*rows, row | {"metric": "error", "value": answer.error}]


def _no_mesh(error, asked, seconds):
    """A refusal is a ValueError that this project raised and that says why; all else is a crash."""
    place, note = traceback.extract_tb(error.__traceback__)[-1], " ".join(str(error).split())
    if isinstance(error, ValueError) and "stages" in place.filename and note:
        return Answer("refused", note, asked, seconds, smallest=getattr(error, "smallest", 0))
    return Answer("crash", f"{type(error).__name__}: {note}", asked, seconds)


def _same(one, other):
    return one.vertices.tobytes() == other.vertices.tobytes() and one.faces.tobytes() == other.faces.tobytes()
