"""Sees half of an object and touches it until it is known, among the meshes of a folder, in simulation.

Learns every STL, OBJ, PLY, OFF, GLB and glTF of FOLDER. The object of --object stands at an azimuth that --seed draws.
A camera takes one picture, in which a grey board hides a part of the object. Then a hand with 8 x 8 cells touches
where a touch is expected to tell most, until one name has a probability of 95 %. Writes into the folder of --out:
  index.html    the picture, the candidates after each step, where the hand came, and the imprints; without a network
Without --sized all objects have one size, a diameter of 1, and lengths are in diameters.

examples:
  haptic-glance know scans --object scans/mug.stl
  haptic-glance know scans --object mug.stl --hidden 0.8 --seed 3 --out mug_known
  haptic-glance know parts --object parts/bracket.stl --sized --up z --pose any --json
  haptic-glance know scans --object elsewhere/vase.ply --unknown
"""

import argparse
import json
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial
from pathlib import Path
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from haptic_glance.base import progress
from haptic_glance.base.extras import about
from haptic_glance.base.files import existing, said_of, write_text
from haptic_glance.base.rng import rng
from haptic_glance.know import NONE, POSES, Approach, Belief, Library, Step, known_objects, learn, stand
from haptic_glance.know import touch_until_known as touches_until_known
from haptic_glance.know.look_and_touch import CAMERA, HIDDEN, MOST, MOST_HIDDEN, half_hidden
from haptic_glance.know.objects import read_object
from haptic_glance.mesh.files import FORMATS
from haptic_glance.mesh.mesh import Mesh
from haptic_glance.mesh.repair import centre_and_radius
from haptic_glance.mesh.up import add_up

from .arguments import check_output_folder, command_parser

report = partial(progress.report, "know")
PAGE = "index.html"
SHOWN = 3  # candidates in a line
LARGEST = 1.5  # times the largest known object, beyond which an object is in another unit
SIDES = ("front", "front right", "right", "back right", "back", "back left", "left", "front left")  # of the camera
STEEP, SLANTED = 65, 10  # degrees of elevation: beyond the first, a hand comes from above; within the second, level


@dataclass(frozen=True)
class Story:
    """An object, the picture of it, and the touches until it was known.

    name: of the object; is_known: whether it was learned. there: its mesh as it stands. hidden: share of its pixels
    behind the board. picture (96, 96) in bytes. look: the belief after the look. unit: of lengths.
    """

    library: Library
    name: str
    is_known: bool
    there: Mesh
    hidden: float
    picture: np.ndarray
    look: Belief
    steps: list[Step]
    unit: str

    @property
    def last(self) -> Belief:
        """The belief after the last step."""
        return self.steps[-1].belief if self.steps else self.look

    @cached_property
    def shown(self) -> float:
        """The diameter that the pictures of the page hold: of the largest known object, or of a larger one there."""
        return max(self.library.diameter, 2 * float(np.linalg.norm(self.there.vertices, axis=1).max()))

    @cached_property
    def verdict(self) -> str:
        """right, wrong, or undecided."""
        answer = self.last.known
        truth = self.name if self.is_known else NONE
        return ("right" if answer == truth else "wrong") if answer else "undecided"

    @property
    def course(self) -> str:
        """`after a look and 2 touches`."""
        count = len(self.steps)
        return "after a look" + (f" and {count} touch{'es' * (count != 1)}" if count else "")

    @property
    def end(self) -> str:
        """The last line: the name, after how many touches, and whether it is right."""
        is_none = "" if self.is_known else f"; {self.name} is not among the known objects"
        if self.verdict == "undecided":
            return f"undecided {self.course}; the likeliest is {top(self.last, 1)}{is_none}"
        return f"{self.last.known}, {self.course}: {self.verdict}{is_none}"

    def length(self, value: float) -> str:
        """A length as a text, with its unit."""
        return f"{value:.3g} {self.unit}"


