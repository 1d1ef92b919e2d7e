"""A head behind scaled features."""

import torch

from haptic_glance.deep.network import ScaledHead


def test_features_get_mean_zero_and_deviation_one():
    features = torch.tensor([[1.0, 10.0], [3.0, 30.0]])
    scaled = ScaledHead(torch.nn.Identity(), 2)
    scaled.fit(features)
    assert torch.allclose(scaled(features), torch.tensor([[-1.0, -1.0], [1.0, 1.0]]))


def test_the_size_of_the_features_makes_no_difference():
    features, head = torch.rand(20, 5), torch.nn.Linear(5, 3)
    found = []
    for size in (1.0, 1000.0):
        scaled = ScaledHead(head, 5)
        scaled.fit(size * features)
        found.append(scaled(size * features))
    assert torch.allclose(*found, atol=1e-4)


def test_a_feature_that_never_changes_is_not_scaled_up():
    features = torch.tensor([[1.0, 7.0], [3.0, 7.0]])
    scaled = ScaledHead(torch.nn.Identity(), 2)
    scaled.fit(features)
    assert torch.equal(scaled(features)[:, 1], torch.zeros(2))
