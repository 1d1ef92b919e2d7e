"""T table 4.2: one touch, four objects."""

from ._touch import twin


def build(results):
    title = "Table 4.2: recognising {} by one touch, beside the thesis"
    return twin(results, "four", "table_4_2_four_virtual_objects", title)
