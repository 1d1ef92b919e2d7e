"""The search for the cheapest settings that are as good: Optuna's study on the disk, and successive halving.

Optuna prunes no study of several objectives. Here the choices that no other dominates are tested again first, with more
objects and splits, and among equal choices those farthest from the others (Deb and others, NSGA-II,
2002).
"""

import sys
import time
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, Literal, TypeVar

import numpy as np
from numpy.typing import ArrayLike

from haptic_glance.base.extras import from_extra
from haptic_glance.base.files import read_json, write_json
from haptic_glance.base.rng import rng
from haptic_glance.know.split import Split
from stages.engine.run import Rows

from .known import Effort, Objects, known
from .senses import Senses
from .space import DEFAULT, SPACE, Choice, choice_of, one_choice_changed

with from_extra():
    import optuna
    from optuna.storages import JournalStorage
    from optuna.storages.journal import JournalFileBackend
    from optuna.trial import TrialState

MADE_OF = "made of"  # the study's own note of what it was made of
POPULATION = 24  # choices of one generation


class OutOfTime(Exception):
    """The minutes of this call are over; what was found is kept."""


class Search:
    """A search for the front, in a folder of its own, that goes on where it stopped.

    made_of: what its results follow from: the code's digest, the objects, the seed. ValueError where the folder holds a
    study that was made of something else.
    """

    def __init__(self, folder: Path, made_of: dict[str, str], senses: Senses, seed: int, minutes: float) -> None:
        self.folder, self.senses, self.seed = folder, senses, seed
        self._end = time.monotonic() + 60 * minutes
        self._numbers: dict[Choice, int] = {}  # in the order in which they were first asked about
        self._measured: dict[tuple[str, Choice], Rows] = {}
        optuna.logging.set_verbosity(optuna.logging.WARNING)
        folder.mkdir(parents=True, exist_ok=True)
        storage = JournalStorage(JournalFileBackend(str(folder / "study.journal")))
        self.study = optuna.create_study(
            storage=storage, study_name="front", directions=DIRECTIONS, load_if_exists=True
        )
        self._check(made_of)

    def _check(self, made_of):
        parts = self.study.user_attrs.get(MADE_OF)
        if parts is None:
            self.study.set_user_attr(MADE_OF, made_of)
            return
        changes = [f"{key} {parts.get(key)}, now {value}" for key, value in made_of.items() if parts.get(key) != value]
        if changes:
            raise ValueError(
                f"{self.folder} holds a study of another version ({'; '.join(changes)}), whose results cannot be "
                f"compared: remove that folder to search anew, or check out the version that it was made with"
            )

    def run(self, searched: Objects, unseen: Objects, trials: int) -> Rows:
        """All rows: of each rung, of the confirmation on unseen objects, and of each single choice changed."""
        rows = self._wide(searched, trials)
        for rung in list(RUNGS)[1:]:
            choices = list(rows)
            better = [choices[k] for k in best_share(losses(rows.values()))]
            rows = {choice: self._asked(rung, searched, choice, RUNGS[rung]) for choice in better}
        roles = {DEFAULT: "default", smallest_of(rows): "smallest"}
        front = [choice for choice, rank in zip(rows, ranks(losses(rows.values())), strict=True) if rank == 0]
        for choice in dict.fromkeys([*roles, *front]):
            self._asked("confirmation", unseen, choice, CONFIRMATION, roles.get(choice))
        for choice in one_choice_changed(smallest_of(rows)):
            self._asked("one_choice", unseen, choice, CONFIRMATION)
        return [row for group in self._measured.values() for row in group]

    def _wide(self, searched, trials):
        """{choice: its rows} of the choices that the study proposes, until it has asked about so many."""
        rows = {}
        for trial in self.study.get_trials(deepcopy=False):
            if trial.state == TrialState.COMPLETE:
                choice = choice_of(trial.params)
                rows[choice] = self._asked("wide", searched, choice, RUNGS["wide"])
            elif trial.state == TrialState.RUNNING:  # a killed run has left it
                rows |= self._tell(trial.number, trial.params, searched)
        options: dict[str, Any] = {
            name: optuna.distributions.CategoricalDistribution(values) for name, values in SPACE.items()
        }
        while (number := len(self.study.get_trials(deepcopy=False))) < trials:
            # Drawn anew for each trial, so that a run that was stopped goes on like one that was not.
            seed = int(rng(self.seed, f"trial {number}").integers(2**31))
            self.study.sampler = optuna.samplers.NSGAIISampler(population_size=POPULATION, seed=seed)
            trial = self.study.ask(fixed_distributions=options)
            rows |= self._tell(trial.number, trial.params, searched)
        return rows

    def _tell(self, number, params, searched):
        if set(params) != set(SPACE):  # it was killed before it was proposed
            self.study.tell(number, state=TrialState.FAIL)
            return {}
        choice = choice_of(params)
        rows = self._asked("wide", searched, choice, RUNGS["wide"])
        self.study.tell(number, aims(rows))
        return {choice: rows}

    def _asked(self, rung: str, objects: Objects, choice: Choice, effort: Effort, role: str | None = None) -> Rows:
        """The rows of one choice, from the disk where it was asked about before."""
        path = self.folder / "rows" / rung / f"{choice.name}.json"
        if not path.exists():
            if time.monotonic() > self._end:
                raise OutOfTime
            rows = known(self.senses, objects, choice, effort, self.seed)
            write_json(path, rows)
            text = " ".join(f"{value:.3g}" for value in aims(rows)[:3])
            print(f"front: {rung} {choice.name}: {text} (regions, objects, seconds)", file=sys.stderr)
        common = {"rung": rung, "number": self._numbers.setdefault(choice, len(self._numbers)), "role": role}
        self._measured[rung, choice] = [{**row, **common} for row in read_json(path)]
        return self._measured[rung, choice]


