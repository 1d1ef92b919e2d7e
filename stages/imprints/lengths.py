"""Lengths that people write: units of the mesh, or metres."""

METRES = {"mm": 0.001, "cm": 0.01, "in": 0.0254, "m": 1.0}  # m last, as the others may end with it


class Metres(float):
    """A length in metres, which becomes one in units of the mesh when its size is known."""


def length(text: str) -> float:
    """A number of units of the mesh, or Metres from a length such as 1mm, 0.5cm or 0.1in."""
    unit = next((name for name in METRES if text.strip().endswith(name)), "")
    number = float(text.strip().removesuffix(unit))
    return Metres(number * METRES[unit]) if unit else number
