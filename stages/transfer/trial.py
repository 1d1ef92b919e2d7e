"""One training: data, network, start weights, mode, split, repetition; a run that was killed repeats none of them."""

import numpy as np

from stages.kit import Stopwatch
from stages.kit.files import read_json, write_arrays, write_json
from stages.kit.repeatable import repeatable
from stages.kit.rng import rng
from stages.networks.device import choose, enough_memory
from stages.networks.images import normalise, to_images
from stages.networks.modes import MODES, mode_named
from stages.networks.network import build, parameters, settle
from stages.networks.training import accuracy, answers, learn, scores, search

from .change import parts, weight_changes
from .disturbed import FEW, PERTURBATIONS, disturb
from .plan import Trial, main_data
from .split import by_objects, by_touches, stratified_split
from .touches import read_touches

UNFINISHED = ".unfinished"  # folder of what a killed training goes on from


@enough_memory()
def process(name, folder, members, settings, seed):
    """Trains one network and tests it; writes predictions/NAME.npz, of the first repetition networks/NAME.npz too.

    members: {split: {class: its objects}}. The split, the head's first weights and the random numbers of the training
    depend on split and repetition alone, so that weights, modes and arrays are compared on the same touches. Returns
    rows: those with a `perturbation` are of disturbed test touches, those with a `layer` of one convolution's change.
    `seconds` is the whole of it: features or training, search and final training, without the test.
    """
    trial = Trial.parse(name)
    touches = read_touches(folder, members[trial.split], trial.data)
    random = rng(seed, f"transfer {trial.split} {trial.repetition}")
    split = parts_of(touches, trial, settings, random)
    first_weights, training_seed = (int(number) for number in random.integers(2**31, size=2))
    sought, checkpoint = (folder / UNFINISHED / f"{name}{end}" for end in (".json", ".pt"))
    with repeatable(training_seed):
        with Stopwatch() as watch:
            network, task = prepare(trial, touches, split.train, settings, first_weights)
            rate, validated = searched(task, touches.labels, split, trial, settings, training_seed, sought)
            training = _settings(settings, settings.epochs, training_seed)
            model = learn(task, touches.labels, split.train, rate, **training, checkpoint=checkpoint)
        found = scores(model, task, split.test)
        rows = [*changed(network, model)] if task.model is network else []
        if is_disturbed(trial, settings):
            rows += disturbed(trial, task, model, touches, split, settings, seed)
            rows += fewer(task, touches, split, rate, settings, training_seed)
    store(name, folder, model, touches.labels, split.test, found, weights=trial.repetition == 0)
    values = {
        "accuracy": accuracy(found, touches.labels[split.test]),
        "chance": 1 / len(touches.classes),
        "validation_accuracy": validated,
        "learning_rate": rate,
        "parameters": parameters(network),
        "trained_parameters": parameters(model, trained=True),
        "weight_change": float(np.mean([row["value"] for row in rows if "layer" in row] or [0.0])),
    }
    seconds = {"accuracy": watch.seconds}
    rows += [{"metric": key, "value": value, "seconds": seconds.get(key)} for key, value in values.items()]
    sought.unlink(missing_ok=True)
    return [{"trial": name} | row for row in rows]


def store(name, folder, model, labels, test, found, weights):
    """Writes predictions/NAME.npz, and networks/NAME.npz where the weights are wanted."""
    write_arrays(folder / "predictions" / f"{name}.npz", test=test, true=labels[test], scores=found.numpy())
    if weights:
        state = {key: np.ascontiguousarray(value.cpu().numpy()) for key, value in model.state_dict().items()}
        write_arrays(folder / "networks" / f"{name}.npz", **state)


def prepare(trial, touches, train, settings, seed):
    """(network, task): the network as it is before the training, and what its mode makes of it."""
    network = build(trial.network, len(touches.classes), trial.weights, seed, settings.source)
    network = network.to(choose(settings.device))
    if trial.weights == "random":
        images = to_images(touches.images, settings.size).to(choose(settings.device))
        settle(network, lambda ids: normalise(images[ids]), train)
    return network, mode_named(trial.mode)(network, touches.images, settings.size, settings.copies)


def parts_of(touches, trial, settings, random):
    """The Split of the trial's touches."""
    if trial.split == "objects":
        return by_objects(touches.labels, touches.ranks, trial.repetition, settings.validation_share, random)
    return by_touches(touches.objects, settings.train_share, settings.validation_share, random)


def searched(task, labels, split, trial, settings, seed, sought):
    """(rate, accuracy on the check): the best learning rate; what a killed training has found is not sought again."""
    if not sought.exists():
        rates = settings.frozen_rates if trial.mode == "frozen" else settings.finetuned_rates
        training = _settings(settings, settings.search_epochs, seed)
        write_json(sought, search(task, labels, split.fit, split.check, rates, **training))
    return read_json(sought)


def is_disturbed(trial, settings):
    """Whether the test touches of a trial are disturbed: of the fine array, drawn at random, and no range of layers."""
    return trial.data == main_data(settings) and trial.split == "random" and trial.mode in MODES


def disturbed(trial, task, model, touches, split, settings, seed):
    """Rows of the accuracy on disturbed test touches.

    The disturbance of a touch depends on repetition and severity alone, not on the network.
    """
    truth = touches.labels[split.test]
    for name, severities in settings.severities.items():
        for severity in severities if name in PERTURBATIONS else ():
            random = rng(seed, f"{name} {severity} {trial.repetition}")
            images = to_images(disturb(touches.images[split.test], name, severity, random), settings.size)
            found = answers(model, lambda ids, images=images: task.encode(images[ids]), range(len(truth)))
            yield _row(name, severity, accuracy(found, truth))


def fewer(task, touches, split, rate, settings, seed):
    """Rows of the accuracy after training on fewer touches of every object, at the same learning rate."""
    for share in settings.severities.get(FEW, ()):
        part, _ = stratified_split(touches.objects[split.train], share, rng(seed, f"{FEW} {share}"))
        model = learn(task, touches.labels, split.train[part], rate, **_settings(settings, settings.epochs, seed))
        yield _row(FEW, share, accuracy(scores(model, task, split.test), touches.labels[split.test]))


def changed(network, model):
    """Rows of the change of each convolution."""
    belongs = parts(network)
    for layer, value in weight_changes(network, model).items():
        yield {"layer": layer, "part": belongs[layer], "metric": "weight_change", "value": value}


def _settings(settings, epochs, seed):
    return {"epochs": epochs, "batch": settings.batch, "momentum": settings.momentum, "seed": seed}


def _row(perturbation, severity, value):
    return {"perturbation": perturbation, "severity": severity, "metric": "accuracy", "value": value}
