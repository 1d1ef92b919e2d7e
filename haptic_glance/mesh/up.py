"""The axis of a mesh file that points up: by the file's or a person's word, or else by the shape."""

import argparse
import re
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from .axes import ALLOWED, AUTO, axis_named
from .mesh import Mesh
from .repair import rotate_to_z_up
from .upright import CANDIDATES, SURE, probable_up

UP_OF_FORMAT = {".glb": "y", ".depth": "z"}  # glTF 2.0, section 3.4; the other formats do not say, but in our comment
STATED = re.compile(rb"(?:comment|#) haptic-glance: (\S+) points up")
HEAD = 1000  # bytes of a file in which that comment is looked for
Y_UP = np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]])  # from z up to y up, as Blender and others turn a glTF back


def add_up(command: argparse.ArgumentParser, remark: str = "") -> None:
    """Adds the option --up to a command line about one mesh file; remark: what else to say of it.

    Its value may begin with a minus, which argparse alone takes for another option.
    """
    text = f"the axis that points up: {ALLOWED} (default: as the file states, which every glTF does, else auto: y or z"
    command.add_argument("--up", metavar="AXIS", type=_axis, help=f"{text}, by the shape{remark and '; '}{remark})")
    parse = command.parse_known_args

    def joined(args: Sequence[str] | None = None, namespace: argparse.Namespace | None = None):
        words = list(args or [])
        for place in range(len(words) - 1, 0, -1):
            if words[place - 1] == "--up" and re.match(r"-[xyzXYZ\d.]", words[place]):
                words[place - 1 : place + 1] = [f"--up={words[place]}"]
        return parse(words if args is not None else None, namespace)

    command.parse_known_args = joined  # type: ignore[method-assign]  # of the same use


def _axis(text: str) -> str:
    try:
        return axis_named(text)
    except ValueError as error:
        raise argparse.ArgumentTypeError(str(error)) from None


def upright_by(mesh: Mesh, path: Path, up: str | None) -> tuple[Mesh, str]:
    """(the Mesh of a file with `up`, what is known of that axis, for a line of progress).

    up: the axis that a person names; None for that of the file, or of the shape where the file does not say.
    """
    kind = path.suffix[1:].upper()
    if up is None and path.suffix.lower() in UP_OF_FORMAT:
        return mesh, f"{mesh.up} up, as in every {kind}"
    if up is None and mesh.up != AUTO:
        return mesh, f"{mesh.up} up, as the file says"
    if up is not None and axis_named(up) != AUTO:
        return replace(mesh, up=up), f"{axis_named(up)} up"
    return assumed(mesh, f"{kind} files do not store it", "--up {}")


def assumed(mesh: Mesh, why: str, remedy: str) -> tuple[Mesh, str]:
    """(the Mesh with the axis that its shape suggests, a sentence on it); remedy: a format of how to say another."""
    axis, probability = probable_up(mesh)
    advice = remedy.format(next(name for name in CANDIDATES if name != axis))
    evidence = f"probability {probability:.2f}; {why}"
    if probability < SURE:
        note = f"assuming {axis} is up, but the shape hardly tells ({evidence}; say {remedy.format(axis)} or {advice})"
    else:
        note = f"assuming {axis} is up ({evidence}; {advice} for the other)"
    return replace(mesh, up=axis), note


def stated_up(content: bytes) -> str | None:
    """The axis that a comment of ours at the head of a file names, None without one."""
    match = STATED.search(content[:HEAD])
    try:
        return axis_named(match[1].decode()) if match else None
    except ValueError:
        return None


def with_stated_up(content: bytes, suffix: str, up: str) -> bytes:
    """The content of a mesh file with a comment that names the axis, where the format does not imply it.

    An ASCII comment of ply, obj and off; the header of a binary stl.
    """
    comment = b"haptic-glance: %s points up" % up.encode()
    if suffix in UP_OF_FORMAT:
        return content
    if suffix == ".ply":
        return re.sub(rb"^(ply\r?\nformat [^\n]*\n)", rb"\1comment " + comment + b"\n", content, count=1)
    if suffix == ".off":
        head, _, rest = content.partition(b"\n")
        return b"\n".join([head, b"# " + comment, rest])
    if suffix == ".stl":
        return (b"# " + comment).ljust(80, b" ") + content[80:]
    return b"# " + comment + b"\n" + content


def upright_for(path: Path, mesh: Mesh) -> tuple[Mesh, str]:
    """(the Mesh turned upright as the format of a path to be written has it, what to say of that, or empty).

    Formats that do not say which axis points up take every mesh as it is.
    """
    up = UP_OF_FORMAT.get(path.suffix.lower(), mesh.up)
    if up == mesh.up:
        return mesh, ""
    upright_mesh = replace(mesh, vertices=rotate_to_z_up(mesh).vertices @ Y_UP.T, up=up)
    return upright_mesh, f"{path.name} is {up} up, as every {path.suffix[1:].upper()}: turned from {mesh.up} up"
