"""Names of the pipeline of version 1 that went in 2.0, and what to use. A later version drops this table.

A name stands as a person types it after `python -m stages.compose`: a set, a stage, an option of a setting, a setting
`section.key`, or `group=option`.
"""

from haptic_glance.base.gone import went

HOUSEHOLD = "use the set household"
GONE = {
    # sets
    "touch_events": "use pressure_images or biotac_grasps",
    "schunk": "use pressure_images or biotac_grasps",
    "furniture_denoised": "use household_denoised",
    "princeton_denoised": "use household_denoised",
    "furniture_hands": "use princeton_hands",
    "princeton_other_hands": "use princeton_hands",
    "princeton_3_1_four": "use household_3_1_four",
    "gaze_on_black": "use gaze with conspicuity.background=kept",
    "furniture_splits": "use furniture with sequences.repetitions=20",
    "household_scenes": f"{HOUSEHOLD} with scene=shelf, table or hall",
    "household_stability": f"{HOUSEHOLD}, whose stage stability measures breaking points",
    # stages, and sections of their settings
    "front": "use the stage look_and_touch",
    "attention_checks": "use the stage salient_points on the set gaze",
    "annotations": "use the stage weights, which learns from the marks in data/annotations",
    "coarse_imprints": "use the stage transfer with transfer.coarse_cells",
    "face_needs": "use the stage scene, which counts the faces that a scene needs",
    "exploration": "use the stage look_and_touch",
    # experiments and other options
    "experiment=scenes": f"{HOUSEHOLD} with scene=shelf, table or hall",
    "experiment=stability": f"{HOUSEHOLD}, whose stage stability measures breaking points",
    "experiment=coarse_imprints": "use experiment=transfer with transfer.coarse_cells",
    "scene=random": "use scene=shelf, table or hall",
    "stability=benchmark": "use the default settings of stability",
    "stability=every_object": "use the default settings of stability",
    "median": "use touch_stability.denoisers=[autoencoder]",
    # settings
    "scene.random": "use scene=shelf, table or hall",
    "stability.broken": "leave it out: the stage does not simplify broken meshes",
    "stability.draws": "leave it out: each disturbance has one draw",
    "stability.pairs": "use stability.perturbations, one at a time",
    "stability.used": "leave it out: the points of a disturbed object are only found again",
    "transfer.severities": "use touch_stability.severities",
}


def went_of(name: str) -> str:
    """`NAME went in 2.0; use ...` for a name, or the section of a setting, that went from the pipeline; else empty."""
    section = name.lstrip("+~").partition(".")[0]
    return went(name.lstrip("+~"), GONE) or went(section, GONE)
