"""New objects learned on the device from a few touches: a new head alone, on features that stay as they are (T6.3)."""

from collections import defaultdict
from collections.abc import Callable, Iterator, Mapping, Sequence

import numpy as np
from sklearn.linear_model import LogisticRegression
from sklearn.neighbors import KNeighborsClassifier
from sklearn.pipeline import Pipeline, make_pipeline
from sklearn.preprocessing import StandardScaler
from threadpoolctl import threadpool_limits

from haptic_glance.base.timing import Stopwatch
from haptic_glance.deep.device import device_of
from haptic_glance.deep.hybrid import SENSES, HybridNet
from haptic_glance.deep.images import normalise
from haptic_glance.deep.network import Network

from .hybrid_data import SenseData, in_batches, single_sense

TOUCH = SENSES.index("touch")
DRAWS = 20  # random choices of the touches that are learned
LEARNERS: dict[str, Callable[[], object]] = {
    # The softmax head of a network, to its one optimum: there is no learning rate that few touches could not choose.
    "head": lambda: LogisticRegression(max_iter=1000),
    "nearest": lambda: KNeighborsClassifier(n_neighbors=1),
}
METRIC = "new_object_accuracy"


def new_object_rows(
    hybrid: HybridNet,
    imagenet: Network,
    sense: SenseData,
    names: Mapping[int, str],
    counts: Sequence[int],
    random: np.random.Generator,
) -> Iterator[dict]:
    """Rows of how well each object of the test part is told from the others after `counts` touches of each.

    hybrid: a network that never met these objects; imagenet: a MobileNetV2 as it came from ImageNet, the control;
    sense: the touches; names: {number of an object: its name}. Methods are NETWORK_LEARNER, such as hybrid_head. The
    touches beyond the highest count are asked about, for every count the same. `value` is the mean over DRAWS,
    `seconds` what one learning takes for each object: the features of its touches, and its share of the fit.
    """
    images, objects = sense.images[sense.test], sense.objects[sense.test]
    sources = {
        "hybrid": lambda part: hybrid.features(single_sense(part, TOUCH), TOUCH),
        "imagenet": lambda part: imagenet.features(normalise(part)),
    }
    numbers, draws = np.unique(objects), [random.permutation(len(objects)) for _ in range(DRAWS)]
    for source, function in sources.items():
        with Stopwatch() as watch:
            features = in_batches(function, images, device_of(hybrid))
        for learner, count in ((name, count) for name in LEARNERS for count in counts):
            with threadpool_limits(1):  # as torch is limited here: one core, and equal sums everywhere
                shares, seconds = scores(learner, features, objects, draws, count, max(counts))
            seconds_spent = watch.seconds / len(objects) * count + seconds / len(numbers)
            keys = {"method": f"{source}_{learner}", "sense": "touch", "perturbation": "new_object", "severity": count}
            for number in numbers:
                yield keys | {
                    "item": names[int(number)],
                    "metric": METRIC,
                    "value": shares[int(number)],
                    "seconds": seconds_spent,
                }
    keys = {"method": "chance", "sense": "touch", "perturbation": "new_object"}
    yield keys | {"metric": METRIC, "value": 1 / len(numbers)}


def scores(
    learner: str, features: np.ndarray, objects: np.ndarray, draws: Sequence[np.ndarray], count: int, most: int
) -> tuple[dict[int, float], float]:
    """({object: share of its touches that are recognised}, seconds of a fit), means over draws of `count` touches.

    features (k, width) of touches of objects (k,); draws: orders (k,) of the touches, of which the first `count` of
    each object are learned, and those behind the first `most` are asked about.
    """
    hits, spent = defaultdict(list), []
    for order in draws:
        by_object = [order[objects[order] == number] for number in np.unique(objects)]
        learned = np.concatenate([ids[:count] for ids in by_object])
        model: Pipeline = make_pipeline(StandardScaler(), LEARNERS[learner]())
        with Stopwatch() as watch:
            model.fit(features[learned], objects[learned])
        spent.append(watch.seconds)
        for ids in by_object:
            test = ids[most:]
            hits[int(objects[ids[0]])].append(float((model.predict(features[test]) == objects[test]).mean()))
    return {number: float(np.mean(shares)) for number, shares in hits.items()}, float(np.mean(spent))
