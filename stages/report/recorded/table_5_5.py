"""T table 5.5: networks that learned by sight on BiGS, a Barrett hand."""

from .rows import printed_table


def build(results):
    return printed_table(results, "bigs", "table_5_5_bigs_barrett", "Table 5.5: BiGS, a Barrett hand")
