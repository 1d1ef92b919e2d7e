"""The named sets of viewpoints."""

from stages.kit import Viewpoint

# T figure 3.2. Its caption repeats (b) as (k), while the text on the four principal views places (k) and (l) at the two
# ends of one axis. The only axis without another view is z, so (k) and (l) are taken as top and bottom.
TWELVE = tuple(
    Viewpoint(azimuth, elevation)
    for elevation, azimuths in (
        (0, (0, 90, 180, 270)),
        (45, (0, 120, 240)),
        (-45, (0, 120, 240)),
        (90, (0,)),
        (-90, (0,)),
    )
    for azimuth in azimuths
)
FOUR = TWELVE[:4]  # around the upright object
PRINCIPAL = (*TWELVE[1:4:2], *TWELVE[10:])  # the four principal views of T3.1.2, at +-y and +-z

VIEWPOINTS = {"twelve": TWELVE, "four": FOUR, "principal": PRINCIPAL}


def viewpoint_set(name: str) -> tuple[Viewpoint, ...]:
    """The viewpoints of a named set; ValueError for an unknown name."""
    if name not in VIEWPOINTS:
        raise ValueError(f"views.viewpoints={name!r} is not a set of viewpoints: choose one of {', '.join(VIEWPOINTS)}")
    return VIEWPOINTS[name]
