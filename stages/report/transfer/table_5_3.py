"""T table 5.3: the same networks on imprints of 16 x 16, what the real array gives."""

from stages.report.networks import COARSE

from .network_table import NOTES, network_table

OWN = [
    "The thesis touched with a real array of 16 x 16 sensels; here it is a simulated one of the same number and as "
    "wide as that of table 5.4, so that the resolution alone differs between the two tables.",
]


def build(results):
    title = "Table 5.3: networks trained on photographs, used for touch, imprints of 16 x 16"
    return network_table(results, COARSE, "table_5_3_fsr_16x16", title, [*NOTES, *OWN])
