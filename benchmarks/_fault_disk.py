"""Disks that are full or cannot be written to, for benchmarks.faults: mounts that only the tried command sees."""

import shutil

from benchmarks._fault_workspace import DATA, ROOT, SET, forget, in_namespace
from benchmarks.faults import lost, said

RUN = f"python -m stages.lod {SET}"
MOUNTS = {  # where: (mount it too small or read-only, mend it)
    "build, a tmpfs of 64 KiB": ("mount -t tmpfs -o size=64k none build", "mount -o remount,size=64m build"),
    "build, a tmpfs of 256 KiB": ("mount -t tmpfs -o size=256k none build", "mount -o remount,size=64m build"),
    "data, a tmpfs without room": (
        "mount -t tmpfs -o size=64m none {mount} && cp -a data/. {mount} && mount --move {mount} data"
        " && mount -o remount,size=$(($(du -sk data | cut -f1) + 8))k data",
        "mount -o remount,size=64m data",
    ),
    "reports, a tmpfs without room": (
        "mount -t tmpfs -o size=4k none reports && head -c 4096 /dev/zero > reports/full",
        "mount -o remount,size=1m reports",
    ),
    "data, read-only": ("mount --bind data data && mount -o remount,ro,bind data", "mount -o remount,rw,bind data"),
    "build, read-only": (
        "mount --bind build build && mount -o remount,ro,bind build", "mount -o remount,rw,bind build",
    ),
    "reports, read-only": (
        "mount --bind reports reports && mount -o remount,ro,bind reports", "mount -o remount,rw,bind reports",
    ),
}  # fmt: skip


def cases(whole):
    """Runs the stage lod on each of them, mends the disk, and runs it again."""
    (ROOT / "mount").mkdir(exist_ok=True)
    for where, (spoil, mend) in MOUNTS.items():
        forget("lod")
        (ROOT / "build").mkdir(exist_ok=True)
        keep = f"mkdir -p kept && rm -rf kept/* && cp -a data/{SET}/lod reports/measurements/{SET}/lod.csv.gz kept"
        look = "echo first $?; find data reports -path '*lod*'; echo"
        script = f"set -e; {spoil.format(mount='mount')}; set +e; {RUN}; {look}; {mend} && {RUN} && {keep}"
        process = in_namespace(script)
        fault = "read-only" if "read-only" in where else "disk full"
        if "first" not in process.stdout:
            yield fault, where, "mount", f"not tried: {said(process)}", "nothing"
            continue
        _take_over()
        status, _, files = process.stdout.partition("first ")[2].partition("\n\n")[0].partition("\n")
        left = [path for path in files.split() if path != f"reports/metrics/{SET}/lod.json"]
        happened = f"status {status}, in place after it: {', '.join(left) or 'nothing'}; {said(process)}"
        yield fault, where, f"`{RUN}`, then again on a mended disk", happened, lost(whole)


def _take_over():
    """Puts what a run on another disk has made to where it is compared."""
    kept = ROOT / "kept"
    if (kept / "lod").is_dir():
        shutil.rmtree(DATA / "lod", ignore_errors=True)
        shutil.copytree(kept / "lod", DATA / "lod")
        shutil.copy2(kept / "lod.csv.gz", ROOT / "reports/measurements" / SET)
