"""The command `haptic-glance`: what can be done with a mesh of one's own, and every stage of the pipeline."""

import argparse
import ast
import os
import re
import runpy
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from difflib import get_close_matches
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from textwrap import fill

REPRO = "repro"
# Command -> the module that runs it; the first line of its docstring is what --help says of it.
OWN = {
    "demo": "haptic_glance.gallery.demo",
    "gallery": "haptic_glance.gallery.command",
    "saliency": "haptic_glance.cli.saliency",
    "points": "haptic_glance.cli.points",
    "simplify": "haptic_glance.cli.simplify",
    "touch": "haptic_glance.cli.touch",
    "studio": "haptic_glance.studio.command",
}
WHOLE = {
    "scene": "stages.scene.__main__",
    "bench": "stages.bench",
    "front": "stages.front.__main__",
    "claim": "stages.claim",
    "gate": "stages.gate",
    REPRO: "stages.repro",
}
SHELL = {"completion": "haptic_glance.cli.completion"}
ABOUT = """\
exit status: 0 done; 1 something could not be done, which the last lines name; 2 the command line is wrong; 130 stopped
by Ctrl-C. Results go to stdout, progress to stderr, a line each."""
CLONE = "belongs to the pipeline, which needs a clone of the repository: there, pip install -e '.[pipeline]'"


def main() -> None:
    """Runs the subcommand that the command line names; a package that is not installed ends in one line."""
    from haptic_glance import __version__ as version

    parser = argparse.ArgumentParser(
        prog="haptic-glance",
        usage="haptic-glance COMMAND ...",
        description="Look at a 3D object, touch only the places that matter, and know what it is.",
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--version", action="version", version=f"haptic-glance {version}")
    parser.add_argument("command", help=argparse.SUPPRESS)
    parser.add_argument("rest", nargs=argparse.REMAINDER, help=argparse.SUPPRESS)
    if sys.argv[1:2] in ([], ["-h"], ["--help"]):
        parser.epilog = listing()
    if not sys.argv[1:]:
        parser.print_help(sys.stderr)
        sys.exit(2)
    chosen = parser.parse_args()
    names = {**OWN, **WHOLE, **SHELL, **commands()}
    if chosen.command not in names:
        close = " or ".join(get_close_matches(chosen.command, names)) or "one of those that --help lists"
        parser.error(f"there is no command {chosen.command!r}: try {close}")
    if chosen.command in WHOLE and pipeline() is None:
        sys.exit(f"haptic-glance {chosen.command}: {CLONE}")
    sys.argv[1:] = chosen.rest

    from haptic_glance.base.extras import MissingExtra, from_extra

    try:
        with from_extra(), quiet_pipe():
            sys.exit(run(chosen.command, chosen.rest))
    except MissingExtra as error:
        if {"-h", "--help"} & set(chosen.rest):  # what it does can be read without what it needs
            print(f"usage: haptic-glance {chosen.command} ...\n\n{about(chosen.command)}\n\n{error}")
            return
        sys.exit(f"haptic-glance {chosen.command}: {error}")


@contextmanager
def quiet_pipe() -> Iterator[None]:
    """Ends in silence where the reader of the output has gone, as after `| head`."""
    try:
        try:
            yield
        finally:
            sys.stdout.flush()
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())  # Python flushes once more at its end
        sys.exit(1)


def run(command: str, argv: Sequence[str]) -> int:
    """Runs a command, or does what `python -m stages.COMMAND` does, or `dvc repro`; returns the exit status."""
    from haptic_glance.base.errors import errors_in_one_line

    if command in {**OWN, **SHELL}:
        errors_in_one_line(command)  # before an import that takes a second, in which a person may press Ctrl-C
        work: Callable[[Sequence[str]], int | None] = import_module({**OWN, **SHELL}[command]).run
        return work(argv) or 0
    if command == REPRO:
        repro()
    runpy.run_module(f"stages.{command}", run_name="__main__", alter_sys=True)
    return 0


def repro() -> None:
    """Runs the pipeline, or what of it has changed: `dvc repro` in the current folder."""
    from dvc.cli import main as dvc

    # The stages' own `python` is this one.
    os.environ["PATH"] = os.pathsep.join([str(Path(sys.executable).parent), os.environ.get("PATH", "")])
    sys.exit(dvc([REPRO, *sys.argv[1:]]))


def pipeline() -> Path | None:
    """The folder of the pipeline's stages, which a clone has and an installed package has not."""
    found = find_spec("stages")
    folders = found.submodule_search_locations if found else None
    return next((Path(folder) for folder in folders or () if (Path(folder) / "compose.py").is_file()), None)


def commands() -> dict[str, Path]:
    """{name: the file that `python -m stages.NAME` runs}, in alphabetical order; nothing is imported."""
    folder = pipeline()
    if folder is None:
        return {}
    files = {".".join(path.relative_to(folder).parts[:-1]): path for path in folder.rglob("__main__.py")}
    files |= {path.stem: path for path in folder.glob("*.py") if path.stem != "__init__"}
    return dict(sorted(files.items()))


def listing() -> str:
    """The commands with the first line of their docstrings; of the other stages the names alone."""
    whole = {"with the pipeline (pip install -e '.[pipeline]')": WHOLE} if pipeline() else {}
    groups = {"with a mesh of your own": OWN, **whole, "for the shell": SHELL}
    wide, lines = max(len(name) for group in groups.values() for name in group), []
    for title, group in groups.items():
        texts = {name: repro.__doc__ or "" if name == REPRO else docstring(module) for name, module in group.items()}
        lines += [f"{title}:", *(f"  {name:{wide}}  {summary(text)}" for name, text in texts.items()), ""]
    if others := [name for name in commands() if name not in {**OWN, **WHOLE}]:
        names = fill(", ".join(others), 100, initial_indent="  ", subsequent_indent="  ")
        lines += ["its stages, on a data set of params.yaml (python -m stages.NAME is the same):", names, ""]
    return "\n".join([*lines, "COMMAND --help has options and examples.", "", ABOUT])


def summary(text: str) -> str:
    """The first line of a docstring, without where the thesis or a shell has it."""
    return re.sub(r"(: `| \(T\d).*", "", text.splitlines()[0]).rstrip(".")


def about(command: str) -> str:
    """The docstring of a command, which is not imported."""
    modules = {**OWN, **WHOLE, **SHELL}
    if command in modules:
        return (repro.__doc__ or "") if command == REPRO else docstring(modules[command])
    return ast.get_docstring(ast.parse(commands()[command].read_bytes())) or ""


def docstring(module: str) -> str:
    """That of a module of `stages` or of this package, which is not imported."""
    package, _, rest = module.partition(".")
    folder = pipeline() if package == "stages" else Path(__file__).parent
    if folder is None:
        return f"This command {CLONE}"
    return ast.get_docstring(ast.parse((folder / f"{rest.replace('.', '/')}.py").read_bytes())) or ""


if __name__ == "__main__":
    main()
