"""Measures of maps: light on the silhouette, which is kept out, and what the hues of an object change."""

import numpy as np
import pytest
import trimesh

from haptic_glance.look.channels import CHANNELS, conspicuity
from haptic_glance.look.views import Material, Viewpoint, render
from haptic_glance.mesh.mesh import Mesh
from stages.conspicuity.measure import background_rows, hue_rows, measured_maps, silhouette_share

FRONT, SIZE = Viewpoint(0, 0), (450, 600)
MATERIALS = {"matte": Material(), "shiny": Material(0.1, 0.7, 0.3, 20)}
GREY, GREEN, RED = (120, 120, 120), (60, 150, 60), (150, 60, 60)  # green and red are equally bright
SPOT = np.array([0.4, 0.24, 0.18])  # on the ball, right and above of the middle


def test_the_share_of_the_silhouette_on_maps_of_a_disc():
    y, x = np.mgrid[:450, :600]
    distance = np.hypot(y - 225, x - 300)
    mask = distance < 140
    assert silhouette_share(mask.astype(np.float32), mask) == pytest.approx(1, abs=0.01)
    assert silhouette_share((mask & (distance > 136)).astype(np.float32), mask) > 10
    assert silhouette_share((distance < 50).astype(np.float32), mask) == 0
    assert np.isnan(silhouette_share(np.zeros(SIZE, np.float32), mask))
    small = np.zeros((60, 80), dtype=bool)
    small[20:40, 30:50] = True
    assert np.isnan(silhouette_share(np.ones((15, 20), np.float32), small))  # no pixel in the band


def test_filling_keeps_a_box_from_being_outlined():
    box = trimesh.creation.box((0.5, 0.5, 0.3))
    mesh = Mesh(box.vertices, box.faces)
    view = render(mesh, Viewpoint(30, 20), SIZE, "raster")
    channels = ["contrast", "edge", "orientation"]
    _, filled = measured_maps(mesh, view, channels, (112, 150))
    raw = background_rows(mesh, view, channels, (112, 150))
    for with_fill, without in zip(filled, raw, strict=True):
        assert with_fill["value"] < 1.2 and with_fill["value"] < without["value"] and with_fill["seconds"] > 0


def test_no_channel_lights_the_silhouette_of_a_bumpy_object():
    ball = trimesh.creation.icosphere(4, radius=0.3)
    ball.vertices *= 1 + 0.15 * np.sin(9 * ball.vertices[:, [0]] + 1) * np.cos(7 * ball.vertices[:, [1]])
    head = trimesh.creation.icosphere(3, radius=0.12).apply_translation([0.33, 0.1, 0.22])
    body = trimesh.util.concatenate([ball, head])
    mesh = Mesh(body.vertices, body.faces)
    view = render(mesh, Viewpoint(30, 20), SIZE, "raster")
    shares = {name: silhouette_share(values, view.mask) for name, values in conspicuity(mesh, view, CHANNELS).items()}
    assert all(np.isnan(share) or share < 2 for share in shares.values()), shares
    assert np.isfinite([*shares.values()]).sum() > 5


def painted(ball, around, spot):
    """The ball in one colour, with a spot of another that faces the camera."""
    near = np.linalg.norm(ball.vertices - SPOT, axis=1) < 0.08
    return Mesh(ball.vertices, ball.faces, np.where(near[:, None], spot, around).astype(np.uint8))


def maps(mesh, material):
    """({channel: map}, (h, w) boolean: around the spot, (h, w) boolean: on the object)."""
    values = conspicuity(mesh, render(mesh, FRONT, SIZE, "raster", material=material), ["color", "dkl", "intensity"])
    rows, columns = np.indices(values["color"].shape) * 4 + 1.5
    right, up = (columns - 299.5) / 429.35, (224.5 - rows) / 429.35
    return values, np.hypot(right - SPOT[1], up - SPOT[2]) < 0.1, np.hypot(right, up) < 0.45


@pytest.mark.parametrize("material", MATERIALS.values(), ids=MATERIALS)
def test_color_and_dkl_see_a_spot_of_another_hue_and_intensity_does_not(ball, material):
    values, spot, ball_seen = maps(painted(ball, GREEN, RED), material)
    plain, _, _ = maps(painted(ball, GREEN, GREEN), material)
    for channel, times in (("color", 3), ("dkl", 1.5)):
        assert values[channel][spot].mean() > times * values[channel][ball_seen & ~spot].mean()
        assert np.abs(values[channel] - plain[channel]).max() > 0.2
    assert np.abs(values["intensity"] - plain["intensity"]).max() < 0.02
    alike = np.corrcoef(plain["color"][ball_seen], plain["intensity"][ball_seen])[0, 1]  # one colour shows its shading
    assert plain["color"].max() > 0.1 and (alike < 0.6 if material.specular else alike > 0.99)
    assert not maps(painted(ball, GREY, GREY), material)[0]["color"].any()


def likeness(ball, around, spot):
    """{(metric, channel): value} of the ball with a spot."""
    mesh = painted(ball, around, spot)
    view = render(mesh, FRONT, SIZE, "raster")
    values = conspicuity(mesh, view, ["color", "dkl", "intensity"], (112, 150))
    return {(row["metric"], row["method"]): row["value"] for row in hue_rows(mesh, view, values, (112, 150))}


def test_what_hues_change_is_measured_where_there_are_any(ball):
    values = likeness(ball, GREEN, RED)
    assert values["grey_likeness", "color"] is None  # flat in grey
    assert values["grey_likeness", "intensity"] > 0.99  # but for rounding
    assert values["grey_likeness", "dkl"] < 0.96
    assert values["intensity_likeness", "dkl"] < 0.9 and values["intensity_likeness", "intensity"] == 1
    assert likeness(ball, GREY, (90,) * 3) == {}
