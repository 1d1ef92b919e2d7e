"""Writes build/code/STAGE for each stage: the files that it imports and a digest of each, what DVC's stages depend on.

A changed comment, docstring, type annotation or local variable's name changes none of them; see stages.engine.code.
"""

import argparse
from pathlib import Path

from haptic_glance.base.errors import errors_in_one_line
from haptic_glance.base.files import write_text
from stages.engine.code import PACKAGE, ROOT, keep_facts, stage_digests
from stages.engine.settings import check_clone


def stage_names() -> list[str]:
    """The stages of this repository: the packages that can be run and have settings, in alphabetical order."""
    settings = [path for path in (ROOT / PACKAGE).glob("*/__init__.py") if "class Params" in path.read_text("utf-8")]
    return sorted(path.parent.name for path in settings)


def write_digests(folder: Path) -> None:
    """Writes folder/STAGE for each stage; files of stages that are gone are removed."""
    names = stage_names()
    for name in names:
        write_text(folder / name, "\n".join(f"{digest}  {path}" for path, digest in stage_digests(name).items()))
    for path in folder.iterdir():
        if path.name not in names:
            path.unlink()


def main() -> None:
    """Writes the digests below the current folder."""
    parser = argparse.ArgumentParser(prog="python -m stages.code", description=__doc__)
    errors_in_one_line("code")
    parser.parse_args()
    check_clone()
    write_digests(Path("build/code"))
    keep_facts()


if __name__ == "__main__":
    main()
