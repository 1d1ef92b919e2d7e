"""The files that a stage imports, and a digest of the code in each file, without comments and docstrings.

The imports come from grimp, also those inside of functions. A name of a package leads to the package's `__init__` and
to all that this imports, so a stage may depend on more files than it runs.
"""

import ast
import hashlib
import re
import sys
from collections.abc import Iterable
from contextlib import suppress
from functools import cache
from pathlib import Path
from typing import Any

from haptic_glance.base.extras import from_extra
from haptic_glance.base.files import read_json, write_json

ROOT = Path(__file__).parents[2]  # the folder that holds the package `stages`
PACKAGES = "stages", "haptic_glance"  # what a stage may import
READS_BESIDE = re.compile(r"__file__|\bimport resources\b")  # in modules that read templates, shaders or scripts
CACHE = "build/code.json"  # below ROOT: the digests of all stages, and the hash of the files that they are about


def stage_names() -> list[str]:
    """The stages of this repository: the packages that can be run and have settings, in alphabetical order."""
    settings = [path for path in (ROOT / "stages").glob("*/__init__.py") if "class Params" in path.read_text("utf-8")]
    return sorted(path.parent.name for path in settings)


def stage_digest(stage: str) -> str:
    """16 hex digits of all code of a stage."""
    digests = _digests()
    return digests[stage] if stage in digests else _digest_of(stage)


def stage_digests() -> dict[str, str]:
    """{stage: 16 hex digits of its code} for all stages."""
    return dict(_digests())


def stage_files(stage: str) -> list[Path]:
    """The files that `python -m stages.STAGE` may run or read as part of its code, in alphabetical order."""
    folder = ROOT / "stages" / stage
    if not (folder / "__main__.py").is_file():
        raise ValueError(f"there is no stage {stage}: stages/{stage}/__main__.py is missing")
    return files_behind([folder / "__init__.py", folder / "__main__.py"])


def files_behind(starts: Iterable[Path]) -> list[Path]:
    """These Python files and all that they import or read as part of their code, in alphabetical order."""
    graph = _graph()
    modules = {_module(path) for path in starts}
    modules |= {found for module in modules for found in graph.find_upstream_modules(module)}
    files = {_file(module) for module in modules}
    readers = [path for path in files if READS_BESIDE.search(path.read_text("utf-8"))]
    return sorted(files | {found for path in readers for found in _beside(path)})


@cache
def file_digest(path: Path) -> str:
    """16 hex digits of a file; of Python, without comments and docstrings."""
    content = path.read_bytes()
    return _hash(code_text(content.decode()).encode() if path.suffix == ".py" else content)


def code_text(text: str) -> str:
    """Python source without comments, docstrings and blank lines."""
    tree = ast.parse(text)
    for node in ast.walk(tree):
        if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef):
            node.body = [part for part in node.body if not _is_text(part)] or [ast.Pass()]
    return ast.unparse(tree)


@cache
def _digests() -> dict[str, str]:
    """The digests of all stages; those of an earlier process where no file has changed, which saves two seconds."""
    paths = sorted(path for package in PACKAGES for path in (ROOT / package).rglob("*") if _is_code(path))
    parts = [repr(sys.version_info[:2]).encode()]  # another Python may write the same tree as another text
    parts += [part for path in paths for part in (path.relative_to(ROOT).as_posix().encode(), path.read_bytes())]
    state = _hash(*parts)
    with suppress(OSError, ValueError, TypeError, KeyError):
        earlier = read_json(ROOT / CACHE)
        if earlier["state"] == state:
            return dict(earlier["stages"])
    digests = {stage: _digest_of(stage) for stage in stage_names()}
    with suppress(OSError):
        write_json(ROOT / CACHE, {"state": state, "stages": digests})
    return digests


def _digest_of(stage: str) -> str:
    return _hash(*(f"{path.relative_to(ROOT).as_posix()} {file_digest(path)}".encode() for path in stage_files(stage)))


@cache
def _graph() -> Any:
    """The imports of all modules, by grimp."""
    with from_extra():
        import grimp

    return grimp.build_graph(*PACKAGES, cache_dir=None)


def _module(path: Path) -> str:
    parts = path.relative_to(ROOT).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


def _file(module: str) -> Path:
    place = ROOT.joinpath(*module.split("."))
    file = place.with_suffix(".py")
    return file if file.is_file() else place / "__init__.py"


def _beside(path: Path) -> list[Path]:
    """The files below a module's folder that are no Python."""
    return [file for file in path.parent.rglob("*") if _is_code(file) and file.suffix != ".py"]


def _is_code(path: Path) -> bool:
    return path.is_file() and "__pycache__" not in path.parts and not path.name.startswith(".")


def _is_text(node: ast.AST) -> bool:
    return isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant) and isinstance(node.value.value, str)


def _hash(*parts: bytes) -> str:
    return hashlib.sha256(b"\0".join(parts)).hexdigest()[:16]
