"""Claims of T4.3.2: what the pressure array's size and its sensels' distance do to recognition."""

from functools import partial

from stages.kit.split import Split
from stages.report.claims import Claim, highest_of

STAGE = "sensor_size"
FINE, COARSE, SMALL, LARGE = 0.002, 0.01, 16, 32  # the arrays of T figure 4.9
UNSEEN = {"metric": "accuracy", "split": Split.OBJECTS}
BEST = {"cells": LARGE, "pitch": COARSE}  # the thesis's best array
ALL = "mean of all classifiers"
PHRASES = {
    **{("cells", count): f"{count} x {count}" for count in (SMALL, LARGE)},
    **{("pitch", pitch): f"{pitch:g} apart" for pitch in (FINE, COARSE, 2 * COARSE)},
}
claim = partial(Claim, section="T4.3.2", stage=STAGE, where=UNSEEN, over=("item",), phrases=PHRASES, note=ALL)
larger = partial(claim, first={"cells": LARGE}, second={"cells": SMALL})

CLAIMS = [
    *(
        claim(key=f"larger_pitch_helps_{cells}", where=UNSEEN | {"cells": cells},
              sentence=f"At equal cells a sensor with larger sensels is better ({cells} x {cells}).",
              first={"pitch": COARSE}, second={"pitch": FINE})
        for cells in (SMALL, LARGE)
    ),
    larger(key="more_cells_help", where=UNSEEN | {"pitch": COARSE},
           sentence="At equal sensel size a larger sensor is better."),
    larger(key="more_cells_help_all", section="ours", note=f"{ALL} and all distances of sensels",
           sentence="At equal sensel size a larger sensor is better, whatever the size."),
    larger(key="cells_matter_less_when_fine", contrast=({"pitch": COARSE}, {"pitch": FINE}),
           sentence="With small sensels, more of them change less than with large ones."),
    claim(key="knn_best_sensor", sentence="kNN is the best classifier of single touches of unseen objects.",
          where=UNSEEN | BEST, first={"classifier": "knn"}, second={"classifier": highest_of()}, note=""),
    claim(key="finer_sensor_enough", section="ours", first={"cells": SMALL, "pitch": 2 * COARSE}, second=BEST,
          sentence="Half the cells at twice the distance are as good: the width counts, not the cells."),
    claim(key="known_objects_easier", section="ours",
          sentence="Touches of known objects flatter: their class is named more often than unseen ones'.",
          where={"metric": "accuracy"} | BEST, first={"split": Split.RANDOM}, second={"split": Split.OBJECTS}),
]  # fmt: skip
