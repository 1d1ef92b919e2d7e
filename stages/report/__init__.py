"""Report: tables beside the thesis's, claims, figures, charts of accuracy against cost, and the web page."""
