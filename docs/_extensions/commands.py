"""Which command tests which claims again, and how many minutes it computed when its rows were measured."""

import re
from dataclasses import dataclass, field
from functools import cache
from itertools import takewhile
from pathlib import Path
from typing import Any

import pandas as pd

from stages.charts.cells import number_of, rows_of
from stages.charts.commands import COMPOSE, switch
from stages.engine.rows import SUFFIX
from stages.report.claims import load

from .measured import REPORTS

ROOT = Path(__file__).resolve().parents[2]
DEFAULT = "make repro"
TIME_KEYS = ["value", "metric", "note", "task", "view", "split"]  # in which rows of one piece of work differ
SEEN = "seen_share"  # rows of the views that stand for one piece of work, the views in a row


@dataclass
class Command:
    """text: what to type; claims: rows of reports/claims.csv; work: the sets and stages that it measures."""

    text: str
    claims: list[dict[str, str]] = field(default_factory=list)
    work: set[tuple[str, str]] = field(default_factory=set)

    @property
    def name(self) -> str:
        """The part of the text that differs from command to command."""
        match = re.search(r"(experiment=\w+|sets=\[\w+\])", self.text)
        return match[1] if match else self.text

    @property
    def meaning(self) -> str:
        """The sentence at the head of the experiment or data set that the text names; "" of the default run."""
        match = re.search(r"(experiment)=(\w+)|(sets)=\[(\w+)", self.text)
        if not match:
            return ""
        folder, name = ("experiment", match[2]) if match[1] else ("data", match[4])
        lines = (ROOT / f"conf/{folder}/{name}.yaml").read_text(encoding="utf-8").splitlines()[1:]
        return " ".join(line.removeprefix("# ") for line in takewhile(lambda line: line.startswith("# "), lines))

    @property
    def is_timed(self) -> bool:
        """Whether the rows of all its stages have seconds."""
        return self.text == DEFAULT or all(seconds(*pair) for pair in self.work)

    @property
    def minutes(self) -> float:
        """Of one core, summed over the rows of all stages of its sets; of the default run as timed on two cores."""
        if self.text == DEFAULT:
            timed = rows_of(REPORTS / "bench/pipeline.csv", "what=all stages metric=wall time")
            return number_of(timed, "minutes:value")
        return sum(seconds(*pair) for pair in self.work) / 60


def commands() -> list[Command]:
    """The commands that test claims, the default run first, then those with most claims."""
    records: list[Any] = rows_of(REPORTS / "claims.csv").to_dict("records")
    written = {row["key"]: row for row in records}
    by_text: dict[str, Command] = {}
    for claim in load():
        if written.get(claim.key, {"pairs": "0"})["pairs"] == "0":
            continue  # nothing was measured
        text = command_for(claim.sets[0], claim.stage)
        by_text.setdefault(text, Command(text)).claims.append(written[claim.key])
    for dataset in measured_sets():
        for stage in stages_of(dataset):
            if command := by_text.get(command_for(dataset, stage)):
                command.work.add((dataset, stage))
    return sorted(by_text.values(), key=lambda entry: (entry.text != DEFAULT, -len(entry.claims)))


def measured_sets() -> list[str]:
    """The sets that have rows."""
    return sorted(path.name for path in (ROOT / "reports/measurements").iterdir() if path.is_dir())


@cache
def stages_of(dataset: str) -> list[str]:
    """The stages that have rows of a set."""
    return [path.name.removesuffix(SUFFIX) for path in (ROOT / "reports/measurements" / dataset).glob(f"*{SUFFIX}")]


@cache
def command_for(dataset: str, stage: str) -> str:
    """What runs a stage on a set."""
    chosen = switch(ROOT / "conf", dataset, stage)
    return f"{COMPOSE} {chosen} && dvc repro" if chosen else DEFAULT


@cache
def seconds(dataset: str, stage: str) -> float:
    """Seconds of the pieces of work behind the rows of a stage; rows that differ in what is measured are one piece."""
    rows = pd.read_csv(ROOT / "reports/measurements" / dataset / f"{stage}{SUFFIX}", low_memory=False)
    timed = rows.dropna(subset=["seconds"])
    timed = timed.loc[~((timed["metric"] == SEEN) & (timed.get("views") != 1))]
    return float(timed.drop(columns=TIME_KEYS, errors="ignore").drop_duplicates()["seconds"].sum())
