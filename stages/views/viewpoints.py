"""The named sets of viewpoints."""

from stages.kit import Viewpoint

# T figure 3.2. Its caption says of (k) `90 degrees around z`, which is (b) again, and of (l) `180 degrees around x`,
# which is (c) upside down. The text (T3.1.2) has cameras at +-y and +-z in (a), (b), (k) and (l), but turns about z
# reach no place at z. No reading fits both. Turns of (k) and (l) about x by 90 and -90 degrees give the two places at z
# that the text asks for: top and bottom. The other ten are as printed.
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
