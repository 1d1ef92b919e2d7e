"""The small feed-forward net."""

import numpy as np
import pytest
import torch

from haptic_glance.know.network import FeedForward

pytestmark = pytest.mark.slow

RANDOM = np.random.default_rng(0)
LABELS = np.repeat(["cup", "duck", "hand"], 40)
SAMPLES = RANDOM.normal(size=(120, 5)) + 3 * np.repeat(np.eye(3, 5), 40, axis=0)


def test_agrees_with_torch_autograd_and_its_adadelta():
    ours = FeedForward(hidden=(7, 4), epochs=0, seed=3).fit(SAMPLES, LABELS)
    reference = torch.nn.Sequential(
        torch.nn.Linear(5, 7), torch.nn.ReLU(), torch.nn.Linear(7, 4), torch.nn.ReLU(), torch.nn.Linear(4, 3)
    )
    with torch.no_grad():
        for layer, (weights, bias) in zip(reference[::2], ours._layers, strict=True):
            layer.weight.copy_(torch.as_tensor(weights.T.copy()))
            layer.bias.copy_(torch.as_tensor(bias.copy()))
    optimiser = torch.optim.Adadelta(reference.parameters(), lr=1.0, rho=0.99, eps=1e-8)
    trained = FeedForward(hidden=(7, 4), epochs=2, seed=3).fit(SAMPLES, LABELS)
    order = np.random.default_rng(3)
    for weights, _ in ours._layers:
        order.uniform(size=weights.shape)  # the draws that made the weights
    for _ in range(2):
        for i in order.permutation(len(SAMPLES)):
            logits = reference(torch.as_tensor(SAMPLES[i], dtype=torch.float32))
            optimiser.zero_grad()
            torch.nn.functional.cross_entropy(logits, torch.tensor(i // 40)).backward()
            optimiser.step()
    expected = reference(torch.as_tensor(SAMPLES, dtype=torch.float32)).softmax(dim=1).detach().numpy()
    assert np.allclose(trained.predict_proba(SAMPLES), expected, atol=1e-4)
    assert not np.allclose(ours.predict_proba(SAMPLES), expected, atol=1e-2)


def test_learns_what_is_easy_and_the_seed_decides_the_result():
    net, same, other = (FeedForward(epochs=30, seed=seed).fit(SAMPLES, LABELS) for seed in (1, 1, 2))
    chances = net.predict_proba(SAMPLES)
    assert (net.predict(SAMPLES) == LABELS).mean() > 0.95 and np.allclose(chances.sum(axis=1), 1, atol=1e-5)
    assert np.array_equal(chances, same.predict_proba(SAMPLES))
    assert not np.array_equal(chances, other.predict_proba(SAMPLES))


@pytest.mark.parametrize("samples", [SAMPLES[:3], SAMPLES[0], np.full_like(SAMPLES, np.nan)])
def test_bad_samples_are_refused(samples):
    with pytest.raises(ValueError, match="samples must be finite"):
        FeedForward().fit(samples, LABELS)
