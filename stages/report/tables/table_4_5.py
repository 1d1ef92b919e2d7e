"""T table 4.5: one touch, six objects, with the position of the touch as a further feature."""

from ._touch import APART, twin

NOTES = [
    "The three coordinates join the 12 components behind the PCA, standardised. They presume that the object stands "
    "as it did in training and that its size and centre are known: all meshes here are centred and of one size.",
    "Apart: here one side of the objects is held out, the same for all. With a region of each object's own, other "
    "objects were touched where this one was not, and its positions would point to them. "
    "Not run with 15 imprints.",
    "locations_turned in reports/measurements/classification.csv: tested on objects turned about the vertical by an "
    "angle that training did not know.",
]


def build(results):
    title = "Table 4.5: recognising {} by one touch and its position, beside the thesis"
    table = twin(results, "six", "table_4_5_six_objects_with_locations", title, "locations", "first_15_locations")
    table.notes = [*NOTES, *(note for note in table.notes if note != APART)]
    return table
