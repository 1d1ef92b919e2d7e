"""Numbers in the text that are read from the tables in reports/ when the pages are built, never typed.

    {measured}`claims key=glance_over_best_gaze: effect low high +.2f`      +0.96 [0.75, 1.19]
    {measured}`tables/scene method=uniform matched=error: faces .0f`         2,803

Asked for as in the report's prose: stages.charts.cells.
"""

from pathlib import Path

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxRole

from stages.charts.cells import PLACE, rows_of, text_of

REPORTS = Path(__file__).resolve().parents[2] / "reports"


def setup(app: Sphinx) -> dict[str, bool]:
    """Adds the role."""
    app.add_role("measured", Measured())
    return {"parallel_read_safe": True, "parallel_write_safe": True}


class Measured(SphinxRole):
    """The number, with the cell that it is from as what a pointer over it shows."""

    def run(self) -> tuple[list[nodes.Node], list]:
        """The number, or a problem that ends the build."""
        query = " ".join(self.text.split())
        try:
            shown = measured(query)
        except LookupError as error:
            message = self.inliner.reporter.error(f"{query}: {error}", line=self.lineno)
            return [self.inliner.problematic(self.rawtext, self.rawtext, message)], [message]
        return [nodes.abbreviation(self.rawtext, shown, explanation=f"reports/{query}", classes=["measured"])], []


def measured(asked: str) -> str:
    """The text of what a role asks for; LookupError where it is not one row, or has no number."""
    place = PLACE.fullmatch(f"{{{asked}}}")
    if place is None:
        raise LookupError("write FILE KEY=VALUE KEY=VALUE: COLUMN [LOW HIGH] FORMAT")
    name, where, column = place.groups()
    return text_of(rows_of(REPORTS / f"{name}.csv", where), column)
