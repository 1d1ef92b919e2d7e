"""T table 4.1: one touch, six objects."""

from ._touch import twin


def build(results):
    title = "Table 4.1: recognising {} by one touch, beside the thesis"
    return twin(results, "six", "table_4_1_six_virtual_objects", title)
