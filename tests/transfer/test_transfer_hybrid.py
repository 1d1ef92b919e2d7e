"""The stitched network answers as the two that it was made of, knows what is absent, and refuses what does not fit."""

import copy

import pytest
import torch

from haptic_glance.base.fetch import cache_folder
from haptic_glance.deep.hybrid import MIDDLE, HybridNet, Switch, join_senses, present
from haptic_glance.deep.images import normalise
from haptic_glance.deep.network import build, count_parameters, recalibrate
from haptic_glance.deep.weights import PACKAGES
from stages.transfer.hybrid_data import in_batches

SIZE, CLASSES = 32, 3


def tuned(network, seed, middle=MIDDLE):
    """A copy whose layers outside the middle moved, weights and statistics, as a training would move them."""
    found, generator = copy.deepcopy(network), torch.Generator().manual_seed(seed)
    for part in (found.convolutions[: middle[0]], found.convolutions[middle[1] :], found.head):
        for value in part.state_dict().values():
            if value.is_floating_point():
                value.mul_(1 + 0.1 * torch.rand(value.shape, generator=generator))
    return found


@pytest.fixture(scope="module")
def base():
    """An untrained network whose every layer passes a signal on: its statistics are of noise."""
    network = build("mobilenet_v2", CLASSES, "random", 0)
    noise = normalise(torch.rand(16, 3, SIZE, SIZE, generator=torch.Generator().manual_seed(0)))
    recalibrate(network, lambda ids: noise[ids], range(16))
    network.head[1].weight.data.mul_(10)
    return network


@pytest.fixture(scope="module")
def pair(base):
    return tuned(base, 1), tuned(base, 2)


@pytest.fixture(scope="module")
def hybrid(pair):
    return HybridNet(*pair)


@pytest.fixture(scope="module")
def images():
    return torch.rand(4, 3, SIZE, SIZE, generator=torch.Generator().manual_seed(5))


@torch.no_grad()
def differences(hybrid, pair, images):
    own = [network(normalise(images)) for network in pair]
    found = hybrid(join_senses(images, None)).vision, hybrid(join_senses(None, images)).touch
    spread = min(float((scores.amax(0) - scores.amin(0)).max()) for scores in own)
    return [float((a - b).abs().max()) for a, b in zip(own, found, strict=True)], spread


@pytest.mark.slow
def test_each_head_answers_as_its_own_network(hybrid, pair, images):
    worst, spread = differences(hybrid, pair, images)
    assert max(worst) < 1e-5
    assert spread > 1e-3  # the scores depend on the image: equal ones are no accident


@pytest.mark.slow
def test_with_imagenets_weights_too(images):
    if not (cache_folder() / PACKAGES["mobilenet_v2"].filename).exists():
        pytest.skip("ImageNet's weights are not in the cache")
    base = build("mobilenet_v2", CLASSES, "imagenet", 0)
    pair = tuned(base, 1), tuned(base, 2)
    worst, spread = differences(HybridNet(*pair), pair, images)
    assert max(worst) < 1e-5
    assert spread > 1e-3


def test_the_senses_have_heads_and_early_layers_of_their_own(hybrid, images):
    seen, felt = hybrid(join_senses(images, None)).vision, hybrid(join_senses(None, images)).touch
    assert (seen - felt).abs().max() > 1e-3


def test_the_head_of_an_absent_sense_says_nothing(hybrid, images):
    assert hybrid(join_senses(images, None)).touch.isnan().all()
    assert hybrid(join_senses(None, images)).vision.isnan().all()


def test_rows_of_a_batch_are_absent_one_by_one(hybrid, images):
    mixed = join_senses(images, images.flip(0))
    mixed[0, 3:] = 0  # sees
    mixed[1, :3] = 0  # feels
    mixed[2] = 0  # neither
    scores, answer = hybrid(mixed), hybrid.predict(mixed)
    assert [row.isnan().all().item() for row in scores.vision] == [False, True, True, False]
    assert [row.isnan().all().item() for row in scores.touch] == [True, False, True, False]
    assert answer.sense[:3].tolist() == [0, 1, -1]
    assert answer.label[2] == -1 and answer.probability[2].isnan()
    alone = hybrid(join_senses(images[:1], None)).vision[0]  # summed in another order than in a batch
    assert torch.allclose(scores.vision[0], alone, rtol=1e-3)


@pytest.mark.slow
def test_both_at_once_see_the_sum_in_forward_and_not_in_apart(hybrid, images):
    both, other = join_senses(images, images.flip(0)), join_senses(images, None)
    assert torch.allclose(hybrid.separate_scores(both).vision, hybrid(other).vision, atol=1e-5)
    assert (hybrid(both).vision - hybrid(other).vision).abs().max() > 1e-3


