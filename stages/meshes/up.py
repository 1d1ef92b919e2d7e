"""Which axis of a mesh file points up: what its format says, or else what a person says with --up."""

import argparse
from dataclasses import replace
from pathlib import Path

from stages.kit import Mesh

UP_OF_FORMAT = {".glb": "y"}  # glTF 2.0, section 3.4; the other formats do not say


def add_up(command: argparse.ArgumentParser, remark: str = "") -> None:
    """Adds the option --up to a command line about one mesh file; remark: what else to say of it."""
    text = "the axis that points up (default: y for a glb, else z" + (f"; {remark})" if remark else ")")
    command.add_argument("--up", choices=["x", "y", "z"], help=text)


def upright_by(mesh: Mesh, path: Path, up: str | None) -> tuple[Mesh, str]:
    """(the Mesh of a file with `up`, its own for None, what is known of that axis, for a line of progress)."""
    if up:
        return replace(mesh, up=up), f"{up} up"
    kind = path.suffix[1:].upper()
    if path.suffix.lower() in UP_OF_FORMAT:
        return mesh, f"{mesh.up} up, as in every {kind}"
    return mesh, f"{mesh.up} up, a guess, since {kind} does not say (another axis: --up)"


def lying_note(path: Path, mesh: Mesh) -> str:
    """What to say of a file that is written in the mesh's own axes though its format has another one up; or empty."""
    expected = UP_OF_FORMAT.get(path.suffix.lower(), mesh.up)
    return "" if expected == mesh.up else f"{path.name} stays {mesh.up} up; programs expect {expected}: --up {mesh.up}"
