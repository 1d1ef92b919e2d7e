"""Linear correlation of the predicted saliency with the human density."""

from .truth import checked, standardised


def cc(saliency, truth):
    """Pearson's correlation of saliency (n,) and truth.density over the surface, each vertex weighing its area.

    -1..1, one is best; 0 when either is constant. Unlike KL it treats too much and too little alike. Source: Bylinskii,
    Judd, Oliva, Torralba and Durand, What do different evaluation metrics tell us about saliency models?, PAMI 2019,
    section 4.2. Raises ValueError for a saliency of another shape or with NaN.
    """
    predicted = standardised(checked(saliency, truth), truth.shares)
    return float(truth.shares @ (predicted * standardised(truth.density, truth.shares)))
