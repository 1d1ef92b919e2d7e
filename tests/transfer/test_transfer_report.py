"""The gains and the claims of chapter 5, on trainings whose truth is known."""

import numpy as np
import pandas as pd
import pytest

from haptic_glance.know.split import shared_by
from stages.recorded_networks import report as recorded_topic
from stages.report.parts import build_item
from stages.transfer import network_rows as _transfer
from stages.transfer import report as transfer
from tests.frames import has_ink

FINE, COARSE = "imprints128", "imprints16"
LEVELS = {  # (data, weights, mode) -> accuracy
    (FINE, "imagenet", "finetuned"): 0.8,
    (FINE, "imagenet", "frozen"): 0.5,
    (FINE, "imagenet", "18:139"): 0.8,
    (FINE, "imagenet", "1:134"): 0.7,
    (FINE, "random", "finetuned"): 0.4,
    (FINE, "random", "frozen"): 0.3,
    (COARSE, "imagenet", "finetuned"): 0.6,
    (COARSE, "imagenet", "frozen"): 0.2,
}
LAYERS = {"conv1": "Conv1", "b2": "block_2", "b9": "block_9", "b15": "block_15", "last": "Conv_1"}


def rows(dataset="furniture", turned=False, **levels):
    """Five trainings of each setting. levels: others for modes; turned: what was better by a margin is worse by it."""
    random, entries = np.random.default_rng(0), []
    common = {"dataset": dataset, "method": "mobilenet_v2", "size": 80, "touches": 20, "seed": 0, "passes": "printed"}
    for (data, weights, mode), level in LEVELS.items():
        level = levels.get(mode, level)
        for split in ("random", "objects"):
            for number in range(5):
                setting = common | {"data": data, "weights": weights, "mode": mode, "split": split}
                setting |= {"repetition": number, "pretrained": "complete", "seconds": 10.0}
                value = (1 - level if turned else level) + 0.002 * random.normal()
                values = {"accuracy": value, "chance": 1 / 6, "train_accuracy": 1.0}
                entries += [setting | {"metric": metric, "value": value} for metric, value in values.items()]
    changed = common | {"data": FINE, "weights": "imagenet", "mode": "finetuned", "split": "random"}
    changed["pretrained"] = "complete"
    for number in range(5):
        about = changed | {"repetition": number}
        for depth, (layer, part) in enumerate(LAYERS.items()):
            change = {"layer": layer, "part": part, "value": 0.1 ** (4 - depth if turned else depth)}
            entries.append(about | {"metric": "layer_weight_change"} | change)
        entries.append(about | {"metric": "weight_change", "value": 0.01 * (number + 1)})
    return pd.DataFrame(entries).assign(note=None)


def converged(dataset="furniture", repetitions=3):
    """Trainings until nothing improves, at random: fine-tuning ends at 95 %, having learned all; frozen at 70 %."""
    entries = []
    for mode, mean in (("finetuned", 0.95), ("frozen", 0.7)):
        for number in range(repetitions):
            about = {"data": FINE, "method": "mobilenet_v2", "weights": "imagenet", "mode": mode}
            about |= {"dataset": dataset, "split": "random", "repetition": number, "pretrained": "complete"}
            values = {"accuracy": mean + 0.01 * number, "train_accuracy": mean + 0.04, "epochs": 30 + number}
            entries += [about | {"metric": key, "value": value, "seconds": 9.0} for key, value in values.items()]
    return pd.DataFrame(entries).assign(size=80, touches=20, seed=0, note=None, passes="converged")


@pytest.fixture(scope="module")
def run(measure):
    """Results of a run that has trained MobileNetV2, by the printed passes and until nothing improves."""
    return measure("transfer", pd.concat([rows(), converged()]))


def test_tables_compare_all_trainings_on_the_splits_of_the_printed_ones():
    def shown(*frames):
        return set(_transfer.of_passes(pd.concat(frames), *_transfer.PASSES)["repetition"])

    more, printed = converged(repetitions=8), rows()
    is_tuned = printed["mode"] == "finetuned"
    assert shown(printed, more) == {*range(5)} and shown(more) == {*range(8)}
    assert shown(printed[~is_tuned | (printed["repetition"] < 3)], more) == {*range(3)}
    assert shown(printed[~is_tuned], more) == {*range(5)}
    assert shown(printed, more.assign(dataset="other")) == shown(more)
    assert shown(printed, more.assign(mode=None)) == shown(more)


@pytest.mark.slow
def test_the_gains_of_one_set_alone_are_drawn(run):
    assert has_ink(build_item(transfer, "figures", "figure_5_3", run))


def test_one_object_of_five_says_more_than_one_of_three():
    assert _transfer.shared("objects") == 1 / 2 and _transfer.shared("objects", "princeton_six") == 1 / 4
    assert _transfer.shared("random", "princeton_six") == shared_by("random")
    frames = (rows(source) for source in ("furniture", "princeton_six"))
    parts = (frame[(frame["metric"] == "accuracy") & (frame["mode"] == "1:134")] for frame in frames)
    width = [cell["high"] - cell["low"] for cell in (_transfer.accuracy(frame, "objects") for frame in parts)]
    assert width[1] / width[0] == pytest.approx(np.sqrt((1 + 5 / 4) / (1 + 5 / 2)))


@pytest.mark.slow
def test_the_smallest_network_that_is_enough_is_named(measure):
    entries = [
        {"data": "pressure", "item": None, "method": name, "weights": "imagenet", "mode": "frozen", "split": "blocks"}
        | {"pretrained": "complete", "size": 96, "repetition": k, "metric": "accuracy", "value": level + 0.001 * k}
        for name, level in (("mobilenet_v2", 0.9), ("vgg16", 0.91), ("alexnet", 0.7)) for k in range(3)
    ]  # fmt: skip
    sizes = {"mobilenet_v2": 2e6, "vgg16": 15e6, "alexnet": 1e6}
    costs = [
        {"network": n, "size": 96, "parameters": s, "operations": s, "milliseconds": 1.0} for n, s in sizes.items()
    ]
    results = measure("recorded_networks", pd.DataFrame(entries), "pressure_images")
    results = measure("bench/networks", pd.DataFrame(costs), results=results)
    made = build_item(recorded_topic, "tradeoff", "network_sizes", results)
    assert "points of the best is MobileNetV2." in made.caption
