"""Runs what changed, stages side by side: `python -m stages.repro`, what `make repro` calls

`dvc repro` runs one stage at a time. Here a stage starts as soon as those that it depends on are done, through DVC, so
that dvc.lock, its cache and what counts as changed are the same. All stages share one budget of cores, so two at once
take no more processors than one. If a stage fails, the stages that need it are skipped, the others continue, and the
exit status is 1. The output of a stage appears when it ends and stays in build/logs/STAGE.log. Where stderr is no
terminal, lines say what runs.
"""

import argparse
import json
import logging
import multiprocessing
import os
import resource
import sys
import time
from collections.abc import Callable
from graphlib import TopologicalSorter
from multiprocessing.connection import wait
from pathlib import Path
from typing import Any

import yaml
from tqdm import tqdm

from haptic_glance.base.errors import errors_in_one_line
from haptic_glance.base.files import write_text
from stages.engine import parallel
from stages.engine.run import alone
from stages.engine.settings import check_clone

AT_ONCE = 2  # stages: each has a worker a core; with more, memory is needed for no time gained
ATTEMPTS = 3  # of a stage that meets a lock of DVC
LOGS = Path("build/logs")
BLAS = "OPENBLAS_NUM_THREADS"  # a second thread saves no time on small matrices, and takes a core from another stage
KEPT = "build/dvc.lock"  # the last sound copy of dvc.lock, which a killed run may leave half written
REFRESH = 1.0  # seconds between two looks at the clock of what is running
PLAIN = 60.0  # seconds between two lines of progress where stderr is no terminal; one comes with each start, too


class Schedule:
    """The stages that may start: needs, {stage: the stages whose outputs it reads}; changed, those that must run."""

    def __init__(self, needs: dict[str, set[str]], changed: set[str]) -> None:
        self.needs, self.changed = needs, set(changed)
        self.waiting = list(needs)
        self.ended: set[str] = set()
        self.failed: list[str] = []

    def take(self) -> str | None:
        """The next stage that may start, in the order of the graph; what has nothing to do ends here."""
        for name in list(self.waiting):
            if self.needs[name] <= self.ended:
                self.waiting.remove(name)
                if name in self.changed:
                    return name
                self.ended.add(name)
        return None

    def end(self, name: str, executed: bool) -> None:
        """A stage ended well; if it ran, those that need it must be looked at."""
        self.ended.add(name)
        if executed:
            self.changed |= {stage for stage, sources in self.needs.items() if name in sources}

    def fail(self, name: str) -> list[str]:
        """A stage failed: returns the stages that cannot run now."""
        blocked_stages = {name}
        for stage in self.waiting:  # in the order of the graph: what a stage needs stands before it
            if self.needs[stage] & blocked_stages:
                blocked_stages.add(stage)
        self.failed.append(name)
        self.waiting = [stage for stage in self.waiting if stage not in blocked_stages]
        return sorted(blocked_stages - {name})


def read_graph(root: Path) -> tuple[dict[str, set[str]], set[str]]:
    """({stage: the stages that it needs}, those that changed), in an order in which they can run."""
    from dvc.repo import Repo

    repo = Repo(str(root), _wait_for_lock=True)
    graph = repo.index.graph
    with repo.lock:
        changed = {stage.addressing for stage in graph if stage.cmd and stage.changed()}
    needs = {stage.addressing: {source.addressing for source in graph.successors(stage)} for stage in graph}
    return {name: needs[name] for name in TopologicalSorter(needs).static_order()}, changed


def reproduce(root: Path, name: str, log: Path, send: Any) -> None:
    """Runs one stage through DVC in this process, all output to `log`; sends whether it ran, and processor seconds."""
    from dvc.repo import Repo

    with log.open("w") as file:
        os.dup2(file.fileno(), 1)
        os.dup2(file.fileno(), 2)
    logging.getLogger("dvc").setLevel(logging.WARNING)  # its advice on git, once a stage, hides what the stage says
    try:
        stages = patient(lambda: Repo(str(root), _wait_for_lock=True).reproduce(name, single_item=True))  # type: ignore[arg-type] (its decorators)
    except Exception as error:
        print(": ".join(map(str, causes_of(error))), file=sys.stderr)
        raise SystemExit(1) from error
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    send.send((bool(stages), usage.ru_utime + usage.ru_stime))


def patient(call: Callable[[], Any]) -> Any:
    """Calls DVC, again where another stage held a lock too long; ValueError where it is held all the time.

    DVC waits for its list of what runs for 3 seconds only, which a busy machine may exceed.
    """
    from dvc.lock import LockError

    for remaining in reversed(range(ATTEMPTS)):
        try:
            return call()
        except Exception as error:
            if not any(isinstance(cause, LockError) for cause in causes_of(error)):
                raise
            if not remaining:  # DVC advises to delete its lock
                raise ValueError("another run of DVC is at work here: run it again when that has ended") from None


def causes_of(error: BaseException) -> list[BaseException]:
    """The error, its cause, the cause of that, and so on."""
    causes = [error]
    while causes[-1].__cause__:
        causes.append(causes[-1].__cause__)
    return causes


