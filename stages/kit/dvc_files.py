"""The files that DVC writes as it runs, which a killed run may leave half written."""

import json
import sys
from pathlib import Path

import yaml

from .files import write_text

KEPT = "build/dvc.lock"  # the last sound copy


def mend_dvc_files(root: Path) -> None:
    """Removes half a list of what runs, which DVC would refuse, and puts the last sound dvc.lock in place of damage."""
    drop_half_written(root / ".dvc/tmp/rwlock")
    if (root / "dvc.lock").exists() and not keep_lock(root):
        _mend_lock(root)


def drop_half_written(path: Path) -> None:
    """Removes a JSON file that is not whole."""
    try:
        json.loads(path.read_text())
    except FileNotFoundError:
        pass
    except ValueError:
        path.unlink()


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
