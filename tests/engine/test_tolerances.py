"""Tolerances: what may move passes, what may not is named, and a wrong rule is named, too."""

import pytest

from stages.engine.tolerances import DIGITS, Rule, Tolerances, compare, read_tolerances, widest_moves

BASELINE = {"touch.ours.accuracy": 0.70, "touch.blind.accuracy": 0.60, "lod.error": 0.001, "lod.meshes": 12}


def tolerances(*rules: Rule, **pairs: tuple[str, str]) -> Tolerances:
    return Tolerances(list(rules), pairs)


def test_a_metric_without_a_rule_is_held_exactly():
    assert compare(BASELINE, BASELINE, tolerances()) == []
    (line,) = compare({**BASELINE, "lod.meshes": 11}, BASELINE, tolerances())
    assert line == "lod.meshes moved by -1 from 12 to 11, outside 12 .. 12"


@pytest.mark.parametrize(
    ("rule", "low", "high"),
    [
        (Rule("*", abs=0.1), 0.4, 0.6),
        (Rule("*", rel=0.1), 0.45, 0.55),
        (Rule("*", abs=0.1, rel=0.1), 0.4, 0.6),  # the wider of both
        (Rule("*", rel=0.1, direction="more"), 0.45, float("inf")),
        (Rule("*", rel=0.1, direction="less"), float("-inf"), 0.55),
        (Rule("*", free=True), float("-inf"), float("inf")),
    ],
)
def test_the_bounds_of_a_rule(rule, low, high):
    assert rule.bounds(0.5) == pytest.approx((low, high))
    assert Rule("*", rel=0.1).bounds(-0.5) == pytest.approx((-0.55, -0.45))


def test_the_first_rule_that_fits_holds():
    rules = tolerances(Rule("lod.*", rel=0.5), Rule("*", free=True))
    assert compare({**BASELINE, "lod.error": 0.0014, "touch.ours.accuracy": 0}, BASELINE, rules) == []
    assert len(compare({**BASELINE, "lod.error": 0.0016}, BASELINE, rules)) == 1


def test_a_missing_metric_and_one_that_is_no_number_never_pass():
    free = tolerances(Rule("*", free=True))
    assert compare({"lod.meshes": 12}, {"lod.meshes": 12, "lod.error": 0.001}, free) == [
        "lod.error is missing (baseline 0.001)"
    ]
    assert len(compare({"lod.error": float("nan")}, {"lod.error": 0.001}, free)) == 1


def test_a_pair_is_held_where_both_of_its_metrics_may_move():
    rules = tolerances(
        Rule("touch.*", abs=0.2), Rule("pairs.lead", abs=0.05, direction="more"),
        lead=("touch.ours.accuracy", "touch.blind.accuracy"),
    )  # fmt: skip
    shifted = {**BASELINE, "touch.ours.accuracy": 0.55, "touch.blind.accuracy": 0.45}
    assert compare(shifted, BASELINE, rules) == []
    swapped = {**BASELINE, "touch.ours.accuracy": 0.60, "touch.blind.accuracy": 0.70}
    (line,) = compare(swapped, BASELINE, rules)
    assert line.startswith("pairs.lead moved by -0.2 from 0.1 to -0.1")


def test_a_pair_with_a_star_is_held_for_each_text_that_fits():
    rules = tolerances(lead=("*.ours.accuracy", "*.blind.accuracy"))
    metrics = rules.with_pairs(
        {**BASELINE, "look.ours.accuracy": 0.5, "look.blind.accuracy": 0.1, "odd.ours.accuracy": 1}
    )
    added = {name: value for name, value in metrics.items() if name.startswith("pairs")}
    assert added == {"pairs.lead.touch": pytest.approx(0.1), "pairs.lead.look": pytest.approx(0.4)}


def test_the_widest_move_of_each_metric_is_allowed():
    runs = [{**BASELINE, "lod.error": 0.0011}, {**BASELINE, "lod.error": 0.00079996, "lod.meshes": 13.004}]
    moves = widest_moves(runs, BASELINE)
    assert moves == {"lod.error": pytest.approx(0.0002, rel=0.01), "lod.meshes": pytest.approx(1, rel=0.015)}
    assert widest_moves([{**BASELINE, "lod.meshes": 12 + 6 * DIGITS}], BASELINE) == {}  # of the digits that are kept
    rules = Tolerances([], {}, moves)
    assert all(compare(run, BASELINE, rules) == [] for run in runs)
    assert len(compare({**BASELINE, "lod.error": 0.00121, "touch.ours.accuracy": 0.5}, BASELINE, rules)) == 2


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("rules: [", "is not YAML"),
        ("- a", "must have `rules`"),
        ("rules: [{abs: 1}]", "a rule has metric"),
        ("rules: [{metric: a, abs: -1}]", "at least 0"),
        ("rules: [{metric: a, direction: up}]", "direction is one of"),
        ("pairs: {lead: [a]}", "must list two metrics"),
        ("pairs: {lead: ['*.a', b]}", "must list two metrics"),
    ],
)
def test_a_wrong_file_is_named_with_what_is_wrong(tmp_path, text, message):
    path = tmp_path / "tolerances.yaml"
    path.write_text(text)
    with pytest.raises(ValueError, match=message) as error:
        read_tolerances(path)
    assert str(path) in str(error.value)


@pytest.mark.parametrize(
    ("rules", "message"),
    [
        (tolerances(Rule("lod.eror")), "for lod.eror, but no metric is called so, did you mean lod.error?"),
        (tolerances(lead=("touch.ours.accuracy", "touch.random.accuracy")), "did you mean touch.blind.accuracy?"),
        (tolerances(Rule("pairs.lead")), "for pairs.lead"),
    ],
)
def test_a_rule_for_no_metric_is_named_with_the_nearest(rules, message):
    with pytest.raises(ValueError) as error:
        rules.check(BASELINE)
    assert message in str(error.value)
