"""What it costs to find an object's salient points, from the picture to the points."""

import pandas as pd

from haptic_glance.look.points import METHODS

from .results import NotRun, Results


def attention_seconds(results: Results, dataset: str | None = None) -> dict[str, float]:
    """dict method -> seconds of the median object of a set: all views, the maps of its channels, and the points."""
    stages = ("salient_points", "conspicuity", "views")
    points, channels, views = (results.rows(stage, dataset).dropna(subset=["seconds"]) for stage in stages)
    points = points.drop_duplicates(["item", "method", "seconds"]).groupby("method")["seconds"].median()
    channels = channels.groupby(["item", "method"])["seconds"].sum().groupby("method").median()
    views = views[views["metric"] == "coverage"].groupby("item")["seconds"].sum().median()
    return {str(method): seconds + _maps(str(method), views, channels) for method, seconds in points.items()}


def _maps(method: str, views: float, channels: pd.Series) -> float:
    """Seconds of the pictures and maps that a method reads; 0 for one that reads none (blind touch)."""
    read = METHODS[method].channels if method in METHODS else ()
    missing = [name for name in read if name not in channels]
    if missing:
        raise NotRun(f"no seconds of the channels {', '.join(missing)}", "conspicuity")
    return views + sum(channels[name] for name in read) if read else 0.0
