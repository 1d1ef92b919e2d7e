"""Named statistics of claims, on rows whose answer is known."""

import pandas as pd
import pytest

from stages.engine.measurements import Missing
from stages.report.claims import Claim
from stages.report.effects import differences


def claim(statistic, stage="test", **fields):
    common = {"key": "one", "section": "T9", "sentence": "Sentence.", "sets": ("test",), "where": {}, "first": {}}
    return Claim(**common | {"over": ("item",), "scale": 1.0} | fields, stage=stage, statistic=statistic)


def rows(columns, *values):
    return pd.DataFrame(values, columns=columns.split()).assign(dataset="test", metric="m")


@pytest.fixture
def errors(measured):
    """Errors of five methods on two objects at two targets: `far` is 10 % above `base`, and 20 % at few faces."""
    levels = {"base": 1.0, "far": 1.1, "near": 1.01, "low": 0.9, "high": 1.3}
    table = rows("item target method value faces points", *(
        (item, target, name, level * scale * (1.2 / 1.1 if (name, target) == ("far", "1500") else 1), int(target), k)
        for item, scale in (("a", 1.0), ("b", 2.0)) for target in ("1500", "3000")
        for k, (name, level) in enumerate(levels.items())))  # fmt: skip
    return measured("lines", table)


def test_the_method_with_the_largest_gap_either_way_or_below_decides(errors):
    sides = {"first": {"method": ("far", "low")}, "second": {"method": "base"}, "where": {"metric": "m"}}
    gap = (0.1 / 1.05 + 0.2 / 1.1) / 2
    found = differences(errors, claim("room", "lines", **sides))
    assert found.tolist() == pytest.approx([-gap] * 2)  # the largest difference, with a minus
    assert differences(errors, claim("fall", "lines", **sides)).tolist() == pytest.approx([-0.1 / 0.95] * 2)
    alone = {**sides, "first": {"method": ("absent",)}}
    with pytest.raises(Missing, match="did not run base beside another"):
        differences(errors, claim("room", "lines", **alone))


def test_spread_and_fall_of_errors_are_between_few_and_many_faces(errors):
    contrast = ({"target": "1500"}, {"target": "3000"})
    gaps = differences(errors, claim("spread", "lines", first={"method": ("base", "far")}, contrast=contrast))
    assert gaps.tolist() == pytest.approx([0.1 / 2**0.5, 0.2 / 2**0.5])
    falls = differences(errors, claim("falls_with_faces", "lines", first={"method": "far"}))
    assert falls.tolist() == pytest.approx([0.1, 0.2])


def test_ranks_of_points_and_errors_are_correlated_by_object(errors):
    found = differences(errors, claim("ranks_agree", "lines", first={"metric": "m"}))
    assert found.tolist() == pytest.approx([0.3, 0.3])  # ranks 2 4 3 1 5 of the errors, 1 2 3 4 5 of the points


def test_a_side_is_lower_by_the_quantile_of_both(measured):
    table = rows("item view method value", *(("a", str(k), name, k + shift) for k in range(4)
                                             for name, shift in (("x", 0), ("y", 2))))  # fmt: skip
    sides = {"first": {"method": "x"}, "second": {"method": "y"}, "within": ("view",)}
    found = measured("test", table)
    assert differences(found, claim("median_below", **sides)).tolist() == [0.5]  # 2.5: three of four, one of four
    assert differences(found, claim("upper_quartile_below", **sides)).tolist() == [0.5]


def test_weights_are_held_against_the_next_channel_as_pseudo_values(measured):
    weights = {"entropy": (0.5, 0.4, 0.6), "colour": (0.1, 0.1, 0.1), "rest": (0.3, 0.3, 0.3)}
    table = rows("channel item value", *((name, item, value) for name, values in weights.items()
                                         for item, value in zip((None, "a", "b"), values, strict=True)))  # fmt: skip
    found = measured("weights", table)
    largest = differences(found, claim("largest_weight", "weights", first={"channel": "entropy"}))
    assert largest.tolist() == pytest.approx([0.6 - 0.3, 0.4 - 0.3])  # 2 * 0.5 - 0.4, and 2 * 0.5 - 0.6
    least = differences(found, claim("least_weight", "weights", first={"channel": "colour"}))
    assert least.tolist() == pytest.approx([0.2, 0.2])


def test_gains_are_shares_of_objects_whose_shape_orders_them(measured):
    gains = rows("item channel value", *((f"o{k}", name, value) for k in range(6)
                                         for name, value in (("symmetry", 1.0 + k), ("rest", 10.0))))  # fmt: skip
    shape = rows("item channel value", *((f"o{k}", None, float(k)) for k in range(6))).assign(metric="extremes")
    found = measured("weights", pd.concat([gains, shape]))
    sides = {"first": {"channel": "symmetry", "metric": "m"}, "second": {"metric": "extremes"}}
    assert differences(found, claim("share_rises_with", "weights", **sides)).mean() == pytest.approx(1)
    assert differences(found, claim("differs_with", "weights", **sides | {"first": {"metric": "m"}})).mean() > 0.9
    varies = claim("varies_more", "weights", where={"metric": "m"}, first={"channel": "symmetry"})
    assert differences(found, varies).mean() == pytest.approx(3 / 7)  # mean of |k - 2.5| is 1.5, of a mean of 3.5


def test_like_imprints_go_with_errors_and_late_layers_with_small_changes(measured):
    likeness = rows("set method value", *((s, name, float(k)) for s in "ab" for k, name in enumerate("xyz")))
    table = pd.concat([likeness, likeness.assign(metric="accuracy", value=-likeness["value"])])
    sides = {"first": {"metric": "m"}, "second": {"metric": "accuracy"}, "over": ("set",)}
    assert differences(measured("test", table), claim("unlike_more_accurate", **sides)).tolist() == [1, 1]
    changes = measured("test", rows("repetition value", (0, 3.0), (0, 2.0), (0, 1.0)))
    later = claim("later_convolutions_change_less", over=("repetition",))
    assert differences(changes, later).tolist() == [1]


def test_sequences_count_whole_and_classes_that_feel_alike_by_their_pair(measured):
    whole = rows("repetition frames cells classifier value", (0, 5, 8, "a", 0.2), (0, 9, 8, "a", 0.7),
                 (0, 9, 8, "b", 0.4))  # fmt: skip
    sides = {"first": {"classifier": "a"}, "second": {"classifier": "b"}, "over": ("repetition",)}
    assert differences(measured("sequences", whole), claim("whole_sequences", **sides, stage="sequences",
                                                           checked=False)).tolist() == pytest.approx([0.3])  # fmt: skip
    pairs = [("bird", "bird", 6), ("bird", "airplane", 4), ("airplane", "airplane", 10), ("bust", "bust", 10),
             ("vase", "vase", 10)]  # fmt: skip
    confused = measured("confused", rows("classifier group predicted value", *(("knn", *pair) for pair in pairs)))
    found = differences(confused, claim("alike_confused", "confused", over=("classifier",)))
    assert found.tolist() == pytest.approx([0.1])  # 4 of 20 and 0 of 20, others are not confused
