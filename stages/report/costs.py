"""What it costs to find an object's salient points, from the picture to the points."""

from stages.salient_points import METHODS

from .results import NotRun


def looking_seconds(results):
    """dict method -> seconds of this run's median object: all views, the maps of the method's channels, the points."""
    return _seconds(*(results.measurements(stage) for stage in ("salient_points", "conspicuity", "views")))


def gaze_seconds(results):
    """As looking_seconds, of the meshes with human gaze."""
    return _seconds(*(results.attention(name) for name in ("gaze", "conspicuity", "views")))


def _seconds(points, channel, views):
    points = points.dropna(subset=["seconds"]).drop_duplicates(["object", "method", "seconds"])
    points = points.groupby("method")["seconds"].median()
    channel = channel.dropna(subset=["seconds"])
    channel = channel.groupby(["object", "method"])["seconds"].sum().groupby("method").median()
    views = views[views["metric"] == "coverage"].dropna(subset=["seconds"])
    views = views.groupby("object")["seconds"].sum().median()
    return {method: seconds + _sight(method, views, channel) for method, seconds in points.items()}


def _sight(method, views, channel):
    """Seconds of the pictures and maps that a method looks at; 0 for one that looks at nothing (blind touch)."""
    if method not in METHODS or not METHODS[method].channels:
        return 0.0
    missing = [name for name in METHODS[method].channels if name not in channel]
    if missing:
        raise NotRun(f"no seconds of the channels {', '.join(missing)}", "conspicuity")
    return views + sum(channel[name] for name in METHODS[method].channels)
