"""T table 5.2: networks that learned by sight on ViTac, an optical sensor on cloth."""

from .rows import printed_table


def build(results):
    return printed_table(results, "vitac", "table_5_2_vitac_gelsight", "Table 5.2: ViTac, an optical sensor on cloth")
