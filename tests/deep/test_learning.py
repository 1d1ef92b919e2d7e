"""A training until nothing improves, on problems whose answer is known; one that was killed goes on to the same end."""

from dataclasses import replace

import numpy as np
import pytest
import torch

from haptic_glance.deep.device import repeatable
from haptic_glance.deep.modes import MODES, Task
from haptic_glance.deep.network import Network
from haptic_glance.deep.training import (
    Diverged,
    Learning,
    accuracy,
    predict_probabilities,
    resume,
    save,
    train_model,
)

pytestmark = pytest.mark.slow

FIT, VALIDATION, TEST = np.arange(60), np.arange(60, 80), np.arange(80, 120)
POINTS = torch.randn((120, 4), generator=torch.Generator().manual_seed(0))
LABELS = (POINTS[:, 0] > POINTS[:, 1]).long().numpy()
WRONG = np.where(np.isin(np.arange(120), VALIDATION), 1 - LABELS, LABELS)  # validation contradicts what is learned


class Killed(Exception):
    """The power goes."""


def linear(points=POINTS):
    """The task to tell points apart by a plane."""
    with repeatable(0):
        model = torch.nn.Linear(4, 2)
    return Task(model, lambda ids: points[ids], lambda ids: points[ids], lambda *_: None, lambda others: others)


def learn(task, learning, labels=LABELS, **second):
    settings = {"rate": 0.1, "epochs": 60, "batch": 10, "momentum": 0.9} | second
    with repeatable(1):
        return train_model(task, labels, FIT, learning=learning, **settings)


def killed_after(steps, task):
    """The same task, whose inputs fail at one step."""
    left = iter(range(steps))

    def inputs(ids):
        if next(left, None) is None:
            raise Killed
        return task.training_inputs(ids)

    return replace(task, training_inputs=inputs)


def same(first, second):
    return all(torch.equal(value, second.state_dict()[key]) for key, value in first.state_dict().items())


def test_a_linear_problem_is_learned_to_the_end_before_the_last_pass():
    task, learning = linear(), Learning(VALIDATION, 8)
    model = learn(task, learning, epochs=500)
    reached = [accuracy(predict_probabilities(model, task.inputs, ids), LABELS[ids]) for ids in (FIT, VALIDATION, TEST)]
    assert reached[:2] == [1, 1] and reached[2] >= 0.95
    assert learning.curve[-1]["train_accuracy"] == 1.0 and learning.curve[-1]["loss"] < learning.curve[0]["loss"] / 4
    assert len(learning.curve) == min(500, learning.best_pass + 8)


@pytest.mark.parametrize(
    ("accuracies", "patience", "passes", "best"),
    [([0.5, 0.8, 0.7, 0.6, 0.9], 2, 4, 2), ([0.5, 0.8, 0.7, 0.6, 0.9], 3, 5, 5), ([0.5, 0.5, 0.5, 0.5], 2, 3, 1)],
)
def test_patience_ends_a_training_and_the_best_weights_come_back(accuracies, patience, passes, best):
    learning, model = Learning(np.arange(3), patience), torch.nn.Linear(1, 1)
    for number, value in enumerate(accuracies, start=1):
        torch.nn.init.constant_(model.weight, number)
        learning.add(model, loss=1.0, validation_accuracy=value, validation_loss=1.0)
        if learning.finished:
            break
    learning.restore(model)
    assert (len(learning.curve), float(model.weight.detach())) == (passes, best)


def test_of_equal_accuracies_the_lowest_loss_is_best():
    learning, model = Learning(np.arange(3), 2), torch.nn.Linear(1, 1)
    for loss in (0.5, 0.3, 0.4):
        learning.add(model, validation_accuracy=0.9, validation_loss=loss)
    assert learning.best_pass == 2 and not learning.finished


def test_the_weights_that_are_returned_are_those_of_the_best_pass():
    learning = Learning(VALIDATION, 5)
    model = learn(linear(), learning, WRONG)
    assert learning.best_pass < len(learning.curve) < 60
    assert same(model, learn(linear(), None, WRONG, epochs=learning.best_pass))


def test_without_validation_every_pass_is_made_and_the_weights_are_those_without_a_curve():
    learning = Learning()
    model = learn(linear(), learning, epochs=7)
    assert len(learning.curve) == 7 and set(learning.curve[0]) == {"loss", "train_accuracy"}
    assert same(model, learn(linear(), None, epochs=7))


@pytest.mark.parametrize("steps", [1, 20, 33])
def test_a_killed_training_goes_on_to_the_same_weights_and_curve(tmp_path, steps):
    """Also where the best weights are older than the kill."""
    task, path, whole = linear(), tmp_path / "training.pt", Learning(VALIDATION, 8)
    expected = learn(task, whole, WRONG)
    with pytest.raises(Killed):
        learn(killed_after(steps, task), Learning(VALIDATION, 8), WRONG, checkpoint=path)
    assert path.exists() == (steps > 6)
    again = Learning(VALIDATION, 8)
    assert same(learn(task, again, WRONG, checkpoint=path), expected)
    assert again.curve == whole.curve and again.best_pass == whole.best_pass
    assert not list(tmp_path.iterdir())