def parser() -> argparse.ArgumentParser:
    """The parser of the command line."""
    command = command_parser("know", __doc__ or "")
    command.add_argument("folder", metavar="FOLDER", type=Path, help="the folder of the meshes to learn")
    help_object = "the mesh that is looked at and touched: one of FOLDER, or another"
    command.add_argument("--object", metavar="FILE", type=Path, required=True, help=help_object)
    help_hidden = f"share of the object's pixels behind the board, 0 to {MOST_HIDDEN} (default: %(default)s)"
    command.add_argument("--hidden", metavar="SHARE", type=float, default=HIDDEN, help=help_hidden)
    help_pose = "fixed: as its file has it; turned: at any azimuth (default); any: in any rotation"
    command.add_argument("--pose", choices=POSES, default="turned", help=help_pose)
    command.add_argument("--most", metavar="N", type=int, default=MOST, help="touches at most (default: %(default)s)")
    command.add_argument("--sized", action="store_true", help="the files are in one unit, so that their sizes count")
    command.add_argument("--unknown", action="store_true", help=f"the object may be {NONE}, which is then an answer")
    command.add_argument("--seed", type=int, default=0, help="seed of the pose, the board and the noise (default: 0)")
    add_up(command, "of all files")
    command.add_argument("--out", metavar="FOLDER", type=Path, help="output folder (default: OBJECT_known)")
    command.add_argument("--json", action="store_true", help="print the steps as JSON")
    return command


def parse_options(argv: Sequence[str]) -> argparse.Namespace:
    """The options of a command line, checked; `object` becomes the path where the file is."""
    options = parser().parse_args(argv)
    if not 0 <= options.hidden <= MOST_HIDDEN:
        raise ValueError(f"--hidden {options.hidden:g}: give a share from 0 to {MOST_HIDDEN}")
    if options.most < 1:
        raise ValueError(f"--most {options.most}: give 1 or more")
    if options.seed < 0:
        raise ValueError(f"--seed {options.seed}: give 0 or more")
    if not options.folder.is_dir():
        remedy = "is a file: give the folder that holds it" if options.folder.is_file() else "no such folder"
        raise ValueError(f"{options.folder}: {remedy}")
    if not options.object.is_file() and (options.folder / options.object).is_file():
        options.object = options.folder / options.object
    if not options.object.is_file():
        raise ValueError(
            f"--object {options.object}: no such file, give a mesh file, for example one of {options.folder}"
        )
    options.out = options.out or Path(f"{options.object.stem}_known")
    check_output_folder(options.out, options.folder)
    return options


def run(argv: Sequence[str]) -> None:
    """Runs the command line `argv`, without the program's name."""
    options = parse_options(argv)
    meshes, left_out = read_folder(options)
    name, is_known, mesh = find_object(options, meshes)
    report(f"learning {len(meshes)} objects")
    library = learn(meshes, options.pose, unknown=options.unknown)
    told = tell(library, name, is_known, mesh, options)
    from .know_page import build_page

    page = options.out / PAGE
    before = existing(page)
    options.out.mkdir(parents=True, exist_ok=True)
    write_text(page, build_page(told, left_out, again(options)))
    print(json.dumps(figures(told, options, left_out)) if options.json else "\n".join(lines(told)))
    report(said_of([page], before))


def read_folder(options: argparse.Namespace) -> tuple[dict[str, Mesh], list[str]]:
    """The meshes of the folder by name, and what was left out; ValueError where fewer than two are left."""
    report(f"reading {options.folder}")
    meshes, left_out = known_objects(options.folder, sized=options.sized, up=options.up)
    for note in left_out:
        report(f"left out: {note}")
    if len(meshes) < 2:
        count = "one mesh" if meshes else "no mesh"
        remedy = f"put two or more into it; the formats are {', '.join(FORMATS)}"
        raise ValueError(f"{options.folder} holds {count} that can be touched: {remedy}")
    return meshes, left_out


def find_object(options: argparse.Namespace, meshes: dict[str, Mesh]) -> tuple[str, bool, Mesh]:
    """(name, whether it is one of the meshes, mesh) of the object."""
    path = options.object
    if path.resolve().parent == options.folder.resolve():
        for name in (path.stem, path.name, str(options.folder / path.name)):  # as known_objects names its files
            if name in meshes:
                return name, True, meshes[name]
    try:
        mesh = read_object(path, options.sized, options.up)
    except ValueError as error:
        raise ValueError(f"--object {path}: {str(error).removeprefix(f'{path}: ')}") from None
    largest = max(centre_and_radius(known)[1] for known in meshes.values())
    if (times := centre_and_radius(mesh)[1] / largest) > LARGEST:
        remedy = "bring the files into one unit, or leave out --sized"
        raise ValueError(f"{path}: it is {times:.3g} times as large as the largest known object: {remedy}")
    name = path.name if path.stem in meshes else path.stem
    report(f"{name} is not among the known objects")
    return name, False, mesh


