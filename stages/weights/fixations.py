"""The fixation model: a log-linear density of fixations over the surface, fitted by maximum likelihood."""

import functools
from collections.abc import Mapping, Sequence

import numpy as np
from scipy.optimize import minimize

RIDGE = 0.05  # penalty on the squared weights, per mean log-likelihood of a fixation; chosen leave-one-object-out


def fit_fixations(
    features: Sequence[np.ndarray], amounts: Sequence[np.ndarray], areas: Sequence[np.ndarray], ridge: float = RIDGE
) -> np.ndarray:
    """The weight of each feature, (d,) f8, that makes the fixations of all objects most likely.

    Per object: features (n, d), amounts (n,) of fixations (seconds, or marks), areas (n,) of the vertices. A fixation
    lands on vertex i with probability p_i = A_i exp(w f_i) / sum_j A_j exp(w f_j): an inhomogeneous Poisson process
    given the number of fixations, the standard model (Barthelme, Trukenbrod, Engbert and Wichmann, Modeling fixation
    locations using spatial point processes, Journal of Vision 13(12), 2013). Objects are weighted equally, whatever
    their number of fixations. The problem is convex, so the result does not depend on the initial value. Raises
    ValueError without objects, or for an object without fixations.
    """
    if not len(features):
        raise ValueError("no object to fit the model to: give at least one with fixations")
    if any(not amount.sum() > 0 for amount in amounts):
        raise ValueError("the model cannot be fitted to an object without fixations: leave it out")
    objects = [
        (f, a / a.sum(), np.log(np.maximum(area, 1e-300))) for f, a, area in zip(features, amounts, areas, strict=True)
    ]

    def loss(weights):
        value, slope = ridge * weights @ weights, 2 * ridge * weights
        for f, share, log_area in objects:
            score = f @ weights + log_area
            likely = score - np.logaddexp.reduce(score)
            value -= (share * (likely - log_area)).sum() / len(objects)
            slope -= (share - np.exp(likely)) @ f / len(objects)
        return value, slope

    found = minimize(loss, np.zeros(features[0].shape[1]), jac=True, method="L-BFGS-B", options={"maxiter": 500})
    return found.x


def fixation_density(features: Mapping[str, np.ndarray], weights: Mapping[str, float]) -> np.ndarray:
    """(n,) f8 in 0..1: exp(sum of weight times feature) over its maximum.

    features: dict name -> (n,); weights: dict name -> weight. Raises ValueError when a feature of the weights is
    missing, or there are no weights.
    """
    missing = [name for name in weights if name not in features]
    if missing or not weights:
        raise ValueError(
            f"no feature {', '.join(missing) or 'at all'}: the weights need {', '.join(weights) or 'names'}"
        )
    if not np.isfinite(list(weights.values())).all():
        raise ValueError(f"weights must be finite, got {weights}")
    score = functools.reduce(np.add, (weight * features[name] for name, weight in weights.items()))
    return np.exp(score - score.max())
