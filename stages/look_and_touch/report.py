PAGE = "look_and_touch"
TABLES, FIGURES, CHARTS = {}, {}, {}
