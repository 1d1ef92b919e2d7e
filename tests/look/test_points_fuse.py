"""The fusion of conspicuity maps."""

import numpy as np
import pytest

from haptic_glance.look.channels.channels import CHANNELS, OTHERS
from haptic_glance.look.points import COMBINATIONS, METHODS, fuse
from haptic_glance.look.weights import weights

MAPS = {"color": np.full((3, 4), 0.2), "edge": np.full((3, 4), 0.8)}


def test_fusion_without_weights_is_the_mean():
    assert np.allclose(fuse(MAPS), 0.5)


def test_fusion_follows_the_weights_and_not_their_scale():
    assert np.allclose(fuse(MAPS, {"color": 1, "edge": 3}), 0.65)
    assert np.allclose(fuse(MAPS, {"color": 10, "edge": 30}), 0.65)


def test_a_map_without_a_weight_stays_out():
    assert np.allclose(fuse(MAPS, {"edge": 0.3}), 0.8)


def test_fusion_of_equal_maps_is_that_map():
    values = np.random.default_rng(0).random((5, 6))
    assert np.allclose(fuse(dict.fromkeys(weights("thesis_ssim"), values), weights("thesis_ssim")), values)


@pytest.mark.parametrize(
    ("maps", "given", "message"),
    [
        ({}, None, "no conspicuity maps"),
        ({"a": np.ones((2, 2)), "b": np.ones((2, 3))}, None, "one shape"),
        (MAPS, {"edge": -1.0}, "not negative"),
        (MAPS, {"edge": np.nan}, "finite"),
        (MAPS, {"edge": 0.0}, "all weights are zero"),
        (MAPS, {"colour": 1.0}, "without a map: colour"),
    ],
)
def test_bad_maps_and_weights_are_errors(maps, given, message):
    with pytest.raises(ValueError, match=message):
        fuse(maps, given)


def test_combinations_and_methods_use_known_channels():
    known = {*CHANNELS, *OTHERS}
    assert all(set(channels) <= known for channels in COMBINATIONS.values())
    assert all(set(method.channels) <= known for method in METHODS.values())


def test_combinations_have_the_channels_of_their_names():
    parts = {"Con": "contrast", "Curv": "curvature", "Sym": "symmetry", "Ent": "entropy"}
    for name, channels in COMBINATIONS.items():
        if name != "VisAttAll":
            assert {channel for part, channel in parts.items() if part in name} == set(channels) - {
                "color",
                "intensity",
                "orientation",
            }
            assert ("VisAtt" in name) == ("orientation" in channels)
    assert set(weights("equal")) - set(COMBINATIONS["VisAttAll"]) == {"edge"}
