"""The files that a stage imports, and a digest of the code in each file.

The digest leaves out comments, docstrings, types and the names of local variables.

A name that a package only hands on is followed to the file that defines it, so that a stage depends on the few files
behind the names that it uses, not on whole packages. Imports must therefore be free of side effects: a package whose
`__init__` does more than import counts as code itself.
"""

import ast
import hashlib
import json
import sys
from collections.abc import Iterable
from dataclasses import asdict, dataclass, field
from functools import cache
from pathlib import Path
from typing import Any

from haptic_glance.base.files import write_json

ROOT = Path(__file__).parents[2]  # the folder that holds the package `stages`
THIS_CODE = Path(__file__).read_bytes()
PACKAGE = "stages"
PACKAGES = PACKAGE, "haptic_glance"  # what a stage may import
LOCAL = (ast.FunctionDef, ast.AsyncFunctionDef, ast.Lambda, ast.ListComp, ast.SetComp, ast.DictComp, ast.GeneratorExp)


def stage_files(stage: str) -> list[Path]:
    """The files that `python -m stages.STAGE` may run or read as part of its code, in alphabetical order."""
    starts = {_module(f"stages.{stage}.__main__"), _module(f"stages.{stage}")} - {None}
    if not starts:
        raise ValueError(f"there is no stage {stage}: stages/{stage}/__main__.py is missing")
    return files_behind(starts)


def files_behind(starts: Iterable[Path | None]) -> list[Path]:
    """These files and all that they import or read as part of their code, in alphabetical order."""
    files, ahead = set(), set(starts)
    while ahead:
        path = ahead.pop()
        if path is None or path in files:
            continue
        files.add(path)
        ahead |= imported_files(path) - files
    return sorted(files)


def stage_digests(stage: str) -> dict[str, str]:
    """{file, relative to the repository: 16 hex digits of its code} for all files of a stage."""
    return {path.relative_to(ROOT).as_posix(): file_digest(path) for path in stage_files(stage)}


def stage_digest(stage: str) -> str:
    """16 hex digits of all code of a stage."""
    return hashlib.sha256(repr(sorted(stage_digests(stage).items())).encode()).hexdigest()[:16]


def file_digest(path: Path) -> str:
    """16 hex digits of a file; of Python, only what runs."""
    return _facts(path).digest


def code_text(text: str) -> str:
    """Python source without comments, docstrings, blank lines, the types of arguments and results, and local names.

    Local variables get numbers, so that a better name changes nothing; parameters keep theirs, since calls may name
    them. The types of class attributes stay: dataclasses and schemas read them when they run.
    """
    tree = ast.parse(text)
    number_locals(tree)
    for node in ast.walk(tree):
        if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef):
            body = [part for part in node.body if not _is_text(part) and not _is_for_types(part)]
            node.body = body or [ast.Pass()]
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            node.returns = None
            for argument in ast.walk(node.args):
                if isinstance(argument, ast.arg):
                    argument.annotation = None
    return ast.unparse(tree)


def number_locals(tree: ast.AST) -> None:
    """Renames the local variables of a tree to numbers in the order of their appearance, in place."""
    for node in ast.iter_child_nodes(tree):
        if isinstance(node, LOCAL):
            inner = list(ast.walk(node))
            numbers = {name: f"_{number}" for number, name in enumerate(local_names(inner))}
            for part in inner:
                for key in ("id", "arg", "name"):  # of a variable, of a lambda's parameter, of `except ... as`
                    if getattr(part, key, None) in numbers and not isinstance(part, ast.keyword | ast.alias):
                        setattr(part, key, numbers[getattr(part, key)])
        else:
            number_locals(node)


def local_names(nodes: Iterable[ast.AST]) -> list[str]:
    """The names that these nodes of a function or a comprehension bind, in the order of their appearance.

    Parameters are left out, and names that `def`, an import, `global` or `nonlocal` binds.
    """
    bound: dict[str, None] = {}
    excluded_names: set[str] = set()
    for node in nodes:
        if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store):
            bound[node.id] = None
        elif isinstance(node, ast.ExceptHandler | ast.MatchAs | ast.MatchStar) and node.name:
            bound[node.name] = None
        elif isinstance(node, ast.Lambda):
            bound |= {argument.arg: None for argument in node.args.args}
        elif isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            arguments = ast.walk(node.args)
            excluded_names |= {node.name} | {argument.arg for argument in arguments if isinstance(argument, ast.arg)}
        elif isinstance(node, ast.ClassDef):  # its variables are attributes
            excluded_names |= {
                part.id for part in ast.walk(node) if isinstance(part, ast.Name) and isinstance(part.ctx, ast.Store)
            }
        elif isinstance(node, ast.Global | ast.Nonlocal):
            excluded_names |= set(node.names)
        elif isinstance(node, ast.Import | ast.ImportFrom):
            excluded_names |= {alias.asname or alias.name.split(".")[0] for alias in node.names}
    return [name for name in bound if name not in excluded_names]


@cache
def imported_files(path: Path) -> set[Path]:
    """The files of both packages that one file imports, anywhere in it, and the data files beside it that it reads."""
    facts, files = _facts(path), set()
    for source, name in facts.imports:
        files |= _files_behind(source, name) if name else _files_of(source)
    return (files | (_data_files(path) if facts.reads_data else set())) - {path}


