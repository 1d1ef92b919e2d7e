"""Which axis of a mesh file points up: what its format says, or else what a person says with --up."""

import argparse
import re
from dataclasses import replace
from pathlib import Path

import numpy as np

from stages.kit import Mesh

from .normalise import rotate_to_z_up

UP_OF_FORMAT = {".glb": "y"}  # glTF 2.0, section 3.4; the other formats do not say, but in a comment of ours
STATED = re.compile(rb"(?:comment|#) haptic-glance: ([xyz]) points up")
HEAD = 1000  # bytes of a file in which that comment is looked for
Y_UP = np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]])  # from z up to y up, as Blender and others turn a glTF back


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
    if says_up(path, mesh):
        return mesh, f"{mesh.up} up, as the file says"
    return mesh, f"{mesh.up} up, a guess, since {kind} does not say (another axis: --up)"


def stated_up(content: bytes) -> str | None:
    """The axis that a comment of ours at the head of a file names, None without one."""
    found = STATED.search(content[:HEAD])
    return found[1].decode() if found else None


def says_up(path: Path, mesh: Mesh) -> bool:
    """Whether a file says which axis of its mesh points up: by its format, or by a comment of ours."""
    return path.suffix.lower() in UP_OF_FORMAT or mesh.up != "z"


def with_stated_up(content: bytes, suffix: str, up: str) -> bytes:
    """The content of a mesh file with a comment that names the axis, where that is not z and the format has comments.

    An ASCII comment of ply, obj and off; the header of a binary stl.
    """
    said = b"haptic-glance: %s points up" % up.encode()
    if up == "z" or suffix in UP_OF_FORMAT:
        return content
    if suffix == ".ply":
        return re.sub(rb"^(ply\r?\nformat [^\n]*\n)", rb"\1comment " + said + b"\n", content, count=1)
    if suffix == ".off":
        head, _, rest = content.partition(b"\n")
        return b"\n".join([head, b"# " + said, rest])
    if suffix == ".stl":
        return (b"# " + said).ljust(80, b" ") + content[80:]
    return b"# " + said + b"\n" + content


def upright_for(path: Path, mesh: Mesh) -> tuple[Mesh, str]:
    """(the Mesh turned upright as the format of a path to be written has it, what to say of that, or empty).

    Formats that do not say which axis points up take every mesh as it is.
    """
    up = UP_OF_FORMAT.get(path.suffix.lower(), mesh.up)
    if up == mesh.up:
        return mesh, ""
    turned = replace(mesh, vertices=rotate_to_z_up(mesh).vertices @ Y_UP.T, up=up)
    return turned, f"{path.name} is {up} up, as every {path.suffix[1:].upper()}: turned from {mesh.up} up"
