"""Which choices go on, by Pareto rank; a study goes on where it stopped and refuses what another version has found."""

import numpy as np
import pytest

from haptic_glance.base.rng import rng
from stages.front.known import halves

optuna = pytest.importorskip("optuna", reason="pip install 'haptic-glance[front]'")
from stages.front import search as module  # noqa: E402
from stages.front.search import DIRECTIONS, OutOfTime, Search, aims, best_share, crowding, losses, ranks, smallest_of  # noqa: E402
from stages.front.space import DEFAULT, choice_of  # noqa: E402

MADE_OF = {"code": "1234", "meshes": "abcd"}
SEARCHED, UNSEEN = halves([f"shape{k}" for k in range(12)], {"a": ["x"], "b": ["y"]}, 0)


def answers(regions, objects, seconds=1.0, faces=100.0):
    common = {"seconds": seconds, "faces": faces, "touches": 1, "item": "x"}
    return [{"split": "regions", "value": regions, **common}, {"split": "objects", "value": objects, **common}]


def dominates(first, second):
    return bool((first <= second).all() and (first < second).any())


def test_a_dominated_choice_is_never_on_the_front_and_each_rank_is_dominated_by_the_one_before():
    points = np.random.default_rng(0).integers(0, 4, size=(60, 3))  # with many ties
    rank = ranks(points)
    beaten = np.array([any(dominates(second, point) for second in points) for point in points])
    assert ((rank == 0) == ~beaten).all() and rank.max() > 1
    for k in range(1, rank.max() + 1):
        assert all(any(dominates(point, second) for point in points[rank == k - 1]) for second in points[rank == k])


def test_the_ends_of_an_aim_stand_apart_and_a_crowd_does_not():
    apart = crowding([[0, 4], [1, 3], [1.1, 2.9], [4, 0]])
    assert np.isinf(apart[[0, 3]]).all() and apart[1] == pytest.approx(1.1 / 4 + 1.1 / 4)
    assert (crowding(np.ones((3, 2))) == 0).all()


def test_a_third_goes_on_the_better_rank_first_and_a_crowded_one_before_a_lonely_one_behind():
    front = [[0, 2], [2, 0]]
    assert best_share([[3, 3], *front, [4, 4], [5, 5], [2.5, 2.5]]).tolist() == [1, 2]
    assert best_share([[1, 1]]).tolist() == [0]
    front, behind = [[0, 4], [2, 2], [4, 0]], [[1, 9], [9, 1]]
    assert best_share([*behind, *front, [10, 10], [11, 11], [12, 12], [13, 13]]).tolist() == [2, 3, 4]


def test_aims_are_means_over_the_objects_and_what_could_not_be_asked_is_no_good():
    assert aims([*answers(0.5, 0.25), *answers(0.7, None, seconds=None)]) == pytest.approx([0.6, 0.25, 1.0, 100.0, 1.0])
    assert aims(answers(None, 0.5))[0] == 0
    assert losses([answers(0.5, 0.25)]).tolist() == [[-0.5, -0.25, 1, 100, 1]] and len(DIRECTIONS) == 5


def test_the_smallest_is_the_quickest_within_two_points_of_the_best():
    choices = {"best": answers(0.8, 0.6, 9), "near": answers(0.79, 0.58, 2), "slow": answers(0.8, 0.59, 3)}
    assert smallest_of(choices | {"far": answers(0.7, 0.6, 1)}) == "near"
    assert smallest_of({"b": answers(0.5, 0.5, faces=9), "a": answers(0.5, 0.5, faces=10)}) == "b"


@pytest.fixture
def asked(monkeypatch):
    """What `known` was asked, [(objects, choice)]; its answers follow from the choice alone, like its seconds."""
    calls = []

    def known(senses, objects, choice, effort, seed):
        calls.append((objects, choice))
        random = rng(7, choice.name)
        base = choice.columns | {"seconds": float(random.random()), "faces": 100.0, "item": "x"}
        return [base | {"split": split, "value": float(random.random())} for split in ("regions", "objects")]

    monkeypatch.setattr(module, "known", known)
    return calls


def search(folder, made_of=MADE_OF, seed=0, minutes=60.0):
    return Search(folder, made_of, None, seed, minutes)


def run(folder, trials=30, **options):
    return search(folder, **options).run(SEARCHED, UNSEEN, trials)


