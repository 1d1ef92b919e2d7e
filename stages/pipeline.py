"""The stages in the order of their data; each package has the settings of its stage as `Params`."""

from types import ModuleType

from . import (
    classification,
    conspicuity,
    contours,
    fixation,
    imprints,
    lod,
    look_and_touch,
    meshes,
    recorded,
    recorded_networks,
    report,
    salient_points,
    scene,
    sensor_size,
    sequences,
    simulated_to_real,
    stability,
    touch_stability,
    transfer,
    views,
    weights,
)

STAGES: dict[str, ModuleType] = {
    module.__name__.rpartition(".")[2]: module
    for module in (
        meshes,
        views,
        conspicuity,
        weights,
        salient_points,
        lod,
        scene,
        fixation,
        imprints,
        classification,
        look_and_touch,
        touch_stability,
        sensor_size,
        contours,
        sequences,
        transfer,
        recorded,
        simulated_to_real,
        recorded_networks,
        stability,
        report,
    )
}


def schema_of(section: str) -> type:
    """The settings of a stage, a dataclass whose fields have default, type and meaning."""
    return STAGES[section].Params
