"""Tables, charts and claims of exploring by touch and of its stability, on rows with a known truth."""

import numpy as np
import pandas as pd

from stages.exploration.report import needed

CURVE = {1: 0.6, 2: 0.8, 3: 0.9, 4: 0.95, 5: 0.98}
SAVED = {"gain": 2.0, "saliency": 3.5, "random": 3.0}  # touches until 95 %, at an accuracy of 97 %


def explored():
    """Rows of three ways: all have one curve of fixed numbers, and stop after different numbers of touches."""
    generator, rows = np.random.default_rng(0), []
    cells = [("random", "imprint"), ("random", "imprint_place"), ("random", "imprint_product"),
             ("regions", "imprint"), ("regions", "imprint_product")]  # fmt: skip
    for split, likelihood in cells:
        for way in ("random",) if likelihood == "imprint_product" else ("gain", "saliency", "random"):
            for repetition in range(8):
                noise = 0.002 * generator.normal()
                common = {"dataset": "test", "group": "six", "method": "thesis_ssim", "split": split}
                common |= {"likelihood": likelihood, "way": way, "repetition": repetition, "seconds": 1e-5, "seed": 0}
                sure = 0.2 if likelihood == "imprint_product" and split == "regions" else 0.0
                for touches, accuracy in CURVE.items():
                    noise = 0.002 * generator.normal()
                    row = {"stop": "fixed", "level": touches, "metric": "accuracy", "value": accuracy + noise}
                    rows.append(common | row | {"touches": touches, "belief": min(accuracy + sure, 0.999)})
                for metric in ("accuracy", "accuracy_decided"):
                    row = {"stop": "confidence", "level": 0.95, "metric": metric, "value": 0.97 + noise}
                    rows.append(common | row | {"touches": SAVED[way] + noise, "belief": 0.97, "decided": 1.0})
    return pd.DataFrame(rows)


def test_accuracy_beyond_the_curve_is_never_reached():
    rows = explored().query("split == 'random' and likelihood == 'imprint' and way == 'gain'")
    assert np.isnan(needed(rows, 0.999))
    assert needed(rows, 0.1) == 1
