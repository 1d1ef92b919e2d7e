"""Report: tables beside the thesis's, claims, figures, charts of accuracy against cost, and the web page."""

from .claims import CLAIMS
from .pareto import pareto_chart, pareto_front
from .verdict import Claim, judge, verdict

__all__ = ["CLAIMS", "Claim", "judge", "pareto_chart", "pareto_front", "verdict"]
