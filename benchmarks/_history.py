"""Ratios of kernels to their peers over commits, and which kernel became slower: for benchmarks.kernels."""

import hashlib
import io
import os
import platform
import re
import subprocess
from collections.abc import Callable, Collection
from datetime import UTC, datetime
from pathlib import Path

import pandas as pd

from haptic_glance.base.files import read_table
from stages.engine.code import file_digest

HISTORY = Path("reports/bench/history.csv")
COLUMNS = ["commit", "date", "what", "peer", "ratio", "low", "high", "limit", "seconds", "machine"]
CODE = ("stages", "benchmarks", "haptic_glance", "constraints.txt")
# Times the upper end of a ratio's spread. Three runs of one commit on a busy machine, each held against each other: of
# 60 ratios 9 were above 1.05, 2 above 1.15 and none above 1.2 times that end; the largest was 1.18 times.
TOLERANCE = 1.3
WIDER = 2  # times that again where only other machines have measured; a guess, since one kind of machine has so far
TRIES = 3  # measurements that must all be too slow


def machine() -> str:
    """The model of the processor and its cores."""
    described = Path("/proc/cpuinfo")
    models = re.findall(r"^model name\s*: (.+)", described.read_text(), re.M) if described.exists() else []
    return f"{(*models, platform.processor(), platform.machine())[0]}, {os.cpu_count()} cores"


def version() -> dict[str, str]:
    """dict(commit, date) of the code: HEAD, or `HEAD+DIGEST` and now where files were changed since; date in UTC."""
    head, date = _git("log", "-1", "--abbrev=9", "--format=%h %cI").split()
    if _git("status", "--porcelain", "--", *CODE):
        listed = _git("ls-files", "-co", "--exclude-standard", "--", *CODE).splitlines()
        digests = [(name, file_digest(Path(name).absolute())) for name in listed if Path(name).exists()]
        head += "+" + hashlib.sha256(repr(digests).encode()).hexdigest()[:7]
        date = datetime.now(UTC).isoformat()
    return {"commit": head, "date": datetime.fromisoformat(date).astimezone(UTC).isoformat(timespec="seconds")}


def committed() -> pd.DataFrame:
    """The rows of HISTORY as HEAD has them."""
    return pd.read_csv(io.StringIO(_git("show", f"HEAD:{HISTORY.as_posix()}")))


def updated(rows: list[dict]) -> pd.DataFrame:
    """HISTORY with new rows of one commit and machine, in place of those that it has of both."""
    new = pd.DataFrame(rows, columns=COLUMNS)
    if not HISTORY.exists():
        return new
    old, keys = read_table(HISTORY), ["commit", "machine"]
    same = old[keys].apply(tuple, axis=1).isin(set(new[keys].itertuples(index=False, name=None)))
    return pd.concat([old[~same], new], ignore_index=True)


def limits(history: pd.DataFrame, here: str) -> pd.Series:
    """The highest ratio of each kernel: its last limit on this machine, else WIDER times the highest of the others'."""
    rows = history.dropna(subset=["limit"]).sort_values("date", kind="stable")
    last = rows.groupby(["what", "machine"])["limit"].last()
    local = last[last.index.get_level_values("machine") == here].droplevel("machine")
    return local.combine_first(WIDER * last.groupby("what").max())


def slower(history: pd.DataFrame, here: str, kernels: Collection[str], measure: Callable[[str], dict]) -> list[str]:
    """Sentences on the kernels that were too slow in each of TRIES measurements or are missing; [] when all hold.

    history: rows of HISTORY; here: this machine; measure: from a kernel's name to its row.
    """
    limit = limits(history, here)
    lines = [f"{name} is in {HISTORY}, but is no longer measured: remove its rows there if that is meant"
             for name in limit.index if name not in kernels]  # fmt: skip
    suspects = {name: [] for name in kernels if name in limit}
    for _ in range(TRIES):
        for name, ratios in suspects.items():
            ratios.append(measure(name)["ratio"])
        suspects = {name: ratios for name, ratios in suspects.items() if not ratios[-1] <= limit[name]}
    lines += [f"{name} is slower: {min(ratios):.3g} times its peer's time in the best of {TRIES} measurements, at most "
              f"{limit[name]:.3g} is expected" for name, ratios in suspects.items()]  # fmt: skip
    return lines


def _git(*arguments: str) -> str:
    process = subprocess.run(["git", *arguments], capture_output=True, text=True)
    if process.returncode:
        raise SystemExit(f"kernels: git {arguments[0]}: {process.stderr.strip()}; commit {HISTORY} first")
    return process.stdout.rstrip("\n")
