"""The hybrid network beside the two it was made of: accuracy, equality, size, calibration, and as ONNX (T5.5)."""

import numpy as np

from stages.kit.files import write_arrays
from stages.networks.device import device_of
from stages.networks.images import normalise
from stages.networks.network import parameters

from . import fusion
from .hybrid import SENSES
from .hybrid_file import load, save, state_arrays
from .hybrid_scores import in_parts, lone, row, scored
from .onnx_export import export_onnx, onnx_scores
from .smaller import KINDS


def compared(hybrid, networks, senses, seconds, name, folder, classes):
    """Rows of the two networks, of the hybrid and of its smaller kinds: accuracy, equality, size, calibration."""
    paths = folder / "hybrid" / "networks"
    tested = {}
    for kind, (sense, network) in enumerate(zip(senses, networks, strict=True)):
        own = in_parts(lambda part, n=network: n(normalise(part)), sense.images[sense.test], device_of(network))
        tested[kind] = scored(hybrid, sense.images[sense.test], kind)
        write_arrays(paths / f"{name}.{kind}.npz", **state_arrays(network))
        yield row(SENSES[kind], "accuracy", fusion.accuracy(own, sense.labels[sense.test]), kind, seconds[kind])
        yield row("hybrid", "max_difference", float(np.nanmax(np.abs(own - tested[kind]))), kind)
        yield from calibrated(tested[kind], sense.labels[sense.test], kind, float(hybrid.temperature[kind]))
    own = [paths / f"{name}.{kind}.npz" for kind in range(2)]
    apart = sum(path.stat().st_size for path in own)
    for kind, path in enumerate(own):
        yield row(SENSES[kind], "size_bytes", path.stat().st_size, kind)
        yield row(SENSES[kind], "parameters", parameters(networks[kind]), kind)
        path.unlink()
    yield row("hybrid", "parameters", parameters(hybrid))
    yield row("hybrid", "parameter_ratio", sum(map(parameters, networks)) / parameters(hybrid))
    for number in reversed(KINDS):  # float32 last: it is the file that stays
        save(paths / f"{name}.npz", hybrid, classes, number)
        size = (paths / f"{name}.npz").stat().st_size
        method = "hybrid" if number == "float32" else f"hybrid_{number}"
        loaded = load(paths / f"{name}.npz")[0].to(device_of(hybrid))
        yield row(method, "size_bytes", size)
        yield row(method, "size_ratio", apart / size)
        for kind, sense in enumerate(senses):
            scores = scored(loaded, sense.images[sense.test], kind)
            yield row(method, "accuracy", fusion.accuracy(scores, sense.labels[sense.test]), kind)
    write_arrays(
        folder / "hybrid" / "predictions" / f"{name}.npz",
        **{f"{kind}_scores": tested[place] for place, kind in enumerate(SENSES)},
        **{f"{kind}_true": sense.labels[sense.test] for kind, sense in zip(SENSES, senses, strict=True)},
        **{f"{kind}_test": sense.test for kind, sense in zip(SENSES, senses, strict=True)},
    )


def calibrated(scores, labels, kind, temperature):
    """Rows of a head's temperature and of its calibration error without it and with it."""
    yield row("hybrid", "temperature", temperature, kind)
    for metric, value in (("calibration_error_raw", 1.0), ("calibration_error", temperature)):
        yield row("hybrid", metric, fusion.calibration_error(fusion.probabilities(scores, value), labels), kind)


def exported(hybrid, senses, settings, path):
    """Rows on the network as ONNX, over all test items: the largest difference of a score, and how often they agree.

    The difference is infinite where one has an answer and the other, for want of that sense, has none.
    """
    export_onnx(path, hybrid, settings.size)
    worst, agree = 0.0, []
    for kind, sense in enumerate(senses):
        own = scored(hybrid, sense.images[sense.test], kind)
        found = onnx_scores(path, lone(sense.images[sense.test], kind))[kind]
        silent = np.isnan(own)
        equal = np.array_equal(np.isnan(found), silent)
        worst = max(worst, float(np.abs(found - own)[~silent].max(initial=0)) if equal else np.inf)
        agree += list(found.argmax(axis=1) == own.argmax(axis=1))
    yield row("hybrid_onnx", "max_difference", worst)
    yield row("hybrid_onnx", "agreement", float(np.mean(agree)))
    yield row("hybrid_onnx", "size_bytes", path.stat().st_size)