def run(root: Path) -> list[str]:
    """Runs all that changed below `root`; returns the stages that failed."""
    os.environ.setdefault(BLAS, "1")
    context = multiprocessing.get_context("fork")  # DVC takes a second to load, once
    schedule = Schedule(*patient(lambda: read_graph(root)))
    (root / LOGS).mkdir(parents=True, exist_ok=True)
    running: dict[str, tuple[Any, Any, float]] = {}
    bar = tqdm(total=len(schedule.needs), desc="stages", disable=not sys.stderr.isatty(), unit="stage")
    progress: tuple[set[str], float] = set(), 0.0  # what the last line of progress names, and when it came
    with parallel.budget(root / "build/cores"), bar:
        while True:
            while len(running) < AT_ONCE and (name := schedule.take()):
                receive, send = context.Pipe(duplex=False)
                process = context.Process(target=reproduce, args=(root, name, _log(root, name), send))
                process.start()
                send.close()
                running[name] = process, receive, time.monotonic()
            now = time.monotonic()
            bar.n = len(schedule.ended)
            bar.set_postfix_str(", ".join(f"{name} {now - began:.0f} s" for name, (_, _, began) in running.items()))
            if not running:
                return schedule.failed
            if bar.disable and (running.keys() - progress[0] or now - progress[1] > PLAIN):
                progress = set(running), now
                print(_plain(schedule, [f"{name} {now - running[name][2]:.0f} s" for name in running]), file=sys.stderr)
            wait([process.sentinel for process, _, _ in running.values()], REFRESH)
            for name in [name for name, (process, _, _) in running.items() if process.exitcode is not None]:
                _ended(root, name, *running.pop(name), schedule)


def run_alone(root: Path) -> list[str]:
    """As run, after any other `stages.repro` below `root` has ended; ValueError that names a file DVC cannot read."""
    from dvc.exceptions import DvcException

    with alone(root / "build/repro.lock", "repro"):
        mend_dvc_files(root)
        try:
            return run(root)
        except DvcException as error:
            remedy = (
                "`python -m stages.compose` with your settings writes params.yaml anew, `git checkout dvc.yaml` brings"
            )
            raise ValueError(f"{error}: {remedy} dvc.yaml back; what was computed is in the cache") from error


def _plain(schedule, running):
    """A line of progress for a log."""
    return f"repro: {len(schedule.ended)} of {len(schedule.needs)} stages are done; running: {', '.join(running)}"


def _ended(root, name, process, receive, began, schedule):
    """Takes note of how a stage ended, and prints what it said and took."""
    text = _log(root, name).read_text(errors="replace").strip()
    if process.exitcode:
        stages = schedule.fail(name)
        tqdm.write(f"{name} failed:\n{text}" + (f"\nleft out: {', '.join(stages)}" if stages else ""), file=sys.stderr)
        return
    executed, processor = receive.recv()
    schedule.end(name, executed)
    keep_lock(root)
    if executed:
        times = f"{name}: {time.monotonic() - began:.0f} s, {processor:.0f} s of processor time"
        tqdm.write("\n".join(filter(None, [text, times])))
        sys.stdout.flush()  # a log would otherwise hold it back


def _log(root, name):
    return root / LOGS / f"{name}.log"


def mend_dvc_files(root: Path) -> None:
    """Makes DVC forget the stages of killed runs, and puts the last sound dvc.lock in the place of a damaged one.

    Call it where no other run of this program can be at work.
    """
    forget_killed(root / ".dvc/tmp/rwlock", " ".join(sys.argv))
    if (root / "dvc.lock").exists() and not keep_lock(root):
        _mend_lock(root)


def forget_killed(path: Path, program: str) -> None:
    """Removes what a program left in DVC's list of what runs, or the list if it is not whole; DVC would refuse to run.

    DVC itself drops dead processes, but not those that the system has not cleared away yet.
    """
    try:
        locks = json.loads(path.read_text())
        reads = {
            name: [entry for entry in all_ if entry["cmd"] != program] for name, all_ in locks.get("read", {}).items()
        }
        writes = {name: entry for name, entry in locks.get("write", {}).items() if entry["cmd"] != program}
    except FileNotFoundError:
        return
    except (ValueError, TypeError, KeyError, AttributeError):
        path.unlink()
        return
    write_text(
        path, json.dumps({"read": {name: entries for name, entries in reads.items() if entries}, "write": writes})
    )


def keep_lock(root: Path) -> bool:
    """Copies dvc.lock if it is sound, and says whether it is: DVC does not write it in one piece."""
    from dvc.dvcfile import Lockfile
    from dvc.exceptions import DvcException

    try:
        text = (root / "dvc.lock").read_text()
        Lockfile.validate(yaml.safe_load(text))
    except (OSError, ValueError, yaml.YAMLError, DvcException):
        return False
    write_text(root / KEPT, text)
    return True


def _mend_lock(root):
    """Without a sound copy all stages run again, and take what is in the cache."""
    damaged = "build/damaged.lock"
    print(f"repro: dvc.lock is damaged; the last sound one is taken, this one lies in {damaged}", file=sys.stderr)
    (root / "dvc.lock").replace(root / damaged)
    if (root / KEPT).exists():
        write_text(root / "dvc.lock", (root / KEPT).read_text())


def main() -> None:
    """Runs what changed below the current folder."""
    parser = argparse.ArgumentParser(
        prog="python -m stages.repro", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.parse_args()
    errors_in_one_line("repro")
    check_clone()
    failed = run_alone(Path("."))
    if failed:
        sys.exit(f"repro: {', '.join(failed)} failed, see {LOGS}")
    print("repro: all stages are up to date", file=sys.stderr)


if __name__ == "__main__":
    main()