def test_a_training_that_diverges_says_in_which_pass_and_leaves_no_checkpoint(tmp_path):
    task, steps = linear(), iter(range(1000))

    def grows(ids):
        return task.inputs(ids) * (float("inf") if next(steps) == 14 else 1.0)

    with pytest.raises(Diverged, match="diverged: loss is not finite in pass 3"):
        learn(replace(task, training_inputs=grows), Learning(VALIDATION, 8), checkpoint=tmp_path / "training.pt")
    assert not list(tmp_path.iterdir())
    points = torch.where(torch.arange(120)[:, None] == FIT[3], float("inf"), POINTS)
    assert not bool(learn(linear(points), None).weight.isfinite().all())  # as before where nobody asks for the curve


IMPRINTS = np.random.default_rng(0).random((80, 16, 16)).astype(np.float32)
SHORT = {"rate": 0.01, "epochs": 4, "batch": 20, "seed": 5}  # three steps a pass


def small(width=8):
    layers = [torch.nn.Conv2d(3, width, 5, stride=2), torch.nn.BatchNorm2d(width), torch.nn.ReLU()]
    return Network(torch.nn.Sequential(*layers), width, 2, dropout=0.2)


def task_of(mode, width=8, size=32):
    with repeatable(0):
        return MODES[mode](small(width), IMPRINTS, size, 1)


@pytest.mark.parametrize("mode", list(MODES))
def test_a_killed_network_ends_with_the_same_weights_and_repeats_no_finished_pass(tmp_path, mode):
    whole, path, steps = task_of(mode), tmp_path / "trial.pt", []
    with pytest.raises(Killed):
        learn(killed_after(7, whole), None, **SHORT, checkpoint=path)

    def counted(ids):
        steps.append(len(ids))
        return whole.training_inputs(ids)

    torch.rand(7)
    resumed = learn(replace(whole, training_inputs=counted), None, **SHORT, checkpoint=path)
    assert len(steps) == 2 * 3 and not path.exists()  # two passes of three steps were done
    assert same(resumed, learn(whole, None, **SHORT))


def test_a_checkpoint_is_whole_or_absent(tmp_path, monkeypatch):
    path, model = tmp_path / "trial.pt", small()
    assert resume(path, {}, model=model) == 0
    save(path, 1, {"rate": 1}, model=model)
    before = path.read_bytes()

    def half(state, file):
        file.write_bytes(b"half")
        raise Killed

    monkeypatch.setattr(torch, "save", half)
    with pytest.raises(Killed):
        save(path, 2, {"rate": 1}, model=model)
    assert path.read_bytes() == before and len(list(tmp_path.iterdir())) == 1


@pytest.mark.parametrize(
    ("network", "changes", "word"),
    [
        ({"width": 4}, {}, "another architecture"), ({"size": 40}, {}, "with other images"),
        ({}, {"rate": 0.5}, "with other rate"), ({}, {"seed": 6}, "with other seed"),
        ({}, {"patience": 9}, "with other patience"),
    ],
)  # fmt: skip
def test_a_checkpoint_of_another_training_is_passed_over_with_a_word(tmp_path, capsys, network, changes, word):
    path = tmp_path / "trial.pt"

    def train(task, patience=8, checkpoint=None, **second):
        return learn(task, Learning(VALIDATION, patience), **SHORT | second, checkpoint=checkpoint)

    with pytest.raises(Killed):
        train(killed_after(4, task_of("finetuned", **network)), **changes, checkpoint=path)
    model = train(task_of("finetuned"), checkpoint=path)
    assert same(model, train(task_of("finetuned")))
    message = capsys.readouterr().err
    assert "trial.pt: ignored" in message and word in message


def test_what_cannot_be_read_or_put_back_leaves_all_as_it_was(tmp_path, capsys):
    path, model = tmp_path / "trial.pt", small()
    optimiser = torch.optim.SGD(model.parameters(), lr=0.1, momentum=0.9)
    save(path, 3, {}, model=model, optimiser=optimiser)
    whole = torch.load(path, weights_only=True)
    second = small()
    fewer = torch.optim.SGD(list(second.parameters())[:2], lr=0.1, momentum=0.9)
    before = {key: value.clone() for key, value in second.state_dict().items()}
    assert resume(path, {}, model=second, optimiser=fewer) == 0 and "ignored" in capsys.readouterr().err
    del whole["random"]
    torch.save(whole, path)
    assert resume(path, {}, model=second) == 0 and "cannot be read" in capsys.readouterr().err
    save(path, 3, {}, model=model)
    damaged, value = bytearray(path.read_bytes()), model.head[1].weight.detach().numpy().tobytes()
    damaged[damaged.index(value)] ^= 1  # one bit of one weight
    path.write_bytes(damaged)
    assert resume(path, {}, model=second) == 0 and "checksum is wrong" in capsys.readouterr().err
    path.write_bytes(b"PK\x03\x04 half a file")
    assert resume(path, {}, model=second) == 0 and "cannot be read" in capsys.readouterr().err
    assert all(torch.equal(value, before[key]) for key, value in second.state_dict().items())
