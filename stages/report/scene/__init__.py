"""How many faces each object of a scene needs (T3.1.3)."""

from functools import partial

import pandas as pd

from stages.charts.results import Results
from stages.report.claims import Claim, reading
from stages.report.effects import side, statistic

from . import counts, scene
from .counts import STAGE, TASKS
from .scene import NAMES, OURS, RANDOM, SHARED_OBJECTS

TABLES = {
    "random_scenes": scene.random_table, "scenes": scene.scenes, "scene": scene.scene_table,
    "faces_by_task": counts.needs, "face_counts": counts.counts_table,
}  # fmt: skip
FIGURES = {"scene": counts.frames, "faces_by_task": counts.needs_figure, "face_counts": counts.figure}
CHARTS = {"scene": scene.chart}

ALLOWED = 5.0  # per cent more faces that an online planner may need
FACES = "% of the faces"
MATCHED = {"displacement": "at an equal mean displacement", "error": "at an equal error of each frame's worst object"}
PHRASES = {
    ("over", "group"): "scenes", ("metric", "faces"): "faces", ("frame", "all"): "",
    **{("method", name): words for name, words in NAMES.items()},
    **{("matched", name): words for name, words in MATCHED.items()},
    **{("task", name): "" for name in TASKS},
    **{("condition", metres): f"seen from {metres:g} m" for metres in (0.5, 1.0, 2.0)},
    ("condition", 0.05): "felt within 5 % of full scale", ("condition", 0.02): "recognised within 2 points",
}  # fmt: skip


@statistic("faces_saved")
def faces_saved(results: Results, claim: Claim) -> pd.Series:
    """The share of the second side's faces that the first side does without."""
    return 1 - side(results, claim, claim.first, claim.second) / side(results, claim, claim.other, claim.first)


claim = partial(Claim, section="ours", statistic="faces_saved", unit=FACES, phrases=PHRASES)
planned = partial(claim, stage="scene", dataset=RANDOM, over=("group",), shared=SHARED_OBJECTS,
                  where={"metric": "faces", "frame": "all"})  # fmt: skip
needed = partial(claim, stage=STAGE, over=("item",), where={"metric": "faces"}, statistic="difference", relative=True,
                 unit="% of the mean of both")  # fmt: skip
SEEN = {"task": "seen", "condition": 1.0}
FELT = {"task": "felt", "condition": 0.05}
KNOWN = {"task": "recognised", "condition": 0.02}
CLAIMS = [
    *(
        planned(key=f"saves_{rival}_{matched}", first={"method": OURS}, second={"method": rival, "matched": matched},
                sentence=f"Ours needs fewer faces than {NAMES[rival]} {words}.")
        for matched, words in MATCHED.items()
        for rival in ("uniform", "uniform_size")
    ),
    *(
        planned(key=f"{method}_saves", first={"method": method, "matched": "displacement"},
                second={"method": "uniform", "matched": "displacement"},
                sentence=f"{words} needs fewer faces than uniform levels by distance at an equal mean displacement.")
        for method, words in (("beforehand", "A look-up of errors rendered beforehand"),
                              ("every_level", "Knowing the error of every level in every frame"))
    ),
    planned(key="online_faces", first={"method": "online"}, second={"method": OURS}, margin=ALLOWED,
            sentence=f"A planner that sees no frame ahead needs no more than {ALLOWED:g} % more faces."),
    needed(key="felt_over_seen", first=FELT, second=SEEN,
           sentence="To be felt as the full mesh is, an object needs more faces than to be seen from one metre."),
    needed(key="recognised_under_felt", first=FELT, second=KNOWN,
           sentence="To be recognised by touch, an object needs fewer faces than to be felt within 5 %.",
           readings=tuple(reading(f"felt within {share:.0%}", first={"condition": share}) for share in (0.02, 0.1))),
]  # fmt: skip
