"""The command `haptic-glance`: what can be done with a mesh of one's own."""

import argparse
import ast
import gc
import re
import sys
import warnings
from collections.abc import Callable, Sequence
from difflib import get_close_matches
from importlib import import_module
from pathlib import Path

# Command -> the module that runs it; the first line of its docstring is what --help says of it.
MESH_COMMANDS = {
    "demo": "haptic_glance.gallery.demo",
    "gallery": "haptic_glance.gallery.command",
    "saliency": "haptic_glance.cli.saliency",
    "points": "haptic_glance.cli.points",
    "simplify": "haptic_glance.cli.simplify",
    "touch": "haptic_glance.cli.touch",
    "know": "haptic_glance.cli.know",
    "studio": "haptic_glance.studio.command",
}
SHELL_COMMANDS = {"completion": "haptic_glance.cli.completion"}
COMMANDS = {**MESH_COMMANDS, **SHELL_COMMANDS}
ABOUT = """\
exit status: 0 done; 1 an input or an option cannot be used, which the last lines name; 2 the command line cannot be
parsed; 130 stopped by Ctrl-C. Results go to stdout, progress to stderr, a line each."""
PIPELINE = ("bench", "claim", "gate", "scene")  # modules of stages that a person runs alone


def main() -> None:
    """Runs the subcommand that the command line names; a package that is not installed ends in one line."""
    from haptic_glance.base.errors import errors_in_one_line

    errors_in_one_line("haptic-glance")  # before the imports that take a while, in which a person may press Ctrl-C
    from haptic_glance import __version__ as version

    parser = argparse.ArgumentParser(
        prog="haptic-glance",
        usage="haptic-glance COMMAND ...",
        description="Look at a 3D object, touch only the places that matter, and know what it is.",
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--version", action="version", version=f"haptic-glance {version}")
    parser.add_argument("command", help=argparse.SUPPRESS)
    if sys.argv[1:2] in ([], ["-h"], ["--help"]):
        parser.epilog = listing()
    if not sys.argv[1:]:
        parser.print_help(sys.stderr)
        sys.exit(2)
    rest = sys.argv[2:]  # as it is: argparse would take a `--` out
    options = parser.parse_args(sys.argv[1:2])
    if options.command in PIPELINE:
        in_clone = f"run `python -m stages.{options.command}` in a clone of the repository"
        parser.error(f"{options.command} belongs to the pipeline: {in_clone}")
    if options.command not in COMMANDS:
        close = " or ".join(get_close_matches(options.command, COMMANDS)) or "one of those that --help lists"
        parser.error(f"there is no command {options.command!r}: try {close}")
    sys.argv[1:] = rest

    from haptic_glance.base.extras import MissingExtra, from_extra
    from haptic_glance.base.progress import report

    warnings.showwarning = lambda message, *_: report(options.command, str(message))  # in one line
    try:
        with from_extra():
            status = run(options.command, rest)
            print(end="", flush=True)  # an error has its line and its status here, and neither when Python ends
            sys.exit(status)
    except MissingExtra as error:
        if {"-h", "--help"} & set(rest):  # what it does can be read without what it needs
            print(f"usage: haptic-glance {options.command} ...\n\n{docstring(COMMANDS[options.command])}\n\n{error}")
            return
        sys.exit(f"haptic-glance {options.command}: {error}")


def run(command: str, argv: Sequence[str]) -> int:
    """Runs a command; returns the exit status."""
    gc.set_threshold(200_000)  # a command ends soon, and numba's graphs hold no garbage: a tenth of a first run
    from haptic_glance.base.errors import errors_in_one_line, interrupts_wait

    errors_in_one_line(command)
    from haptic_glance.base.progress import no_silence

    # Pillow warns of large pictures in two lines; `materials` refuses those that are too large in one.
    warnings.filterwarnings("ignore", message="Image size .* exceeds limit")
    with interrupts_wait():
        work: Callable[[Sequence[str]], int | None] = import_module(COMMANDS[command]).run
    with no_silence():
        return work(argv) or 0


def listing() -> str:
    """The commands with the first line of their docstrings."""
    wide, lines = max(map(len, COMMANDS)), []
    for title, group in {"with a mesh of your own": MESH_COMMANDS, "for the shell": SHELL_COMMANDS}.items():
        lines += [f"{title}:", *(f"  {name:{wide}}  {summary(docstring(group[name]))}" for name in group), ""]
    return "\n".join([*lines, "COMMAND --help has options and examples.", "", ABOUT])


def summary(text: str) -> str:
    """The first line of a docstring, without where the thesis or a shell has it."""
    return re.sub(r"(: `| \(T\d).*", "", text.splitlines()[0]).rstrip(".")


def docstring(module: str) -> str:
    """The docstring of a module of this package, which is not imported."""
    path = Path(__file__).parent.joinpath(*module.split(".")[1:]).with_suffix(".py")
    return ast.get_docstring(ast.parse(path.read_bytes())) or ""


if __name__ == "__main__":
    main()
