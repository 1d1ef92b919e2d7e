"""Recognises the mesh on the table, or a hidden one, by its touches: the panel Know, free of viser."""

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from haptic_glance.base.extras import MissingExtra
from haptic_glance.base.rng import rng
from haptic_glance.know import NONE, Exploration, Library, known_objects, learn, primitives, touched
from haptic_glance.mesh.mesh import Mesh
from haptic_glance.touch.surface import as_surface

from .specimen import Specimen, open_file

HOUSEHOLD = Path("data") / "household" / "meshes"  # where `make repro` puts them, below the current folder
MOST = 60  # objects


@dataclass
class Guess:
    """An object that is touched.

    name: what it is. hidden: whether its mesh and name are not shown before the end. helped: touches that the planner
    made. person_answer: the person's guess, who need not wait until the belief is sure. over: whether a hidden object
    is found out, or given up. verdict_text: the verdict, once it is known.
    """

    specimen: Specimen
    exploration: Exploration
    name: str
    hidden: bool = False
    helped: int = 0
    person_answer: str = ""
    over: bool = False
    verdict_text: str = ""

    @property
    def touches(self) -> int:
        """How many were made."""
        return len(self.exploration.images)


def gather(
    files: Sequence[Path], up: str | None, table: Specimen | None, basic: bool, household: Path | None
) -> tuple[dict[str, Mesh], list[str]]:
    """({name: normalised mesh}, what was left out) of all that can be known.

    Basic shapes, the household objects, the files that were opened with the studio, and the mesh on the table; of equal
    names the later ones.
    """
    meshes, notes = primitives() if basic else {}, []
    if household is not None:
        theirs, notes = known_objects(household, MOST)
        meshes |= theirs
    for path in files[:MOST]:
        try:
            meshes[path.stem] = open_file(path, up).mesh
        except (ValueError, OSError, MissingExtra) as error:
            notes.append(f"{path.name}: {error}")
    if table is not None:
        meshes[table.name] = table.mesh
    for name, mesh in list(meshes.items()):
        try:
            touched(name, mesh)
        except ValueError as error:
            notes.append(str(error))
            del meshes[name]
    return meshes, notes


def without_stranger(meshes: Mapping[str, Mesh], table: Specimen | None, seed: int | None = None) -> dict[str, Mesh]:
    """The meshes that are learned if an object may be unknown: all but that on the table, or with None one by lot."""
    if table is not None:
        stranger = table.name
    else:
        stranger = str(np.random.default_rng(seed).choice(sorted(meshes))) if meshes else ""
    return {name: mesh for name, mesh in meshes.items() if name != stranger}


def study(meshes: Mapping[str, Mesh], placed: bool, unknown: bool = False) -> tuple[Library, float]:
    """(the Library, seconds that it took). unknown: whether an object may be none of these."""
    start = time.perf_counter()
    library = learn(meshes, placed, turned=not placed, unknown=unknown)
    return library, time.perf_counter() - start


def guess(library: Library, meshes: Mapping[str, Mesh], table: Specimen | None, seed: int | None = None) -> Guess:
    """A Guess at the mesh on the table, or, with None, at one of the known objects, drawn by lot and hidden.

    A hidden object lies in a random pose, unless the library's objects stand as they were learned. If the library
    lacks some of the meshes, such a stranger hides in half of the games.
    seed: of the lot, None for another one each time.
    """
    random = np.random.default_rng(seed)
    strangers = [name for name in meshes if name not in library.names]
    drawn_from = strangers if table is None and strangers and random.random() < 0.5 else library.names
    name = str(random.choice(drawn_from)) if table is None else table.name
    specimen = table or Specimen(meshes[name], name)
    if table is None and not library.placed:
        turn = Rotation.random(None, random)
        specimen = Specimen(replace(meshes[name], vertices=turn.apply(meshes[name].vertices)), name)
    places = random if table is None else rng(0, name)
    exploration = Exploration(library, as_surface(specimen.mesh), places)
    return Guess(specimen, exploration, name, hidden=table is None)


def by_planner(game: Guess) -> tuple[int, str]:
    """(touches, the object that it knows then, or empty) of the planner that explores the same object alone."""
    planner = Exploration(game.exploration.library, game.exploration.surface, rng(1, game.name))
    name = planner.finish()
    return len(planner.images), name


def verdict(game: Guess, planner: tuple[int, str], escaped: Callable[[str], str] = str) -> str:
    """Who knew it, in Markdown, once it is shown. escaped: of names, so that nothing of them is Markdown."""
    is_known = game.name in game.exploration.library.names
    right, about = (game.name, "") if is_known else (NONE, ", none of the known objects")
    theirs = f"the planner alone knew it after {planner[0]}"
    if planner[1] != right:
        theirs = f"took it for {escaped(planner[1])}" if planner[1] else "gave up"
        theirs = f"the planner alone {theirs} after {planner[0]}"
    answer = game.person_answer or game.exploration.belief.known
    yours = "You knew it" if answer == right else f"You took it for {escaped(answer)}" if answer else "You gave up"
    helped = f", {game.helped} of them the planner's" if game.helped else ""
    return f"**It is {escaped(game.name)}{about}.** {yours} after {count(game.touches)}{helped}; {theirs}."


def count(touches: int) -> str:
    """A number of touches, in words."""
    return f"{touches} touch{'' if touches == 1 else 'es'}"
