"""Faults tried on a tiny workspace, what happened, and what was lost: `python -m benchmarks.faults [MOMENTS]`

Works in build/faults, on four analytic meshes and seven stages. Runs all once whole, then tries each fault, goes on,
and compares the bytes of data/ and the rows without their seconds with those of the whole run. Every stage is killed at
MOMENTS random moments (20 without the argument), the run of all stages at a fifth of that. Full and read-only disks are
mounts in a namespace of their own, which needs Linux with user namespaces or root; the others run everywhere.

Writes reports/bench/faults.csv: a row a fault (fault, where, tried, happened, lost, seconds), about seven minutes.
"""

import os
import random
import signal
import subprocess
import time
from pathlib import Path

import pandas as pd

from benchmarks import arguments
from benchmarks._fault_workspace import DATA, SET, STAGES, command, content, forget, forked, prepare, run_here, started
from haptic_glance.base.files import write_table

OUT = Path("reports/bench/faults.csv").resolve()


def said(process):
    """The output of a process, in one text: its status, how many lines, and the last of them."""
    lines = [line for line in process.stderr.splitlines() if line.strip()]
    kind = "a traceback" if any(line.startswith("Traceback") for line in lines) else f"{len(lines)} line(s)"
    return f"status {process.returncode}, {kind}: {lines[-1]}" if lines else f"status {process.returncode}, no word"


def lost(reference, *stages):
    """`nothing` where the results are those of the whole run, else what differs."""
    digests = content(*stages)
    wrong = sorted(name for name in reference.keys() | digests.keys() if reference.get(name) != digests.get(name))
    return f"{len(wrong)} files differ: {', '.join(wrong[:3])}" if wrong else "nothing"


def killed_stages(whole, moments):
    """Kills each stage at random moments of its run, and runs it again each time."""
    draw = random.Random(0)
    for stage in STAGES:
        reference = content(stage)
        forget(stage)
        _, seconds = forked(stage)
        half, same, late = 0, 0, 0
        for _ in range(moments):
            forget(stage)
            ended, _ = forked(stage, draw.uniform(0, seconds))
            late += ended
            left = {name: digest for name, digest in content(stage).items() if name.startswith("data")}
            half += bool(left) and any(reference.get(name) != digest for name, digest in left.items())
            same += forked(stage)[0] and content(stage) == reference
        attempt = f"SIGKILL at {moments} random moments of {seconds:.1f} s, then run again"
        happened = f"half a folder in place {half} times, same bytes {same} times ({late} had ended before)"
        yield "killed", stage, attempt, happened, lost(whole)


def killed_run(whole, moments):
    """Kills `stages.repro`: all its processes, or itself alone while its stages go on; then runs it again."""
    draw = random.Random(1)
    for all_of_it in (True, False):
        wrong, words = 0, ""
        for _ in range(moments):
            forget(*STAGES)
            run = started("stages.repro")
            time.sleep(draw.uniform(2, 20))
            (os.killpg if all_of_it else os.kill)(run.pid, signal.SIGKILL)
            run.stderr.close()
            run.wait()
            again = command("stages.repro")
            wrong += lost(whole) != "nothing" or again.returncode != 0
            words = said(again)
        who = "all its processes" if all_of_it else "itself alone"
        attempt = f"SIGKILL of {who} at {moments} random moments, then run again"
        yield (
            "killed",
            "stages.repro",
            attempt,
            f"{moments - wrong} of {moments} went on; the last: {words}",
            lost(whole),
        )


def two_at_once(whole):
    """Starts every stage twice at the same time on one workspace, and the run of all stages twice."""
    for stage in STAGES:
        forget(stage)
        yield _twice(f"stages.{stage}", stage, whole, SET)
    forget(*STAGES)
    yield _twice("stages.repro", "stages.repro", whole)


def _twice(module, where, whole, *rest):
    runs = [started(module, *rest) for _ in range(2)]
    ended = [subprocess.CompletedProcess((), run.wait(), None, run.stderr.read()) for run in runs]
    return "two at once", where, f"two `python -m {module}` started together", "; ".join(map(said, ended)), lost(whole)


def main():
    """Tries the faults and writes the table."""
    moments = int(arguments(__doc__, moments="20").moments)
    from benchmarks import _fault_damage, _fault_disk

    prepare()
    for stage in STAGES:
        run_here(stage)
    whole, rows, before = content(), [], time.perf_counter()
    command("stages.repro").check_returncode()  # from here on DVC knows what is made
    if not DATA.is_dir() or content() != whole:
        raise SystemExit("faults: two whole runs differ, nothing can be compared")
    cases = [_fault_damage.cases(whole), two_at_once(whole), killed_stages(whole, moments), _fault_disk.cases(whole)]
    for case in [*cases, killed_run(whole, max(moments // 5, 1))]:
        for row in case:
            now = time.perf_counter()
            rows.append([*row, now - before])
            print(*row, f"{now - before:.1f} s", sep=" | ", flush=True)
            before = now
            write_table(OUT, pd.DataFrame(rows, columns=["fault", "where", "tried", "happened", "lost", "seconds"]))


if __name__ == "__main__":
    main()
