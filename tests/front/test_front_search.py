"""A study goes on where it stopped, is the same by its seed, and refuses what another version has found."""

import numpy as np
import pytest

from haptic_glance.base.rng import rng
from stages.front.known import halves
from stages.front.search import ranks

optuna = pytest.importorskip("optuna", reason="pip install 'haptic-glance[front]'")
from stages.front import search as module  # noqa: E402
from stages.front.search import OutOfTime, Search  # noqa: E402
from stages.front.space import DEFAULT, choice_of  # noqa: E402

MADE_OF = {"code": "1234", "meshes": "abcd"}
SEARCHED, UNSEEN = halves([f"shape{k}" for k in range(12)], {"a": ["x"], "b": ["y"]}, 0)
TRIALS = 30


@pytest.fixture
def asked(monkeypatch):
    """What `known` was asked, [(objects, choice)]; its answers follow from the choice alone, like its seconds."""
    calls = []

    def known(senses, objects, choice, effort, seed):
        calls.append((objects, choice))
        random = rng(7, choice.name)
        base = choice.columns | {"seconds": float(random.random()), "faces": 100.0}
        return [
            base | {"split": split, "value": float(random.random()), "item": "x"} for split in ("regions", "objects")
        ]

    monkeypatch.setattr(module, "known", known)
    return calls


def search(folder, made_of=MADE_OF, seed=0, minutes=60.0):
    return Search(folder, made_of, None, seed, minutes)


def run(folder, trials=TRIALS, **options):
    return search(folder, **options).run(SEARCHED, UNSEEN, trials)


def of_rung(rows, rung):
    return [row for row in rows if row["rung"] == rung]


def test_a_study_that_was_stopped_goes_on_like_one_that_was_not(asked, tmp_path, monkeypatch):
    whole = run(tmp_path / "whole")
    count = len(asked)
    known = module.known

    def killed(*given):
        if len(asked) == count + 13:
            raise KeyboardInterrupt
        return known(*given)

    monkeypatch.setattr(module, "known", killed)
    with pytest.raises(KeyboardInterrupt):
        run(tmp_path / "stopped")
    monkeypatch.setattr(module, "known", known)
    assert run(tmp_path / "stopped") == whole
    assert len(asked) == 2 * count  # nothing was asked twice
    assert run(tmp_path / "stopped") == whole and len(asked) == 2 * count


def test_the_same_seed_proposes_the_same_choices(asked, tmp_path):
    first, again, other = (run(tmp_path / str(k), seed=seed) for k, seed in enumerate((0, 0, 1)))
    assert first == again != other


def test_minutes_that_are_over_stop_it(asked, tmp_path):
    with pytest.raises(OutOfTime):
        run(tmp_path, minutes=0)
    assert asked == []


def test_more_trials_go_on_from_fewer(asked, tmp_path):
    run(tmp_path, trials=6)
    few = {choice for objects, choice in asked if objects is SEARCHED}
    rows = run(tmp_path)
    assert rows == run(tmp_path / "whole") and few < {choice for _, choice in asked}


@pytest.mark.parametrize("change", [{"code": "5678"}, {"meshes": "efgh"}])
def test_a_study_of_another_version_is_refused_with_the_remedy(asked, tmp_path, change):
    run(tmp_path, trials=3)
    ((key, value),) = change.items()
    with pytest.raises(ValueError, match=rf"{key} {MADE_OF[key]}, now {value}\).*remove that folder to search anew"):
        search(tmp_path, MADE_OF | change)


def test_what_is_confirmed_is_asked_of_unseen_objects_alone(asked, tmp_path):
    rows = run(tmp_path)
    confirmed = {row["number"] for row in [*of_rung(rows, "confirmation"), *of_rung(rows, "one_choice")]}
    on_unseen = [choice for objects, choice in asked if objects is UNSEEN]
    assert len(on_unseen) == len(set(on_unseen)) == len(confirmed)
    assert all(objects in (SEARCHED, UNSEEN) for objects, _ in asked) and DEFAULT in on_unseen


def test_a_dominated_choice_is_not_confirmed_and_a_third_goes_on(asked, tmp_path):
    rows = run(tmp_path)
    counts = [len({row["number"] for row in of_rung(rows, rung)}) for rung in ("wide", "narrow", "last")]
    assert counts[1] == counts[0] // 3 and counts[2] == counts[1] // 3
    last = {row["number"]: module.aims([one for one in of_rung(rows, "last") if one["number"] == row["number"]])
            for row in of_rung(rows, "last")}  # fmt: skip
    front = np.array(list(last))[ranks(np.array(list(last.values())) * [-1, -1, 1, 1, 1]) == 0]
    confirmed = {row["number"]: row["role"] for row in of_rung(rows, "confirmation")}
    allowed = {*front.tolist(), *(number for number, role in confirmed.items() if role)}
    assert set(confirmed) == allowed and sorted(filter(None, confirmed.values())) == ["default", "smallest"]


def test_where_one_choice_beats_all_it_alone_is_confirmed_beside_the_default(asked, tmp_path, monkeypatch):
    def known(senses, objects, choice, effort, seed):
        value = float(rng(7, choice.name).random())
        base = {"seconds": 1 - value, "faces": 1.0, "touches": 1, "value": value, "item": "x"}
        return [base | {"split": split} for split in ("regions", "objects")]

    monkeypatch.setattr(module, "known", known)
    rows = run(tmp_path)
    best = max(of_rung(rows, "last"), key=lambda row: row["value"])["number"]
    assert {row["number"]: row["role"] for row in of_rung(rows, "confirmation")}.get(best) == "smallest"
    assert len(of_rung(rows, "confirmation")) == 2 * 2


def test_a_trial_that_a_killed_run_left_is_answered(asked, tmp_path):
    begun = search(tmp_path)
    options = {name: optuna.distributions.CategoricalDistribution(every) for name, every in module.SPACE.items()}
    choice = choice_of(begun.study.ask(fixed_distributions=options).params)
    begun.study.ask()  # before it was proposed
    run(tmp_path, trials=4)
    states = [trial.state.name for trial in search(tmp_path).study.trials]
    assert states == ["COMPLETE", "FAIL", "COMPLETE", "COMPLETE"] and asked[0][1] == choice
