"""The command `haptic-glance`: every stage of the pipeline, and the pipeline as a whole."""

import argparse
import ast
import os
import runpy
import sys
from pathlib import Path

import stages

REPRO = "repro"


def main() -> None:
    """Runs the subcommand that the command line names; a package that is not installed ends in one line."""
    parser = argparse.ArgumentParser(
        prog="haptic-glance",
        description="Look at a 3D object, touch only the places that matter, and know what it is.",
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    names = (*commands(), REPRO)
    parser.add_argument("command", metavar="COMMAND", choices=names, help="what to run: see below")
    parser.add_argument(
        "rest", metavar="...", nargs=argparse.REMAINDER, help="its arguments: COMMAND --help lists them"
    )
    if sys.argv[1:2] in (["-h"], ["--help"]):
        parser.epilog = listing()
    chosen = parser.parse_args()
    sys.argv[1:] = chosen.rest

    from stages.kit.extras import MissingExtra, from_extra

    try:
        with from_extra():
            run(chosen.command)
    except MissingExtra as error:
        sys.exit(f"haptic-glance {chosen.command}: {error}")


def run(command: str) -> None:
    """Does what `python -m stages.COMMAND` does, or `dvc repro`."""
    if command == REPRO:
        repro()
    else:
        runpy.run_module(f"stages.{command}", run_name="__main__", alter_sys=True)


def repro() -> None:
    """Runs the pipeline, or what of it has changed: `dvc repro` in the current folder."""
    from dvc.cli import main as dvc

    # The stages' own `python` is this one.
    os.environ["PATH"] = os.pathsep.join([str(Path(sys.executable).parent), os.environ.get("PATH", "")])
    sys.exit(dvc([REPRO, *sys.argv[1:]]))


def commands() -> dict[str, Path]:
    """{name: the file that `python -m stages.NAME` runs}, in alphabetical order; nothing is imported."""
    folder = Path(stages.__path__[0])
    files = {".".join(path.relative_to(folder).parts[:-1]): path for path in folder.rglob("__main__.py")}
    files |= {path.stem: path for path in folder.glob("*.py") if path.stem != "__init__"}
    return dict(sorted(files.items()))


def listing() -> str:
    """One line per command: its name and the first line of its docstring."""
    lines = {name: ast.get_docstring(ast.parse(path.read_bytes())) or "" for name, path in commands().items()}
    lines[REPRO] = repro.__doc__ or ""
    wide = max(map(len, lines))
    return "commands:\n" + "\n".join(f"  {name:{wide}}  {text.splitlines()[0]}" for name, text in lines.items())


if __name__ == "__main__":
    main()
