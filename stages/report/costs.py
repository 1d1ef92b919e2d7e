"""What it costs to find an object's salient points, from the picture to the points."""

from stages.salient_points import METHODS

from .results import NotRun


def looking_seconds(results):
    """dict method -> seconds of the median object: all its views, the maps of the method's channels, the points."""
    points = results.measurements("salient_points").dropna(subset=["seconds"])
    points = points.drop_duplicates(["object", "method", "seconds"]).groupby("method")["seconds"].median()
    channel = results.measurements("conspicuity").dropna(subset=["seconds"])
    channel = channel.groupby(["object", "method"])["seconds"].sum().groupby("method").median()
    views = results.measurements("views").dropna(subset=["seconds"]).groupby("object")["seconds"].sum().median()
    return {method: seconds + _sight(method, views, channel) for method, seconds in points.items()}


def _sight(method, views, channel):
    """Seconds of the pictures and maps that a method looks at; 0 for one that looks at nothing (blind touch)."""
    if method not in METHODS or not METHODS[method].channels:
        return 0.0
    missing = [name for name in METHODS[method].channels if name not in channel]
    if missing:
        raise NotRun(f"no seconds of the channels {', '.join(missing)}", "conspicuity")
    return views + sum(channel[name] for name in METHODS[method].channels)
