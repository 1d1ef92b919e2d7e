"""From simulated to real touch: what simulated imprints add to few real touches."""

from typing import Any

import pandas as pd

from haptic_glance.know.split import Split, shared_by
from stages.charts.drawing import label
from stages.charts.items import Table
from stages.charts.results import Results
from stages.charts.tables import Ranking, grid, means

BY = ["training", "simulation", "aligned", "touches", "classifier"]
SIMULATIONS = {
    "none": "none", "array": "the thesis's array", "resting": "resting", "resting_skin": "resting, skin",
    "resting_grain": "resting, skin, gain and grain", "resting_small": "resting, objects at 56 %",
}  # fmt: skip
SHOWN = "knn"  # the best of the five on real touches


def build_table(results: Results) -> Table:
    """Accuracy of kNN by kind of simulated imprints and number of real touches."""
    frame, rows = _accuracies(results)
    alone = rows[(rows["group"] != "all") & (rows["training"] == "simulated")]
    shares = alone.groupby(["simulation", "aligned", "group"])["value"].mean()
    way: Any = shares.groupby(level=[0, 1]).mean().idxmax()
    texts = [f"{label(name)} {100 * share:.0f}" for name, share in shares[way].sort_values(ascending=False).items()]
    knn = frame[frame["classifier"] == SHOWN].sort_values("touches", kind="stable")
    knn["simulated imprints"] = [*map(_way, knn["simulation"], knn["aligned"])]
    wide = grid(knn, "simulated imprints", "touches", head=lambda count: f"{count} real touch{'es' * (count != 1)}, %")
    wide = wide.replace("not run", "–")  # with neither real nor simulated touches there is nothing to run
    wide = wide.sort_values("simulated imprints", key=lambda way: way != "none", kind="stable")
    words = {"way": _way(*way), "shares": ", ".join(texts), "best": _best(frame)}
    return Table(frame, wide, words, Ranking(list(wide.columns[1:])))


def _accuracies(results: Results) -> tuple[pd.DataFrame, pd.DataFrame]:
    """(accuracy, low and high by the columns BY, the rows); of real touches alone the simulation is "none"."""
    rows = results.rows("simulated_to_real").fillna({"simulation": "none", "aligned": False}).astype({"aligned": bool})
    averages = means(rows[rows["group"] == "all"], BY, shared_by(Split.RANDOM), top=1.0)
    return pd.DataFrame(averages).rename(columns={"mean": "accuracy"})[[*BY, "accuracy", "low", "high"]], rows


def _way(simulation: Any, aligned: Any) -> str:
    return SIMULATIONS[simulation] + (", aligned" if aligned else "")


def _best(frame: pd.DataFrame) -> str:
    """The best of all classifiers by the number of real touches, with and without simulated imprints."""
    top = frame.loc[frame.groupby(["training", "touches"])["accuracy"].idxmax()]
    texts = {}
    for training, simulation, aligned, touches, classifier, share, *_ in top.itertuples(index=False):
        way = f", {_way(simulation, aligned)}" if training == "both" else ""
        texts[training, touches] = f"{100 * share:.0f} ({label(classifier)}{way})"
    counts = sorted(set(frame["touches"]) - {0})
    return "; ".join(f"{count}: {texts['real', count]} without, {texts['both', count]} with" for count in counts)


PAGE = "touch"
TABLES = {"simulated_to_real": build_table}
FIGURES = {}
CHARTS = {}
