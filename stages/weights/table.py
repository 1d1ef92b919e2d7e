"""The table of weights: one row a method and channel; the method that the settings choose is marked."""

import pandas as pd

from stages.kit.files import read_table

from .published import weights


def weight_table(methods, chosen):
    """Frame with columns method, channel, weight, chosen (boolean), one row a method and channel.

    The mark travels with the data, so that later stages follow the choice without reading another stage's settings.
    Raises ValueError for an unknown method, or when the chosen one is not among the methods.
    """
    if chosen not in methods:
        raise ValueError(f"weights.method {chosen!r} is not in weights.methods: {', '.join(methods)}; add it there")
    rows = [
        {"method": method, "channel": channel, "weight": weight, "chosen": method == chosen}
        for method in methods
        for channel, weight in weights(method).items()
    ]
    return pd.DataFrame(rows)


def read_weights(path, method):
    """The weights of one method from a table's file: dict channel -> weight."""
    table = read_table(path)
    found = table[table.method == method]
    if found.empty:
        raise ValueError(f"{path} has no weights {method!r}, only {', '.join(table.method.unique())}")
    return dict(zip(found.channel, found.weight.astype(float), strict=True))


def chosen_weights(path):
    """The weights of the chosen method from a table's file: dict channel -> weight."""
    table = read_table(path)
    return read_weights(path, table.method[table.chosen].iloc[0])
