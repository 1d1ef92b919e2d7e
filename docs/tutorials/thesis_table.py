"""
Reproduce a table of the thesis
===============================

Table 4.1 of the thesis has the accuracies of five classifiers that recognise six objects by one touch. Several methods
choose the places of the touches. The rows of our measurement are part of the repository, so you can rebuild the table
in a second and test the claim behind it without a run. The last section says how to measure the rows anew.

Needs a clone and ``pip install '.[pipeline]'``; runs without a network. For the command of the last section, fetch the
meshes beforehand: ``python -m stages.meshes household``.
"""

import matplotlib.pyplot as plt
import pandas as pd

from haptic_glance.gallery.demo import sample
from haptic_glance.know.split import Split, shared_by
from stages.engine.statistics import interval
from stages.report.verdict import verdict

ROOT = sample().parents[1]  # of the checkout

rows = pd.read_csv(ROOT / "reports/measurements/household_4_2/classification.csv.gz", low_memory=False)
rows = rows[(rows["group"] == "six") & (rows["variant"] == "plain") & (rows["metric"] == "accuracy")]
rows = rows[(rows["split"] == Split.RANDOM) & (rows["imprints"] == 360)]
print(len(rows), "accuracies;", ", ".join(sorted(rows["method"].unique())))

# %%
# From rows to a table
# --------------------
#
# A cell is the mean over the repeated splits, with a 95 % interval. The splits share most of their training touches,
# and the interval is widened for that (Nadeau and Bengio 2003); without it, splitting more often would make any
# difference significant.


def cell(values: pd.Series) -> str:
    """`62 [56, 67]`, in per cent."""
    mean, low, high = interval(100 * values, shared=shared_by(Split.RANDOM))
    return f"{mean:.0f} [{low:.0f}, {high:.0f}]"


table = rows.groupby(["method", "classifier"])["value"].agg(cell).unstack()
print(table.to_string())

# %%
# Beside the thesis
# -----------------
#
# The objects are not the toys of the thesis: compare the order of rows and columns, not the numbers.

thesis = pd.read_csv(ROOT / "data/reference/thesis/table_4_1_six_virtual_objects.csv").set_index("sampling")
print((100 * thesis).round().astype(int).to_string())

# %%
# Test the claim
# --------------
#
# The thesis finds that touches at attended places recognise better than blind ones. Each split gives a pair, and the
# difference of each pair counts. The six objects are one choice. ``python -m stages.claim equal_over_blind`` tests the
# same claim on 40 random sets of six objects, so its numbers differ.

attended, blind = (
    rows[(rows["method"] == method) & (rows["classifier"] == "knn")].set_index("repetition")["value"]
    for method in ("VisAttAll", "random")
)
differences = 100 * (attended - blind)
mean, low, high = interval(differences, shared=shared_by(Split.RANDOM))
word = verdict(low, high, "points")
print(f"attended minus blind, kNN: {mean:+.1f} [{low:.1f}, {high:.1f}] points: {word}")

plt.figure(figsize=(6, 2.2), layout="constrained")
plt.plot(differences, [0] * len(differences), "o", alpha=0.4)
plt.errorbar(mean, 1, xerr=[[mean - low], [high - mean]], fmt="s", capsize=4)
plt.axvline(0, color="0.7")
plt.yticks([0, 1], ["splits", "mean, 95 %"])
plt.ylim(-0.5, 1.5)
plt.xlabel("points of accuracy")
plt.show()

# %%
# Measure the rows anew
# ---------------------
#
# The experiment presses every imprint and trains every classifier again, which takes minutes. Its rows and its page go
# to ``runs/table_4_1``. The last two commands bring the published settings and DVC's notes back.
#
# .. code-block:: sh
#
#    python -m stages.compose experiment=table_4_1 && dvc repro
#    python -m stages.compose
#    git checkout dvc.lock
