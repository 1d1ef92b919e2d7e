"""The parser of all commands, and the check of an output folder."""

import argparse
from pathlib import Path

from haptic_glance.base.files import check_folder


def command_parser(name: str, about: str, usage: str | None = None) -> argparse.ArgumentParser:
    """The parser of a command; about: the text of --help, whose first line comes before the options."""
    first, _, rest = about.partition("\n")
    form = argparse.RawDescriptionHelpFormatter
    return argparse.ArgumentParser(f"haptic-glance {name}", usage, first, rest, formatter_class=form)


def check_output_folder(out: Path, meshes: Path) -> None:
    """Raises ValueError where --out cannot be a folder, or is that of the meshes (a file or a folder of files)."""
    if out.resolve() == (meshes if meshes.is_dir() else meshes.parent).resolve():
        raise ValueError(f"--out {out} is the folder of the meshes: name another one")
    check_folder(out, f"--out {out}")
