"""The options at each stage from mesh to named object, and the settings of a choice."""

from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass, fields, replace
from functools import lru_cache
from typing import Any

from haptic_glance.look.points.methods import method_named
from stages.classification import Params as Classification
from stages.compose import composed
from stages.conspicuity import Params as Conspicuity
from stages.engine.settings import check_section
from stages.imprints import Params as Imprints
from stages.lod import Params as Lod
from stages.salient_points import Params as SalientPoints
from stages.views import Params as Views

WIDTH = 0.16  # units, of every array: that of 16 cells at 0.01 (T4.3.1), so that cells mean resolution alone
WHOLE = "100%"  # the mesh as it is
SPACE: dict[str, tuple[Any, ...]] = {
    "method": ("glance", "thesis_ssim", "itti", "harris", "farthest", "random"),
    "viewpoints": ("twelve", "four"),
    "image_rows": (450, 225),  # the default's 900 take most of an hour of a search; it is asked about as it is
    "points": (60, 40, 20),
    "cells": (16, 8, 32),
    "level": (WHOLE, "1000", "500"),
    "touches": (1, 3, 5),
    "classifier": ("knn", "svm", "decision_tree", "naive_bayes", "deep_learning"),
}


@dataclass(frozen=True, order=True)
class Choice:
    """One way from a mesh to a name: an option of SPACE for each stage.

    viewpoints and image_rows are "" and 0 where the method looks at no picture: it then costs none.
    """

    method: str
    viewpoints: str
    image_rows: int
    points: int
    cells: int
    level: str
    touches: int
    classifier: str

    @property
    def name(self) -> str:
        """The choice as the name of a file."""
        return "-".join(str(value).replace("%", "pct") for value in asdict(self).values() if value)

    @property
    def columns(self) -> dict[str, Any]:
        """The choice as cells of a row; those that do not apply are empty."""
        return {key: value or None for key, value in asdict(self).items()}


def choice_of(options: Mapping[str, Any]) -> Choice:
    """The Choice of an option for each name of SPACE, without pictures where the method has no channels."""
    choice = Choice(**options)
    return choice if method_named(choice.method).channels else replace(choice, viewpoints="", image_rows=0)


DEFAULT = Choice("glance", "", 0, 60, 16, WHOLE, 1, "knn")  # what the pipeline does, T table 4.1


def one_choice_changed(choice: Choice) -> Iterator[Choice]:
    """The choices that differ from one in a single stage; where pictures come in, they are the default's."""
    values = {field.name: getattr(choice, field.name) or SPACE[field.name][0] for field in fields(choice)}
    choices = (choice_of(values | {name: option}) for name, options in SPACE.items() for option in options)
    yield from dict.fromkeys(other for other in choices if other != choice)


@dataclass(frozen=True)
class Settings:
    """The sections of the stages that a choice passes."""

    views: Views
    conspicuity: Conspicuity
    salient_points: SalientPoints
    lod: Lod
    imprints: Imprints
    classification: Classification


@lru_cache(maxsize=64)
def settings_of(choice: Choice) -> Settings:
    """The settings that Hydra composes of a choice; ParamsError for an option that the settings do not know."""
    overrides = [
        f"classifier={choice.classifier}",
        f"classification.touches=[{choice.touches}]",
        f"salient_points.methods=[{choice.method}]",
        f"salient_points.count={choice.points}",
        f"imprints.methods=[{choice.method}]",
        f"imprints.cells=[{choice.cells},{choice.cells}]",
        f"imprints.pitch={WIDTH / choice.cells:g}",
    ]
    if choice.level != WHOLE:
        overrides.append(f"lod.targets=['{choice.level}']")
    if choice.image_rows:
        rows, columns = choice.image_rows, choice.image_rows * 4 // 3
        overrides += [f"views.viewpoints={choice.viewpoints}", f"views.size=[{rows},{columns}]"]
        overrides += [f"conspicuity.size=[{rows // 4},{columns // 4}]"]
    sections = composed(["data=household", *overrides])
    schemas = {field.name: field.type for field in fields(Settings)}
    return Settings(**{name: check_section(schema, sections[name]) for name, schema in schemas.items()})  # type: ignore[arg-type]
