"""Parts of the report from an earlier run, used again while their inputs are unchanged.

A part is one kind of a topic: its claims, tables, figures or charts. Its key hashes all rows of measurements, the files
in data/ by size and time, the settings, the code behind the topic and the topic's prose. A part is built again where
its key is another one, or where a file that it wrote is no longer the same.
"""

import hashlib
import pickle
from collections.abc import Iterable
from pathlib import Path
from types import ModuleType
from typing import Any

import cloudpickle

from haptic_glance.base.files import sha256, whole_file
from stages.engine.code import file_digest, files_behind

from .items import Built
from .records import versions
from .results import Results

FOLDER = "report"  # below build/
HERE = Path(__file__).parent
COMMON = ("items.py", "page.py", "records.py", "verdict.py", "words.py")  # run for each topic, with all they import
BESIDE = ("topics.py", "reuse.py")  # run, too; what they import does not count: all topics


def key_of(topic: ModuleType, results: Results) -> str:
    """Hashes everything that the parts of a topic depend on."""
    own = sorted(Path(topic.__file__ or "").parent.glob("*.*"))
    files = files_behind([*(path for path in own if path.suffix == ".py"), *(HERE / name for name in COMMON)])
    files = [path for path in files if path.suffix != ".md"]  # prose of other topics
    files += [path for path in own if path.suffix == ".md"] + [HERE / name for name in BESIDE]
    digests = [(str(path), file_digest(path)) for path in files]
    return _hash(results.once("inputs", lambda: _inputs(results)), *digests)


def _inputs(results: Results) -> str:
    """Hashes the inputs that all topics share."""
    folders = {results.reports, results.workspace.published}
    rows = [path for folder in folders for name in ("measurements", "bench") for path in _files(folder / name)]
    code = [
        path for path in _files(results.workspace.build / "code") if path.name != "report"
    ]  # for rows that are older
    stats = [(str(path), path.stat().st_size, path.stat().st_mtime_ns) for path in _files(results.data)]
    hashes = [(str(path), sha256(path)) for path in (*rows, *code)]
    return _hash(results.workspace.params, results.settings, versions(), *hashes, *stats)


def _files(folder: Path) -> Iterable[Path]:
    return sorted(path for path in folder.rglob("*") if path.is_file())


def _hash(*parts: object) -> str:
    return hashlib.sha256(repr(parts).encode()).hexdigest()


def taken_again(name: str, key: str, results: Results) -> Any:
    """The part that `keep` stored; None without one, with another key, or where a file of the part has changed."""
    path = results.workspace.build / FOLDER / f"{name}.pickle"
    try:
        known_key, files, part = pickle.loads(path.read_bytes())
    except (OSError, ValueError, TypeError, AttributeError, ImportError, EOFError, pickle.UnpicklingError):
        return None
    same = known_key == key and all(file.is_file() and sha256(file) == digest for file, digest in files.items())
    return part if same else None


def keep(name: str, key: str, part: Any, results: Results) -> None:
    """Stores a part below build/, with its key and the hashes of its files."""
    paths = [path for item in part.items for path in item.paths] if isinstance(part, Built) else []
    content = cloudpickle.dumps((key, {path: sha256(path) for path in paths}, part))
    with whole_file(results.workspace.build / FOLDER / f"{name}.pickle") as file:
        file.write_bytes(content)
