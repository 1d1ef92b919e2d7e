"""The code that a stage runs: the files that it imports, and a digest of each without comments, docstrings and types.

A name that a package only hands on is followed to the file that defines it, so that a stage depends on the few files
behind the names that it uses, not on whole packages. Imports must therefore be free of side effects: a package whose
`__init__` does more than import counts as code itself.
"""

import ast
import hashlib
from functools import cache
from pathlib import Path

ROOT = Path(__file__).parents[2]  # the folder that holds the package `stages`
PACKAGE = "stages"
PACKAGES = PACKAGE, "haptic_glance"  # what a stage may import


def stage_files(stage: str) -> list[Path]:
    """The files that `python -m stages.STAGE` may run or read as part of its code, in alphabetical order."""
    found: set[Path] = set()
    ahead = {_module(f"stages.{stage}.__main__"), _module(f"stages.{stage}")} - {None}
    if not ahead:
        raise ValueError(f"there is no stage {stage}: stages/{stage}/__main__.py is missing")
    while ahead:
        path = ahead.pop()
        if path is None or path in found:
            continue
        found.add(path)
        ahead |= imported_files(path) - found
    return sorted(found)


def stage_digests(stage: str) -> dict[str, str]:
    """{file, relative to the repository: 16 hex digits of its code} for all files of a stage."""
    return {path.relative_to(ROOT).as_posix(): file_digest(path) for path in stage_files(stage)}


def stage_digest(stage: str) -> str:
    """16 hex digits of all code of a stage."""
    return hashlib.sha256(repr(sorted(stage_digests(stage).items())).encode()).hexdigest()[:16]


@cache
def file_digest(path: Path) -> str:
    """16 hex digits of a file; of Python, only what runs."""
    content = path.read_bytes()
    if path.suffix == ".py":
        content = code_text(content.decode()).encode()
    return hashlib.sha256(content).hexdigest()[:16]


def code_text(text: str) -> str:
    """Python source without comments, docstrings, blank lines and the types of arguments and results.

    The types of class attributes stay: dataclasses and schemas read them when they run.
    """
    tree = ast.parse(text)
    for node in ast.walk(tree):
        if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef):
            body = [part for part in node.body if not _is_text(part) and not _is_for_types(part)]
            node.body = body or [ast.Pass()]
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            node.returns = None
            every = [*node.args.posonlyargs, *node.args.args, *node.args.kwonlyargs, node.args.vararg, node.args.kwarg]
            for argument in every:
                if argument is not None:
                    argument.annotation = None
    return ast.unparse(tree)


@cache
def imported_files(path: Path) -> set[Path]:
    """The files of both packages that one file imports, anywhere in it, and the data files beside it that it reads."""
    tree = ast.parse(path.read_text(encoding="utf-8")) if path.suffix == ".py" else ast.Module([], [])
    here = _package(path)
    found: set[Path] = set()
    for node in _running(tree):
        if isinstance(node, ast.Import):
            found |= {file for alias in node.names for file in _files_of(alias.name)}
        elif isinstance(node, ast.ImportFrom):
            source = _absolute(node, here)
            found |= {file for alias in node.names for file in _files_behind(source, alias.name)}
        if isinstance(node, ast.Name | ast.alias) and _named(node) in ("__file__", "resources"):
            found |= _data_files(path)
    return found - {path}


def _files_behind(source: str, name: str) -> set[Path]:
    """The files behind `from source import name`."""
    if source.split(".")[0] not in PACKAGES:
        return set()
    submodule = _module(f"{source}.{name}")
    if submodule is not None:
        return {submodule, *_busy(f"{source}.{name}")}
    path = _module(source)
    if path is None:
        return set()
    if path.name != "__init__.py":
        return {path, *_busy(source)}
    handed_on = _handed_on(path)
    if name in handed_on:
        return _files_behind(*handed_on[name]) | _busy(f"{source}.{name}")
    if name in _defined(path):
        return {path}
    return {path, *path.parent.rglob("*.py")} if _does_more(path) else {path}


def _files_of(module: str) -> set[Path]:
    """The files behind `import module`."""
    path = _module(module) if module.split(".")[0] in PACKAGES else None
    return {path} if path else set()


@cache
def _defined(path: Path) -> set[str]:
    """The names of the classes, functions and constants that a file defines."""
    body = ast.parse(path.read_text(encoding="utf-8")).body
    named = {node.name for node in body if isinstance(node, ast.ClassDef | ast.FunctionDef)}
    assigned = [target for node in body if isinstance(node, ast.Assign) for target in node.targets]
    return named | {target.id for target in assigned if isinstance(target, ast.Name)}


@cache
def _handed_on(path: Path) -> dict[str, tuple[str, str]]:
    """{name: (module, name there)} of what a package's `__init__` hands on, by import or by a dict of modules."""
    found, here = {}, _package(path)
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom):
            found |= {alias.asname or alias.name: (_absolute(node, here), alias.name) for alias in node.names}
        elif isinstance(node, ast.Dict):
            for name, module in zip(node.keys, node.values, strict=True):
                if isinstance(name, ast.Constant) and isinstance(module, ast.Constant):
                    found[str(name.value)] = f"{here}.{str(module.value).lstrip('.')}", str(name.value)
    return found


def _busy(module: str) -> set[Path]:
    """The `__init__` files above a module that do more than import: what they do is code that runs."""
    parts, found = module.split("."), set()
    for depth in range(1, len(parts)):
        path = _module(".".join(parts[:depth]))
        if path is not None and path.name == "__init__.py" and _does_more(path):
            found.add(path)
    return found


@cache
def _does_more(path: Path) -> bool:
    for node in ast.parse(path.read_text(encoding="utf-8")).body:
        names = isinstance(node, ast.Assign) and getattr(node.targets[0], "id", "") == "__all__"
        if not (isinstance(node, ast.Import | ast.ImportFrom) or names or _is_text(node) or _is_for_types(node)):
            return True
    return False


@cache
def _module(name: str) -> Path | None:
    """The file of a module or package of this repository, None where there is none."""
    place = ROOT.joinpath(*name.split("."))
    for path in (place.with_suffix(".py"), place / "__init__.py"):
        if path.is_file():
            return path
    return None


def _package(path: Path) -> str:
    """The dotted name of the package that a file lies in."""
    return ".".join(path.parent.relative_to(ROOT).parts)


def _absolute(node: ast.ImportFrom, here: str) -> str:
    if not node.level:
        return node.module or ""
    base = here.split(".")[: len(here.split(".")) - node.level + 1]
    return ".".join([*base, *([node.module] if node.module else [])])


def _data_files(path: Path) -> set[Path]:
    """The files below a module's folder that are no Python: templates, shaders, scripts."""
    every = path.parent.rglob("*.*")
    return {file for file in every if file.is_file() and file.suffix != ".py" and "__pycache__" not in file.parts}


def _running(tree: ast.AST) -> list[ast.AST]:
    """All nodes of a tree but those that only type checkers read."""
    found, ahead = [], [tree]
    while ahead:
        node = ahead.pop()
        if not _is_for_types(node):
            found.append(node)
            ahead += ast.iter_child_nodes(node)
    return found


def _named(node: ast.Name | ast.alias) -> str:
    return node.id if isinstance(node, ast.Name) else node.name


def _is_text(node: ast.AST) -> bool:
    return isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant) and isinstance(node.value.value, str)


def _is_for_types(node: ast.AST) -> bool:
    return isinstance(node, ast.If) and "TYPE_CHECKING" in ast.unparse(node.test)
