"""The files that DVC writes as it runs, which a killed run may leave half written."""

import json
import sys
from pathlib import Path

import yaml

from haptic_glance.base.files import write_text

KEPT = "build/dvc.lock"  # the last sound copy


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
