"""T table 5.4: what networks that learned by sight make of simulated imprints of 128 x 128."""

from stages.report.networks import FINE

from .network_table import NOTES, network_table

OWN = [
    "The thesis trained on 30 objects of six classes in Matlab, for ten epochs. Here: a catalogue of furniture, and "
    "the thesis's classes from the Princeton segmentation benchmark where they were measured. Compare the order, not "
    "the digits.",
]


def build(results):
    title = "Table 5.4: networks trained on photographs, used for touch, imprints of 128 x 128"
    return network_table(results, FINE, "table_5_4_simulated_fsr_128x128", title, [*NOTES, *OWN])