@pytest.mark.slow
def test_prediction_is_by_the_surer_sense_after_its_temperature(pair, images):
    hybrid, both = HybridNet(*pair), join_senses(images, images.flip(0))
    hybrid.temperature.copy_(torch.tensor([1e-3, 1e3]))
    first = hybrid.predict(both)
    hybrid.temperature.copy_(torch.tensor([1e3, 1e-3]))
    second = hybrid.predict(both)
    apart = hybrid.separate_scores(both)
    assert first.sense.tolist() == [0] * 4 and first.label.equal(apart.vision.argmax(dim=1))
    assert second.sense.tolist() == [1] * 4 and second.label.equal(apart.touch.argmax(dim=1))


@pytest.mark.parametrize("level", [0.0, 0.3, 1.0])
def test_constant_channels_are_absent_at_any_level_and_after_normalisation(level):
    flat = torch.full((1, 3, 7, 5), level)
    assert not present(flat) and not present(normalise(flat))


def test_one_pixel_of_one_channel_is_enough_to_be_present():
    images = torch.zeros(1, 3, 7, 5)
    images[0, 2, 6, 4] = 1 / 255
    assert present(images)


def test_switch_keeps_or_clears_each_row():
    images, activations = torch.rand(2, 3, 4, 4), torch.rand(2, 5, 2, 2)
    images[1] = 0.5
    found = Switch()(images, activations)
    assert found[0].equal(activations[0]) and not found[1].any()


def test_shared_layers_are_counted_once(hybrid, pair):
    shared = count_parameters(pair[0].convolutions[MIDDLE[0] : MIDDLE[1]])
    assert count_parameters(hybrid) == 2 * count_parameters(pair[0]) - shared
    assert 1.42 < 2 * count_parameters(pair[0]) / count_parameters(hybrid) < 1.43  # T5.5: 1.4284, of files


@pytest.mark.slow
def test_a_longer_middle_makes_a_smaller_network(base, hybrid):
    wide = HybridNet(tuned(base, 1, (3, 18)), tuned(base, 2, (3, 18)), (3, 18))
    assert count_parameters(wide) < 0.9 * count_parameters(hybrid)


def test_middles_that_differ_are_refused_by_the_name_of_the_tensor(pair):
    other = copy.deepcopy(pair[1])
    other.convolutions[9].conv[1][0].weight.data[0] += 1e-3
    with pytest.raises(ValueError, match=r"features\.9\.conv\.1\.0\.weight differs"):
        HybridNet(pair[0], other)


@pytest.mark.slow
def test_statistics_that_differ_are_refused_too(pair):
    other = copy.deepcopy(pair[1])
    other.convolutions[16].conv[3].running_var[3] *= 2
    with pytest.raises(ValueError, match=r"features\.16\.conv\.3\.running_var"):
        HybridNet(pair[0], other)


def test_other_architectures_and_middles_are_refused(pair):
    with pytest.raises(ValueError, match="touch is not a mobilenet_v2"):
        HybridNet(pair[0], torch.nn.Linear(2, 2))
    with pytest.raises(ValueError, match="middle must be"):
        HybridNet(*pair, middle=(0, 17))


@pytest.mark.slow
def test_training_the_originals_later_does_not_reach_the_hybrid(base, images):
    pair = tuned(base, 1), tuned(base, 2)
    hybrid = HybridNet(*pair)
    before = hybrid(join_senses(images, None)).vision
    for network in pair:
        for value in network.parameters():
            value.data.zero_()
    assert hybrid(join_senses(images, None)).vision.equal(before)
    assert not any(value.requires_grad for value in hybrid.parameters()) and not hybrid.training


@pytest.mark.parametrize(
    "bad",
    [torch.rand(2, 3, 8, 8), torch.rand(6, 8, 8), torch.full((1, 6, 8, 8), 2.0), torch.full((1, 6, 8, 8), torch.nan)],
)
def test_images_that_are_not_six_channels_in_0_to_1_are_refused(hybrid, bad):
    with pytest.raises(ValueError, match="images must"):
        hybrid.predict(bad)


def test_join_refuses_nothing_at_all_and_unequal_sizes():
    with pytest.raises(ValueError, match="one of the two senses"):
        join_senses(None, None)
    with pytest.raises(ValueError, match="equal shapes"):
        join_senses(torch.rand(1, 3, 8, 8), torch.rand(2, 3, 8, 8))


def test_too_little_memory_names_the_remedy(images):
    def too_much(part):
        raise RuntimeError("DefaultCPUAllocator: can't allocate memory: you tried to allocate 9 bytes")

    with pytest.raises(ValueError, match="too little memory: take a smaller batch"):
        in_batches(too_much, images, "cpu")