def of_rung(rows, rung):
    return [row for row in rows if row["rung"] == rung]


@pytest.mark.slow
def test_a_study_that_was_stopped_goes_on_like_one_that_was_not_and_the_seed_decides(asked, tmp_path, monkeypatch):
    whole = run(tmp_path / "whole")
    count = len(asked)
    known = module.known

    def killed(*args):
        if len(asked) == count + 13:
            raise KeyboardInterrupt
        return known(*args)

    monkeypatch.setattr(module, "known", killed)
    with pytest.raises(KeyboardInterrupt):
        run(tmp_path / "stopped")
    monkeypatch.setattr(module, "known", known)
    assert run(tmp_path / "stopped") == whole
    assert len(asked) == 2 * count  # nothing was asked twice
    assert run(tmp_path / "stopped") == whole and len(asked) == 2 * count
    assert run(tmp_path / "other", seed=1) != whole


def test_minutes_that_are_over_stop_it(asked, tmp_path):
    with pytest.raises(OutOfTime):
        run(tmp_path, minutes=0)
    assert asked == []


def test_more_trials_go_on_from_fewer(asked, tmp_path):
    run(tmp_path / "few", trials=3)
    few = {choice for objects, choice in asked if objects is SEARCHED}
    rows = run(tmp_path / "few", trials=9)
    assert rows == run(tmp_path / "whole", trials=9) and few < {choice for _, choice in asked}
    for key, value in {"code": "5678", "meshes": "efgh"}.items():
        reason = rf"{key} {MADE_OF[key]}, now {value}\).*remove that folder to search anew"
        with pytest.raises(ValueError, match=reason):
            search(tmp_path / "few", MADE_OF | {key: value})


@pytest.mark.slow
def test_a_third_goes_on_and_of_the_last_the_front_is_confirmed_on_unseen_objects_alone(asked, tmp_path):
    rows = run(tmp_path)
    counts = [len({row["number"] for row in of_rung(rows, rung)}) for rung in ("wide", "narrow", "last")]
    assert counts[1] == counts[0] // 3 and counts[2] == counts[1] // 3
    last = {row["number"]: aims([entry for entry in of_rung(rows, "last") if entry["number"] == row["number"]])
            for row in of_rung(rows, "last")}  # fmt: skip
    front = np.array(list(last))[ranks(np.array(list(last.values())) * [-1, -1, 1, 1, 1]) == 0]
    confirmed = {row["number"]: row["role"] for row in of_rung(rows, "confirmation")}
    assert set(confirmed) == {*front.tolist(), *(number for number, role in confirmed.items() if role)}
    assert sorted(filter(None, confirmed.values())) == ["default", "smallest"]
    on_unseen = [choice for objects, choice in asked if objects is UNSEEN]
    numbers = {*confirmed, *(row["number"] for row in of_rung(rows, "one_choice"))}
    assert len(on_unseen) == len(set(on_unseen)) == len(numbers)
    assert all(objects in (SEARCHED, UNSEEN) for objects, _ in asked) and DEFAULT in on_unseen


def test_where_one_choice_beats_all_it_alone_is_confirmed_beside_the_default(tmp_path, monkeypatch):
    def known(senses, objects, choice, effort, seed):
        value = float(rng(7, choice.name).random())
        return answers(value, value, seconds=1 - value)

    monkeypatch.setattr(module, "known", known)
    rows = run(tmp_path)
    best = max(of_rung(rows, "last"), key=lambda row: row["value"])["number"]
    assert {row["number"]: row["role"] for row in of_rung(rows, "confirmation")}.get(best) == "smallest"
    assert len(of_rung(rows, "confirmation")) == 2 * 2


def test_a_trial_that_a_killed_run_left_is_answered(asked, tmp_path):
    begun = search(tmp_path)
    options = {name: optuna.distributions.CategoricalDistribution(values) for name, values in module.SPACE.items()}
    choice = choice_of(begun.study.ask(fixed_distributions=options).params)
    begun.study.ask()  # before it was proposed
    run(tmp_path, trials=4)
    states = [trial.state.name for trial in search(tmp_path).study.trials]
    assert states == ["COMPLETE", "FAIL", "COMPLETE", "COMPLETE"] and asked[0][1] == choice
