"""How samples are scaled before the classifiers: readings of one sentence of T4.2.4.

The sentence is "The entire data is standardized beforehand using z-transform". Gamma 1 of the SVM is fixed, so the
scale decides how many neighbours its kernel sees.

| scaling | features | map and positions of joined touches |
|---|---|---|
| training | z-transform fitted to the training part, 12 components | z-transform fitted to the training part |
| beforehand | z-transform of all data, 12 components of all data | z-transform of the positions of all data |
| components | as beforehand, the z-transform once more on the components | as training, of all data |
| min_max | all data to 0..1, 12 components of all data | all data to 0..1 |

`beforehand` is printed. `training` is ours: nothing of the hold-out leaks into training. `components` is the input of
RapidMiner's own SVM, which standardises the columns that it is given. (Its LibSVM takes them as they are: that is
`beforehand`.) `min_max` is no reading of the word z-transform. It shows the same SVM on distances about 1, its width.
"""

from typing import Any

import numpy as np

COMPONENTS = 12  # T4.2.3.4
KINDS = ("features", "located", "reduced", "joined")  # of samples
TRAINING, BEFOREHAND, TWICE, MIN_MAX = SCALINGS = ("training", "beforehand", "components", "min_max")
TOUCH = 5  # columns of one of several joined touches: two of the map, three of the position


def reduction(kind: str = "features", scaling: str = TRAINING) -> list[Any]:
    """The scikit-learn transformers before all classifiers.

    kind: of the samples. "features": those of `features`, at least 12 samples; they become 12 principal components.
    "located": the same with the position of the touch in three more columns, the last ones. They are scaled too and
    appended to the principal components, since the PCA would spread them over all components. "reduced": numbers that
    need no further reduction; they are only scaled. "joined": touches of TOUCH columns each, one after another.
    scaling: a name in SCALINGS. Raises ValueError for another name or kind.
    """
    from sklearn.compose import make_column_transformer
    from sklearn.decomposition import PCA
    from sklearn.pipeline import make_pipeline
    from sklearn.preprocessing import MinMaxScaler, StandardScaler

    if kind not in KINDS:
        raise ValueError(f"kind must be one of {', '.join(KINDS)}, got {kind!r}")
    if scaling not in SCALINGS:
        raise ValueError(f"scaling must be one of {', '.join(SCALINGS)}, got {scaling!r}")
    scaler = MinMaxScaler if scaling == MIN_MAX else StandardScaler
    if kind == "joined" and scaling == BEFOREHAND:
        return [make_column_transformer((scaler(), _positions), remainder="passthrough")]
    if kind in ("reduced", "joined"):
        return [scaler()]
    components = [scaler(), PCA(COMPONENTS, svd_solver="full"), *([scaler()] if scaling == TWICE else [])]
    if kind == "located":
        touch, place = (make_pipeline(*components), slice(0, -3)), (scaler(), slice(-3, None))
        return [make_column_transformer(touch, place)]
    return components


def scaled(
    train: np.ndarray, test: np.ndarray, kind: str = "features", scaling: str = TRAINING
) -> tuple[np.ndarray, np.ndarray]:
    """(train, test) after `reduction`, fitted to the training part, or by the other readings to both parts."""
    for step in reduction(kind, scaling):
        if scaling == TRAINING:
            train, test = step.fit_transform(train), step.transform(test)
        else:
            step.fit(np.concatenate([train, test]))
            train, test = step.transform(train), step.transform(test)
    return train, test


def _positions(joined):
    """The columns of joined touches that hold positions."""
    return [column for column in range(joined.shape[1]) if column % TOUCH > 1]