@dataclass(frozen=True)
class Facts:
    """Facts about a file by itself.

    digest: 16 hex digits of what runs; imports: (module, name there, empty for a whole module); reads_data: whether it
    asks for files beside it; defined: its classes, functions and constants; handed_on: {name: (module, name there)} of
    what it hands on, by import or by a dict of modules; does_more: whether it does more than import and hand on.
    """

    digest: str
    imports: list[tuple[str, str]] = field(default_factory=list)
    reads_data: bool = False
    defined: list[str] = field(default_factory=list)
    handed_on: dict[str, tuple[str, str]] = field(default_factory=dict)
    does_more: bool = False


KEPT = "build/code_facts.json"  # below ROOT: {digest of a file and its place: Facts}, as `keep_facts` wrote it


_ASKED: dict[str, Facts] = {}  # {key: Facts} of this process


@cache
def _facts(path: Path) -> Facts:
    content = path.read_bytes()
    # all that Facts follow from; another Python writes the same tree as another text
    parts = THIS_CODE, str(path.relative_to(ROOT)).encode(), content, repr(sys.version_info[:2]).encode()
    key = hashlib.sha256(b"\0".join(parts)).hexdigest()[:32]
    entry = _kept().get(key)
    _ASKED[key] = Facts(**entry) if entry else _work_out(path, content)
    return _ASKED[key]


@cache
def _kept() -> dict[str, dict[str, Any]]:
    """The Facts of an earlier process; none where there was none, or its file is damaged."""
    try:
        entries = json.loads((ROOT / KEPT).read_bytes())
    except (OSError, ValueError):
        return {}
    return entries if isinstance(entries, dict) else {}


def keep_facts() -> None:
    """Keeps the Facts that this process asked for, which spares each later process a second of parsing."""
    write_json(ROOT / KEPT, {key: asdict(facts) for key, facts in sorted(_ASKED.items())})


def _work_out(path: Path, content: bytes) -> Facts:
    """The Facts of a file, from its content."""
    if path.suffix != ".py":
        return Facts(hashlib.sha256(content).hexdigest()[:16])
    text, package = content.decode(), _package(path)
    tree = ast.parse(text)
    imports: set[tuple[str, str]] = set()
    reads_data = False
    for node in _running(tree):
        if isinstance(node, ast.Import):
            imports |= {(alias.name, "") for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            imports |= {(_absolute(node, package), alias.name) for alias in node.names}
        elif isinstance(node, ast.Name | ast.alias) and _named(node) in ("__file__", "resources"):
            reads_data = True
    internal = sorted(pair for pair in imports if pair[0].split(".")[0] in PACKAGES)
    digest = hashlib.sha256(code_text(text).encode()).hexdigest()[:16]
    return Facts(digest, internal, reads_data, _defined(tree), _handed_on(tree, package), _does_more(tree))


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
    facts = _facts(path)
    if name in facts.handed_on:
        return _files_behind(*facts.handed_on[name]) | _busy(f"{source}.{name}")
    if name in facts.defined:
        return {path}
    return {path, *path.parent.rglob("*.py")} if facts.does_more else {path}


def _files_of(module: str) -> set[Path]:
    """The files behind `import module`."""
    path = _module(module) if module.split(".")[0] in PACKAGES else None
    return {path} if path else set()


def _defined(tree: ast.Module) -> list[str]:
    """The names of the classes, functions and constants that a file defines."""
    definitions = {node.name for node in tree.body if isinstance(node, ast.ClassDef | ast.FunctionDef)}
    assigned = [target for node in tree.body if isinstance(node, ast.Assign) for target in node.targets]
    return sorted(definitions | {target.id for target in assigned if isinstance(target, ast.Name)})


def _handed_on(tree: ast.Module, package: str) -> dict[str, tuple[str, str]]:
    """{name: (module, name there)} of what a package's `__init__` hands on, by import or by a dict of modules."""
    names = {}
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom):
            names |= {alias.asname or alias.name: (_absolute(node, package), alias.name) for alias in node.names}
        elif isinstance(node, ast.Dict):
            for name, module in zip(node.keys, node.values, strict=True):
                if isinstance(name, ast.Constant) and isinstance(module, ast.Constant):
                    names[str(name.value)] = f"{package}.{str(module.value).lstrip('.')}", str(name.value)
    return names


def _busy(module: str) -> set[Path]:
    """The `__init__` files above a module that do more than import: what they do is code that runs."""
    parts, files = module.split("."), set()
    for depth in range(1, len(parts)):
        path = _module(".".join(parts[:depth]))
        if path is not None and path.name == "__init__.py" and _facts(path).does_more:
            files.add(path)
    return files


def _does_more(tree: ast.Module) -> bool:
    for node in tree.body:
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


def _absolute(node: ast.ImportFrom, package: str) -> str:
    if not node.level:
        return node.module or ""
    base = package.split(".")[: len(package.split(".")) - node.level + 1]
    return ".".join([*base, *([node.module] if node.module else [])])


def _data_files(path: Path) -> set[Path]:
    """The files below a module's folder that are no Python: templates, shaders, scripts."""
    paths = path.parent.rglob("*.*")
    return {file for file in paths if file.is_file() and file.suffix != ".py" and "__pycache__" not in file.parts}


def _running(tree: ast.AST) -> list[ast.AST]:
    """All nodes of a tree but those that only type checkers read."""
    nodes, ahead = [], [tree]
    while ahead:
        node = ahead.pop()
        if not _is_for_types(node):
            nodes.append(node)
            ahead += ast.iter_child_nodes(node)
    return nodes


def _named(node: ast.Name | ast.alias) -> str:
    return node.id if isinstance(node, ast.Name) else node.name


def _is_text(node: ast.AST) -> bool:
    return isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant) and isinstance(node.value.value, str)


def _is_for_types(node: ast.AST) -> bool:
    return isinstance(node, ast.If) and "TYPE_CHECKING" in ast.unparse(node.test)
