"""The shares of T4.2.4: how many imprints correlate by 0.85 or more with one of another object."""

import pandas as pd

from stages.report.items import Table
from stages.report.style import label

from ._touch import OURS

# T4.2.4, enhanced visual attention; of the thesis's cow, dromedary, glasses, hand, plane and cup.
BY_OBJECT = {
    "elephant": 0.3333, "duck": 0.4, "eyeglasses": 0.0667, "hand": 0.2667, "airplane": 0.1333, "cup": 0.2,
}  # fmt: skip
NOTES = [
    "Per cent of the imprints that have a normalised cross-correlation of 0.85 or more with an imprint of another "
    "object of the set of six. A flat imprint counts as like every other flat one and like nothing else.",
    "The share grows with the number of imprints, since each is compared with all: all of this run's beside the first "
    "15 of each object, as many as the thesis had (its shares by object are fifteenths).",
    "By object: enhanced visual attention. The thesis had cow, dromedary, glasses, hand, plane and cup; each figure "
    "stands beside the object of this run that takes the place.",
]


def build(results):
    rows = results.measured("classification", object="six", metric="similar_share")
    thesis = results.thesis("section_4_2_similar_imprints").set_index("sampling")["share_with_ncc_over_0_85"]
    cells = []
    for method in dict.fromkeys(rows["method"]):
        name = next((theirs for theirs, ours in OURS.items() if ours == method), method)
        mine = rows[(rows["method"] == method) & (rows["of"] == "all")]
        cells.append({"of": "sampling", "name": name} | _shares(mine) | {"thesis": thesis.get(name)})
    enhanced = rows[(rows["method"] == OURS["enhanced_visual_attention"]) & (rows["of"] != "all")]
    for name, mine in enhanced.groupby("of", sort=False):
        cells.append({"of": "object", "name": name} | _shares(mine) | {"thesis": BY_OBJECT.get(name)})
    order = list(thesis.index)
    cells.sort(key=lambda cell: order.index(cell["name"]) if cell["name"] in order else len(order))
    frame = pd.DataFrame(cells)
    return Table("Section 4.2.4: imprints that another object has too, beside the thesis", frame, NOTES, _shown(frame))


def _shares(rows):
    by_variant = rows.set_index("variant")["value"]
    imprints = rows.set_index("variant")["imprints"].get("plain")
    return {"imprints": imprints, "all": by_variant.get("plain"), "first_15": by_variant.get("first_15")}


def _shown(frame):
    names = [name if of == "object" else _spoken(name) for of, name in zip(frame["of"], frame["name"], strict=True)]
    shown = pd.DataFrame({"of": frame["of"], "name": names})
    for column, head in (("all", "ours, all, %"), ("first_15", "ours, first 15, %"), ("thesis", "thesis, %")):
        shown[head] = 100 * frame[column].astype(float)
    return shown


def _spoken(name):
    return name.replace("_", " ") if name in OURS else label(name)