Key = TypeVar("Key")

RUNGS = {  # each asks a third of the choices of the one before
    "wide": Effort(shapes=12, sixes=2, regions=3, folds=3),
    "narrow": Effort(shapes=18, sixes=6, regions=4, folds=6),
    "last": Effort(shapes=20, sixes=10, regions=6, folds=12),
}
SHARE = 3  # one in so many goes on
CONFIRMATION = RUNGS["last"]
# Of what `aims` gives.
DIRECTIONS: Sequence[Literal["maximize", "minimize"]] = ("maximize", "maximize", "minimize", "minimize", "minimize")
WITHIN = 0.02  # accuracy that the smallest choice may lack of the best one's


def aims(rows: Rows) -> list[float]:
    """Accuracy on unseen regions and on unseen objects, seconds to know one object, faces of its model, touches.

    Means over the objects. Accuracy 0 where no split could be drawn: what cannot be asked about is no good.
    """
    accuracies = [
        _mean([row["value"] for row in rows if row["split"] == split]) for split in (Split.REGIONS, Split.OBJECTS)
    ]
    return [*accuracies, *(_mean([row[key] for row in rows]) for key in ("seconds", "faces", "touches"))]


def losses(rows: Iterable[Rows]) -> np.ndarray:
    """(k, 5) the `aims` of the rows of k choices, each with less as the better."""
    signs = np.array([-1 if direction == "maximize" else 1 for direction in DIRECTIONS])
    return signs * np.array([aims(part) for part in rows])


def smallest_of(rows: Mapping[Key, Rows]) -> Key:
    """The choice of the fewest seconds whose accuracy, the mean of both kinds, is WITHIN that of the best one."""
    measures = {choice: aims(part) for choice, part in rows.items()}
    score = {choice: (regions + objects) / 2 for choice, (regions, objects, *_) in measures.items()}
    near: list[Any] = [choice for choice in measures if score[choice] >= max(score.values()) - WITHIN]
    return min(near, key=lambda choice: (measures[choice][2:], choice))


def _mean(values):
    numbers = [value for value in values if value is not None and value == value]
    return float(np.mean(numbers)) if numbers else 0.0


def ranks(losses: ArrayLike) -> np.ndarray:
    """(k,) i8: 0 for the choices that no other dominates, 1 for those that only these do, and so on.

    losses (k, aims), less is better. One choice dominates another that is nowhere better and somewhere worse.
    """
    losses = np.asarray(losses, dtype=np.float64)
    no_worse = (losses[:, None] <= losses[None]).all(axis=2)
    dominates = np.logical_and(no_worse, (losses[:, None] < losses[None]).any(axis=2))
    ranked = np.full(len(losses), -1)
    for rank in range(len(losses)):
        unranked = ranked < 0
        ranked[unranked & ~dominates[unranked].any(axis=0)] = rank
    return ranked


def crowding(losses: ArrayLike) -> np.ndarray:
    """(k,) how far each choice stands from its neighbours, summed over the aims; inf at the ends of an aim."""
    losses = np.asarray(losses, dtype=np.float64)
    distances = np.zeros(len(losses))
    for column in losses.T:
        order = np.argsort(column, kind="stable")
        span = np.ptp(column)
        if span == 0:
            continue
        distances[order[[0, -1]]] = np.inf
        distances[order[1:-1]] += (column[order[2:]] - column[order[:-2]]) / span
    return distances


def best_share(losses: ArrayLike) -> np.ndarray:
    """Ids of one in SHARE of the choices (at least one), rising: by rank, of equals the least crowded first."""
    losses = np.asarray(losses, dtype=np.float64)
    rank = ranks(losses)
    crowding_distance = np.zeros(len(losses))
    for level in np.unique(rank):
        crowding_distance[rank == level] = crowding(losses[rank == level])
    order = np.lexsort((-crowding_distance, rank))
    return np.sort(order[: max(1, len(losses) // SHARE)])