def tell(library: Library, name: str, is_known: bool, mesh: Mesh, options: argparse.Namespace) -> Story:
    """Puts the object there, looks at it, and touches it until it is known."""
    random = rng(options.seed, f"know {name}")
    turn, rotation = 360 * random.random(), Rotation.random(None, random).as_matrix()
    pose: dict[str, Any] = {"fixed": {}, "turned": {"turn": turn}, "any": {"rotation": rotation}}
    there = stand(mesh, **pose[options.pose])
    report("looking")
    picture, mask = half_hidden(there, library.diameter, options.hidden, random)
    with about(f"--hidden {options.hidden:g}"):
        look = library.look(picture, CAMERA, mask)
    unit = "of the files' units" if options.sized else "diameters"
    story = Story(library, name, is_known, there, options.hidden, picture, look, [], unit)
    report("touching")
    steps = list(touches_until_known(look, there, options.most, random=random))
    return replace(story, steps=steps)


def lines(story: Story) -> list[str]:
    """The story for people: a line for the look, one a touch, and the end."""
    shown = [f"look at {seen(story)}: {top(story.look)}"]
    for number, step in enumerate(story.steps, 1):
        shown.append(f"touch {number}, {felt(story, step)}: {top(step.belief)}")
    return [*shown, story.end]


def seen(story: Story) -> str:
    """`40 % of mug`."""
    return f"{100 * (1 - story.hidden):.0f} % of {story.name}" if story.hidden else story.name


def felt(story: Story, step: Step) -> str:
    """`from the left, 30° above, contact after 0.6 diameters`."""
    met = f"contact after {story.length(step.travel)}" if np.isfinite(step.travel) else "it meets nothing"
    return f"{whence(step.approach)}, {met}"


def whence(approach: Approach) -> str:
    """From where the hand comes, as the camera sees it: `from the back left, 30° above`."""
    x, y, z = approach.axes[2]
    height = float(np.degrees(np.arcsin(np.clip(z, -1, 1))))
    if abs(height) > STEEP:
        return "from above" if height > 0 else "from below"
    side = SIDES[round((np.degrees(np.arctan2(y, x)) - CAMERA.azimuth) / 45) % 8]
    slant = f", {abs(height):.0f}° {'above' if height > 0 else 'below'}" if abs(height) > SLANTED else ""
    return f"from the {side}{slant}"


def top(belief: Belief, count: int = SHOWN) -> str:
    """The likeliest names with their probabilities: `mug 81 %, cup 12 %, bowl 3 %`."""
    return ", ".join(f"{name} {percent(share)}" for name, share in [*belief.probabilities.items()][:count])


def percent(share: float) -> str:
    """A probability as a text, that is 0 % or 100 % of none but these."""
    if 0 < share < 0.01 or 0.99 < share < 1:
        return "< 1 %" if share < 0.5 else "> 99 %"
    return f"{100 * share:.0f} %"


def figures(story: Story, options: argparse.Namespace, left_out: Sequence[str]) -> dict[str, Any]:
    """The story for programs."""
    steps: list[dict[str, Any]] = [{"step": "look", "probabilities": story.look.probabilities}]
    for step in story.steps:
        met = bool(np.isfinite(step.travel))
        steps.append({
            "step": "touch", "origin": step.approach.origin.tolist(), "direction": step.approach.direction.tolist(),
            "travel": step.travel if met else None,
            "contact": step.approach.contact(step.travel).tolist() if met else None,
            "imprint": step.imprint.tolist(), "probabilities": step.belief.probabilities,
        })  # fmt: skip
    return {
        "object": story.name, "is_known": story.is_known, "answer": story.last.known, "verdict": story.verdict,
        "touches": len(story.steps), "hidden": story.hidden, "pose": options.pose, "seed": options.seed,
        "unit": story.unit, "steps": steps, "left_out": list(left_out), "page": str(options.out / PAGE),
    }  # fmt: skip


def again(options: argparse.Namespace) -> str:
    """The command that does the same."""
    words = ["haptic-glance know", f"{options.folder.name}", f"--object {options.object.name}"]
    words += [f"--hidden {options.hidden:g}", f"--pose {options.pose}", f"--most {options.most}"]
    words += [f"--{name}" for name in ("sized", "unknown") if getattr(options, name)]
    words += [f"--up {options.up}"] if options.up else []
    return " ".join([*words, f"--seed {options.seed}"])
