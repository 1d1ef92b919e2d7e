"""What the charts of the error measures share: rows of benchmarks.errors, typical values of them, a chart and a CSV."""

from stages.kit.files import write_table
from stages.report.items import Figure
from stages.report.results import NotRun
from stages.report.style import plot_style


def errors_chart(results, what, typical, draw, said, title, shows):
    """The Figure of the rows of one kind, as reports/tradeoff/error_WHAT.png and .csv.

    typical(rows) gives the frame of the chart, draw(frame, path) writes it, said(frame, all rows) is the text below it;
    shows: what a person who cannot see it should know.
    """
    rows = results.bench("errors")
    frame = typical(rows[rows["what"] == what])
    if not len(frame):
        raise NotRun(f"bench/errors.csv has no rows of {what}", "lod", runnable=False)
    folder = results.reports / "tradeoff"
    folder.mkdir(parents=True, exist_ok=True)
    paths = [folder / f"error_{what}.{ending}" for ending in ("png", "csv")]
    with plot_style():
        draw(frame, paths[0])
    write_table(paths[1], frame)
    return Figure(title, shows, said(frame, rows), paths)
