"""A training until nothing improves, on problems whose answer is known."""

from dataclasses import replace

import numpy as np
import pytest
import torch

from haptic_glance.deep.modes import Task
from haptic_glance.deep.repeatable import repeatable
from haptic_glance.deep.training import (
    Diverged,
    Learning,
    accuracy,
    check_passes,
    predict_probabilities,
    save,
    train_model,
)

FIT, VALIDATION, TEST = np.arange(60), np.arange(60, 80), np.arange(80, 120)
POINTS = torch.randn((120, 4), generator=torch.Generator().manual_seed(0))
LABELS = (POINTS[:, 0] > POINTS[:, 1]).long().numpy()
TRAINING = {"epochs": 60, "batch": 10, "momentum": 0.9}


class Killed(Exception):
    """The power goes."""


def linear(points=POINTS):
    """The task to tell points apart by a plane."""
    with repeatable(0):
        model = torch.nn.Linear(4, 2)
    return Task(model, lambda ids: points[ids], lambda ids: points[ids], lambda *_: None, lambda others: others)


def learn(task, learning, rate=0.1, labels=LABELS, **other):
    with repeatable(1):
        return train_model(task, labels, FIT, rate, learning=learning, **(TRAINING | other))


def right(task, model, ids):
    return accuracy(predict_probabilities(model, task.inputs, ids), LABELS[ids])


def scripted(accuracies, patience):
    """A Learning after passes with given validation accuracies, whose k-th weights are k."""
    learning, model = Learning(np.arange(3), patience), torch.nn.Linear(1, 1)
    for number, value in enumerate(accuracies, start=1):
        torch.nn.init.constant_(model.weight, number)
        learning.add(model, loss=1.0, validation_accuracy=value, validation_loss=1.0)
        if learning.finished:
            break
    learning.restore(model)
    return len(learning.curve), float(model.weight.detach())


def test_a_linear_problem_is_learned_to_the_end_before_the_last_pass():
    task, learning = linear(), Learning(VALIDATION, 8)
    model = learn(task, learning, epochs=500)
    assert right(task, model, FIT) == right(task, model, VALIDATION) == 1.0
    assert right(task, model, TEST) >= 0.95
    assert learning.curve[-1]["train_accuracy"] == 1.0 and learning.curve[-1]["loss"] < learning.curve[0]["loss"] / 4
    assert len(learning.curve) == min(500, learning.best_pass + 8)


def test_patience_ends_a_training_and_the_best_weights_come_back():
    assert scripted([0.5, 0.8, 0.7, 0.6, 0.9], patience=2) == (4, 2.0)
    assert scripted([0.5, 0.8, 0.7, 0.6, 0.9], patience=3) == (5, 5.0)
    assert scripted([0.5, 0.5, 0.5, 0.5], patience=2) == (3, 1.0)


def test_of_equal_accuracies_the_lowest_loss_is_best():
    learning, model = Learning(np.arange(3), 2), torch.nn.Linear(1, 1)
    for loss in (0.5, 0.3, 0.4):
        learning.add(model, validation_accuracy=0.9, validation_loss=loss)
    assert learning.best_pass == 2 and not learning.finished


def test_the_weights_that_are_returned_are_those_of_the_best_pass():
    """Labels of the validation touches that contradict the others: every pass makes them worse."""
    wrong = LABELS.copy()
    wrong[VALIDATION] = 1 - wrong[VALIDATION]
    learning = Learning(VALIDATION, 5)
    model = learn(linear(), learning, labels=wrong)
    first = learn(linear(), None, labels=wrong, epochs=learning.best_pass)
    assert learning.best_pass < len(learning.curve) < 60
    assert torch.equal(model.weight, first.weight)


def test_without_validation_every_pass_is_made_and_the_weights_are_those_without_a_curve():
    learning = Learning()
    model = learn(linear(), learning, epochs=7)
    assert len(learning.curve) == 7 and set(learning.curve[0]) == {"loss", "train_accuracy"}
    assert torch.equal(model.weight, learn(linear(), None, epochs=7).weight)


@pytest.mark.parametrize("labels", [LABELS, np.where(np.isin(np.arange(120), VALIDATION), 1 - LABELS, LABELS)])
@pytest.mark.parametrize("steps", [1, 20, 33])
def test_a_killed_training_goes_on_to_the_same_weights_and_curve(tmp_path, steps, labels):
    """Also where the best weights are older than the kill: validation touches that contradict the others."""
    task, path, whole = linear(), tmp_path / "training.pt", Learning(VALIDATION, 8)
    expected, left = learn(task, whole, labels=labels), iter(range(steps))

    def until_killed(ids):
        if next(left, None) is None:
            raise Killed
        return task.inputs(ids)

    with pytest.raises(Killed):
        other = replace(task, training_inputs=until_killed)
        learn(other, Learning(VALIDATION, 8), labels=labels, checkpoint=path)
    assert path.exists() == (steps > 6)
    again = Learning(VALIDATION, 8)
    model = learn(task, again, labels=labels, checkpoint=path)
    assert torch.equal(model.weight, expected.weight) and torch.equal(model.bias, expected.bias)
    assert again.curve == whole.curve and again.best_pass == whole.best_pass
    assert not list(tmp_path.iterdir())


def test_a_checkpoint_of_another_patience_is_not_taken(tmp_path, capsys):
    path = tmp_path / "training.pt"
    kept = []

    def keep(*arguments, **parts):
        save(*arguments, **parts)
        kept.append(path.read_bytes())

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("haptic_glance.deep.training.save", keep)
        learn(linear(), Learning(VALIDATION, 8), checkpoint=path)
    path.write_bytes(kept[3])
    learn(linear(), Learning(VALIDATION, 9), checkpoint=path)
    assert "a training with other patience" in capsys.readouterr().err


def test_a_training_that_diverges_says_in_which_pass_and_leaves_no_checkpoint(tmp_path):
    task, steps = linear(), iter(range(1000))

    def grows(ids):
        return task.inputs(ids) * (float("inf") if next(steps) == 14 else 1.0)

    with pytest.raises(Diverged, match="diverged: loss is not finite in pass 3"):
        other = replace(task, training_inputs=grows)
        learn(other, Learning(VALIDATION, 8), checkpoint=tmp_path / "training.pt")
    assert not list(tmp_path.iterdir())
    points = torch.where(torch.arange(120)[:, None] == FIT[3], float("inf"), POINTS)
    assert not bool(learn(linear(points), None).weight.isfinite().all())  # as before where nobody asks for the curve


def test_unknown_passes_and_patience_are_refused():
    with pytest.raises(ValueError, match="some.passes: many not known, choose from printed, converged"):
        check_passes(["printed", "many"], "some.passes")
    with pytest.raises(ValueError, match="some.passes: none"):
        check_passes([], "some.passes")
    with pytest.raises(ValueError, match="patience must be 1"):
        Learning(VALIDATION, 0)
