"""The named sets of viewpoints."""

from stages.kit import Viewpoint

# T figure 3.2. Its caption repeats (b) as (k), while the text on the four principal views sets (k) and (l) on the two
# sides of one axis. The one axis that no other view looks along is z, so (k) and (l) are read as top and bottom.
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
FOUR = TWELVE[:4]  # all round the upright object; the thesis's own four principal views (T3.1.2) stand on +-z and +-y

VIEWPOINTS = {"twelve": TWELVE, "four": FOUR}


def viewpoint_set(name):
    """The tuple of viewpoints that a set's name stands for; ValueError for an unknown name."""
    if name not in VIEWPOINTS:
        raise ValueError(f"views.viewpoints={name!r} is no set of viewpoints: choose one of {', '.join(VIEWPOINTS)}")
    return VIEWPOINTS[name]
