"""What the colour channels see of rendered objects: nothing of grey, and hue apart from brightness."""

import numpy as np
import pytest

from haptic_glance.look.channels import conspicuity
from haptic_glance.look.views import Material, Viewpoint, render
from haptic_glance.mesh.mesh import Mesh
from stages.conspicuity.measure import hue_rows

FRONT, SIZE = Viewpoint(0, 0), (450, 600)
SHINY = Material(0.1, 0.7, 0.3, 20)
GREEN, RED = (60, 150, 60), (150, 60, 60)  # equally bright
SPOT = np.array([0.4, 0.24, 0.18])  # on the ball, right and above of the middle


def painted(ball, around, spot):
    """The ball in one colour, with a spot of another that faces the camera."""
    near = np.linalg.norm(ball.vertices - SPOT, axis=1) < 0.08
    return Mesh(ball.vertices, ball.faces, np.where(near[:, None], spot, around).astype(np.uint8))


def maps(mesh, material):
    """({channel: map}, (h, w) boolean: around the spot, (h, w) boolean: on the object)."""
    view = render(mesh, FRONT, SIZE, "raster", material=material)
    found = conspicuity(mesh, view, ["color", "dkl", "intensity"])
    rows, columns = np.indices(found["color"].shape) * 4 + 1.5
    right, up = (columns - 299.5) / 429.35, (224.5 - rows) / 429.35
    return found, np.hypot(right - SPOT[1], up - SPOT[2]) < 0.1, np.hypot(right, up) < 0.45


@pytest.mark.parametrize("material", [Material(), SHINY], ids=["matte", "shiny"])
def test_a_spot_of_another_hue_is_seen_by_color_and_dkl_and_not_by_intensity(ball, material):
    found, spot, ball_seen = maps(painted(ball, GREEN, RED), material)
    plain, _, _ = maps(painted(ball, GREEN, GREEN), material)
    for channel, times in (("color", 3), ("dkl", 1.5)):
        assert found[channel][spot].mean() > times * found[channel][ball_seen & ~spot].mean()
        assert np.abs(found[channel] - plain[channel]).max() > 0.2
    assert np.abs(found["intensity"] - plain["intensity"]).max() < 0.02


@pytest.mark.parametrize("material", [Material(), SHINY], ids=["matte", "shiny"])
def test_one_colour_gives_color_its_shading_and_grey_gives_it_nothing(ball, material):
    found, _, ball_seen = maps(painted(ball, RED, RED), material)
    alike = np.corrcoef(found["color"][ball_seen], found["intensity"][ball_seen])[0, 1]
    assert found["color"].max() > 0.1 and (alike < 0.6 if material.specular else alike > 0.99)
    assert not maps(painted(ball, (120,) * 3, (120,) * 3), material)[0]["color"].any()


def likeness(ball, around, spot):
    """{(metric, channel): value} of the ball with a spot."""
    mesh, names = painted(ball, around, spot), ["color", "dkl", "intensity"]
    view = render(mesh, FRONT, SIZE, "raster")
    found = conspicuity(mesh, view, names, (112, 150))
    return {(row["metric"], row["method"]): row["value"] for row in hue_rows(mesh, view, found, (112, 150))}


def test_what_hues_change_is_measured_where_there_are_any(ball):
    found = likeness(ball, GREEN, RED)
    assert found["grey_likeness", "color"] is None  # flat in grey
    assert found["grey_likeness", "intensity"] > 0.99  # but for rounding
    assert found["grey_likeness", "dkl"] < 0.96
    assert found["intensity_likeness", "dkl"] < 0.9 and found["intensity_likeness", "intensity"] == 1
    assert likeness(ball, (120,) * 3, (90,) * 3) == {}
