"""T table 5.1: networks that learned by sight on VT-60, an optical sensor."""

from .rows import printed_table


def build(results):
    return printed_table(results, "vt60", "table_5_1_vt60_bathtip", "Table 5.1: VT-60, an optical sensor")
