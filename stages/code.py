"""Writes code.yaml: a digest of the code of each stage, which DVC compares to find the stages whose code has changed.

A changed comment or docstring changes no digest; see stages.engine.code. Git keeps the file, so that DVC can compare in
a fresh clone.
"""

import argparse

from haptic_glance.base.errors import errors_in_one_line
from haptic_glance.base.files import write_text
from stages.engine.code import stage_digests
from stages.engine.settings import CODE, check_clone


def digests_text() -> str:
    """The text of code.yaml."""
    return "".join(f'{stage}: "{digest}"\n' for stage, digest in stage_digests().items())


def main() -> None:
    """Writes the digests to the current folder."""
    parser = argparse.ArgumentParser(prog="python -m stages.code", description=__doc__)
    errors_in_one_line("code")
    parser.parse_args()
    check_clone()
    write_text(CODE, digests_text())


if __name__ == "__main__":
    main()
