"""Claims of T4.3.2: what the pressure array's size and its sensels' distance do to recognition."""

from dataclasses import replace
from functools import partial

from haptic_glance.know.split import Split
from stages.report.claims import Claim, highest_of

STAGE = "sensor_size"
FINE, COARSE, SMALL, LARGE = 0.002, 0.01, 16, 32  # the arrays of T figure 4.9
UNSEEN = {"metric": "accuracy", "split": Split.OBJECTS}
BEST = {"cells": LARGE, "pitch": COARSE}  # the thesis's best array
ALL = "mean of all classifiers"
PHRASES = {
    **{("cells", count): f"{count} x {count}" for count in (SMALL, LARGE)},
    ("fine", None): "",
    ("extent", None): "",
    ("fine", "12-0.005"): "with 12 x 12 cells 0.005 apart",
    ("fine", "12-0.002"): "with 12 x 12 cells 0.002 apart",
    ("cells", 20): "20 x 20",
    ("pitch", 0.005): "0.005 apart",
    ("extent", "points"): "at separate points",
    ("extent", "region"): "in a salient region",
    ("extent", "disc"): "in a disc",
    **{("pitch", pitch): f"{pitch:g} apart" for pitch in (FINE, COARSE, 2 * COARSE)},
}
MORE = (None, "princeton_touched")  # the furniture, and eight classes of six objects
claim = partial(Claim, section="T4.3.2", stage=STAGE, dataset="princeton_eight", where=UNSEEN,
                over=("group", "item"), phrases=PHRASES, note=ALL)  # fmt: skip
ours = partial(claim, section="ours", dataset=MORE)
larger = partial(claim, first={"cells": LARGE}, second={"cells": SMALL})
HANDS = ("furniture_hands", "princeton_hands")
EQUAL = {"cells": 20, "fine": None, "extent": None}  # as many cells as 16 x 16 and 12 x 12
AROUND = {"cells": SMALL, "pitch": COARSE}
hands = partial(claim, section="T6.3", dataset=HANDS, note="mean of both classifiers")

PRINTED = [
    *(
        claim(key=f"larger_pitch_helps_{cells}", where=UNSEEN | {"cells": cells},
              sentence=f"At equal cells a sensor with larger sensels is better ({cells} x {cells}).",
              first={"pitch": COARSE}, second={"pitch": FINE})
        for cells in (SMALL, LARGE)
    ),
    larger(key="more_cells_help", where=UNSEEN | {"pitch": COARSE},
           sentence="At equal sensel size a larger sensor is better."),
    larger(key="cells_matter_less_when_fine", contrast=({"pitch": COARSE}, {"pitch": FINE}),
           sentence="With small sensels, more of them change less than with large ones."),
    claim(key="knn_best_sensor", sentence="kNN is the best classifier of single touches of unseen objects.",
          where=UNSEEN | BEST, first={"classifier": "knn"}, second={"classifier": highest_of()}, note=""),
]  # fmt: skip
CLAIMS = [
    *PRINTED,
    *(replace(one, key=f"{one.key}_more", of=one.key, dataset=MORE, printed=0) for one in PRINTED),
    ours(key="more_cells_help_all", note=f"{ALL} and all distances of sensels", first={"cells": LARGE},
         second={"cells": SMALL}, sentence="At equal sensel size a larger sensor is better, whatever the size."),
    ours(key="finer_sensor_enough", first={"cells": SMALL, "pitch": 2 * COARSE}, second=BEST,
          sentence="Half the cells at twice the distance are as good: the width counts, not the cells."),
    *(
        hands(key=f"{hand}_hand_over_{cells}", first={"cells": SMALL, "pitch": coarse, "fine": f"12-{fine}"},
              second=EQUAL | {"pitch": pitch},
              sentence=f"With as many cells in all, coarse and fine cells on one {hand} hand are better than one array "
              f"of {cells} cells.")
        for hand, coarse, fine in (("wide", 2 * COARSE, 0.005), ("narrow", COARSE, FINE))
        for cells, pitch in (("coarse", coarse), ("fine", fine))
    ),
    *(
        hands(key=f"region_over_{other}", first=AROUND | {"extent": "region"}, second=AROUND | {"extent": other},
              sentence=f"Five touches in the salient region around a point are better than {words}.")
        for other, words in (("points", "at five separate points"), ("disc", "in a disc of its area"))
    ),
    ours(key="known_objects_easier",
         sentence="Touches of known objects flatter: their class is named more often than unseen ones'.",
          where={"metric": "accuracy"} | BEST, first={"split": Split.RANDOM}, second={"split": Split.OBJECTS}),
]  # fmt: skip
