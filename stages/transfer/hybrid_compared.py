"""The hybrid network compared with its two parent networks: accuracy, size, calibration, and as ONNX (T5.5)."""

from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np

from haptic_glance.base.files import write_arrays
from haptic_glance.deep.device import device_of
from haptic_glance.deep.hybrid import PRECISIONS, SENSES, HybridNet, load, save, state_arrays
from haptic_glance.deep.images import normalise
from haptic_glance.deep.network import Network, count_parameters

from . import fusion
from .hybrid_data import SenseData
from .hybrid_scores import in_batches, row, sense_scores, single_sense
from .onnx_export import export_onnx, onnx_scores
from .schema import Params


def comparison_rows(
    hybrid: HybridNet,
    networks: Sequence[Network],
    senses: Sequence[SenseData],
    seconds: Sequence[float],
    name: str,
    folder: Path,
    classes: Sequence[str],
) -> Iterator[dict]:
    """Rows of the two networks, the hybrid and its versions of lower precision: accuracy, size, calibration."""
    paths = folder / "hybrid" / "networks"
    tested = {}
    for kind, (sense, network) in enumerate(zip(senses, networks, strict=True)):
        own = in_batches(lambda part, n=network: n(normalise(part)), sense.images[sense.test], device_of(network))
        tested[kind] = sense_scores(hybrid, sense.images[sense.test], kind)
        write_arrays(paths / f"{name}.{kind}.npz", **state_arrays(network))
        yield row(SENSES[kind], "accuracy", fusion.accuracy(own, sense.labels[sense.test]), kind, seconds[kind])
        yield row("hybrid", "max_difference", float(np.nanmax(np.abs(own - tested[kind]))), kind)
        yield from calibration_rows(tested[kind], sense.labels[sense.test], kind, float(hybrid.temperature[kind]))
    own = [paths / f"{name}.{kind}.npz" for kind in range(2)]
    apart = sum(path.stat().st_size for path in own)
    for kind, path in enumerate(own):
        yield row(SENSES[kind], "size_bytes", path.stat().st_size, kind)
        yield row(SENSES[kind], "parameters", count_parameters(networks[kind]), kind)
        path.unlink()
    yield row("hybrid", "parameters", count_parameters(hybrid))
    yield row("hybrid", "parameter_ratio", sum(map(count_parameters, networks)) / count_parameters(hybrid))
    for number in reversed(PRECISIONS):  # float32 last, whose file is kept
        save(paths / f"{name}.npz", hybrid, classes, number)
        size = (paths / f"{name}.npz").stat().st_size
        method = "hybrid" if number == "float32" else f"hybrid_{number}"
        loaded = load(paths / f"{name}.npz")[0].to(device_of(hybrid))
        yield row(method, "size_bytes", size)
        yield row(method, "size_ratio", apart / size)
        for kind, sense in enumerate(senses):
            scores = sense_scores(loaded, sense.images[sense.test], kind)
            yield row(method, "accuracy", fusion.accuracy(scores, sense.labels[sense.test]), kind)
    write_arrays(
        folder / "hybrid" / "predictions" / f"{name}.npz",
        **{f"{kind}_scores": tested[place] for place, kind in enumerate(SENSES)},
        **{f"{kind}_true": sense.labels[sense.test] for kind, sense in zip(SENSES, senses, strict=True)},
        **{f"{kind}_test": sense.test for kind, sense in zip(SENSES, senses, strict=True)},
    )


def calibration_rows(scores: np.ndarray, labels: np.ndarray, kind: int, temperature: float) -> Iterator[dict]:
    """Rows of a head's temperature and of its calibration error without it and with it."""
    yield row("hybrid", "temperature", temperature, kind)
    for metric, value in (("calibration_error_raw", 1.0), ("calibration_error", temperature)):
        yield row("hybrid", metric, fusion.calibration_error(fusion.probabilities(scores, value), labels), kind)


def onnx_rows(hybrid: HybridNet, senses: Sequence[SenseData], settings: Params, path: Path) -> Iterator[dict]:
    """Rows of the network as ONNX over all test items: the largest difference of a score, and the agreement of classes.

    The difference is infinite where only one of them treats a sense as absent.
    """
    export_onnx(path, hybrid, settings.size)
    worst, agree = 0.0, []
    for kind, sense in enumerate(senses):
        own = sense_scores(hybrid, sense.images[sense.test], kind)
        found = onnx_scores(path, single_sense(sense.images[sense.test], kind))[kind]
        absent = np.isnan(own)
        equal = np.array_equal(np.isnan(found), absent)
        worst = max(worst, float(np.abs(found - own)[~absent].max(initial=0)) if equal else np.inf)
        agree += list(found.argmax(axis=1) == own.argmax(axis=1))
    yield row("hybrid_onnx", "max_difference", worst)
    yield row("hybrid_onnx", "agreement", float(np.mean(agree)))
    yield row("hybrid_onnx", "size_bytes", path.stat().st_size)
