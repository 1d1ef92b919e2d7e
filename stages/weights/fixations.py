"""The fixation model: where people look, as a log-linear density over the surface, learned by maximum likelihood."""

import numpy as np
from scipy.optimize import minimize

RIDGE = 0.05  # of the squared weights, beside the mean log-likelihood a fixation; chosen leave-one-object-out


def fit_fixations(features, amounts, areas, ridge=RIDGE):
    """The weight of each feature, (d,) f8, that makes the fixations of all objects most likely.

    features: one (n, d) array an object, amounts (n,) its fixations (seconds, or marks), areas (n,) of its vertices.
    A look lands on vertex i with probability p_i = A_i exp(w f_i) / sum_j A_j exp(w f_j): an inhomogeneous Poisson
    process given the number of looks, the standard model of fixations (Barthelme, Trukenbrod, Engbert and Wichmann,
    Modeling fixation locations using spatial point processes, Journal of Vision 13(12), 2013). Each object counts
    alike, whatever its number of looks. The problem is convex, so the answer does not depend on a start. Raises
    ValueError without objects, or for an object without fixations.
    """
    if not len(features):
        raise ValueError("no object to learn from: give at least one with fixations")
    if any(not amount.sum() > 0 for amount in amounts):
        raise ValueError("an object without fixations cannot be learned from: leave it out")
    given = [
        (f, a / a.sum(), np.log(np.maximum(area, 1e-300))) for f, a, area in zip(features, amounts, areas, strict=True)
    ]

    def loss(weights):
        value, slope = ridge * weights @ weights, 2 * ridge * weights
        for f, share, log_area in given:
            score = f @ weights + log_area
            likely = score - np.logaddexp.reduce(score)
            value -= (share * (likely - log_area)).sum() / len(given)
            slope -= (share - np.exp(likely)) @ f / len(given)
        return value, slope

    found = minimize(loss, np.zeros(features[0].shape[1]), jac=True, method="L-BFGS-B", options={"maxiter": 500})
    return found.x


def fixation_density(features, weights):
    """(n,) f8 in 0..1: exp(sum of weight times feature) over its maximum. features: dict name -> (n,); weights: dict.

    Raises ValueError when the weights name a feature that is not there, or none at all.
    """
    missing = [name for name in weights if name not in features]
    if missing or not weights:
        raise ValueError(
            f"no feature {', '.join(missing) or 'at all'}: the weights need {', '.join(weights) or 'names'}"
        )
    if not np.isfinite(list(weights.values())).all():
        raise ValueError(f"weights must be finite, got {weights}")
    score = sum(weight * features[name] for name, weight in weights.items())
    return np.exp(score - score.max())
