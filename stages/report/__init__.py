"""Report: tables beside the thesis's, claims, figures, charts of accuracy against cost, and the web page."""

from .claims import Claim
from .pareto import pareto_chart, pareto_front
from .topics import CLAIMS
from .verdict import judge, verdict

__all__ = ["CLAIMS", "Claim", "judge", "pareto_chart", "pareto_front", "verdict"]
