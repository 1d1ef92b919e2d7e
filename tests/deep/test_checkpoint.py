"""A training that was killed goes on as if nothing had happened."""

from dataclasses import replace

import numpy as np
import pytest
import torch

from haptic_glance.deep.modes import MODES
from haptic_glance.deep.network import Network
from haptic_glance.deep.repeatable import repeatable
from haptic_glance.deep.training import resume, save, train_model

SIZE = 32
LABELS = np.arange(24) % 2
IMPRINTS = np.random.default_rng(0).random((24, SIZE, SIZE)).astype(np.float32)
TRAINING = {"rate": 0.01, "epochs": 4, "batch": 8, "momentum": 0.9, "seed": 5}


class Killed(Exception):
    """The power goes."""


def small(width=8):
    layers = [torch.nn.Conv2d(3, width, 5, stride=2), torch.nn.BatchNorm2d(width), torch.nn.ReLU()]
    return Network(torch.nn.Sequential(*layers), width, 2, dropout=0.2)


def task(mode, width=8, size=SIZE):
    with repeatable(0):
        return MODES[mode](small(width), IMPRINTS, size, 1)


def killed_after(steps, whole):
    """The same task, whose inputs fail at one step."""
    left = iter(range(steps))

    def inputs(ids):
        if next(left, None) is None:
            raise Killed
        return whole.training_inputs(ids)

    return replace(whole, training_inputs=inputs)


def train(task, checkpoint=None, **other):
    with repeatable(1):
        return train_model(task, LABELS, np.arange(24), checkpoint=checkpoint, **(TRAINING | other))


def same(one, other):
    return all(torch.equal(value, other.state_dict()[key]) for key, value in one.state_dict().items())


@pytest.mark.slow
@pytest.mark.parametrize("mode", list(MODES))
@pytest.mark.parametrize("steps", [1, 7, 11])
def test_a_killed_training_ends_with_the_same_weights(tmp_path, mode, steps):
    whole, path = task(mode), tmp_path / "trial.pt"
    expected = train(whole)
    with pytest.raises(Killed):
        train(killed_after(steps, whole), path)
    assert path.exists() == (steps > 2)
    torch.rand(7)
    assert same(train(whole, path), expected)
    assert not list(tmp_path.iterdir())


def test_a_resumed_training_repeats_no_finished_pass(tmp_path):
    whole, path, seen = task("finetuned"), tmp_path / "trial.pt", []
    with pytest.raises(Killed):
        train(killed_after(7, whole), path)

    def counted(ids):
        seen.append(len(ids))
        return whole.training_inputs(ids)

    train(replace(whole, training_inputs=counted), path)
    assert len(seen) == 2 * 3  # two passes of three steps were done


def test_a_checkpoint_is_whole_or_absent(tmp_path, monkeypatch):
    path = tmp_path / "trial.pt"
    settings, model = {"rate": 1}, small()
    save(path, 1, settings, model=model)
    before = path.read_bytes()

    def half(state, file):
        file.write_bytes(b"half")
        raise Killed

    monkeypatch.setattr(torch, "save", half)
    with pytest.raises(Killed):
        save(path, 2, settings, model=model)
    assert path.read_bytes() == before and len(list(tmp_path.iterdir())) == 1


def strange(kind, path):
    """Leaves a checkpoint that is none of this training."""
    if kind == "damaged":
        return path.write_bytes(b"PK\x03\x04 half a file")
    if kind in ("architecture", "size"):
        other = {"architecture": {"width": 4}, "size": {"size": SIZE + 8}}[kind]
        with pytest.raises(Killed):
            train(killed_after(4, task("finetuned", **other)), path)
        return None
    changes = {"rate": {"rate": 0.5}, "seed": {"seed": 6}, "bare": {}}[kind]
    with pytest.raises(Killed):
        train(killed_after(4, task("finetuned")), path, **changes)
    if kind == "bare":
        state = torch.load(path, weights_only=True)
        del state["random"]
        torch.save(state, path)
    return None


@pytest.mark.slow
@pytest.mark.parametrize(
    ("kind", "word"),
    [
        ("damaged", "cannot be read"), ("architecture", "another architecture"), ("rate", "with other rate"),
        ("seed", "with other seed"), ("size", "with other images"), ("bare", "cannot be read"),
    ],
)  # fmt: skip
def test_a_checkpoint_that_does_not_belong_is_passed_over_with_a_word(tmp_path, capsys, kind, word):
    whole, path = task("finetuned"), tmp_path / "trial.pt"
    strange(kind, path)
    assert same(train(whole, path), train(whole))
    said = capsys.readouterr().err
    assert "trial.pt: ignored" in said and word in said


def test_nothing_to_resume_is_the_beginning(tmp_path):
    assert resume(tmp_path / "none.pt", {}, model=small()) == 0


def test_what_cannot_be_put_back_leaves_all_as_it_was(tmp_path, capsys):
    path, model = tmp_path / "trial.pt", small()
    optimiser = torch.optim.SGD(model.parameters(), lr=0.1, momentum=0.9)
    save(path, 3, {}, model=model, optimiser=optimiser)
    other = small()
    fewer = torch.optim.SGD(list(other.parameters())[:2], lr=0.1, momentum=0.9)
    before = {key: value.clone() for key, value in other.state_dict().items()}
    assert resume(path, {}, model=other, optimiser=fewer) == 0 and "ignored" in capsys.readouterr().err
    assert all(torch.equal(value, before[key]) for key, value in other.state_dict().items())
