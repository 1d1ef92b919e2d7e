"""Face counts as people write them: absolute or as a share of the object's own."""

import re


def face_count(target: str | int, total: int, name: str = "lod.targets") -> int:
    """The face count of a `target` ("25%", "1500") for a mesh of `total` faces.

    Raises ValueError, which names the setting, for anything else, shares outside 0 to 100 %, and counts below 1.
    """
    match = re.fullmatch(r"(\d+(?:\.\d+)?)(%?)", str(target).strip())
    if match is None:
        raise ValueError(f"{name}={target!r} is not a face count: write one like 1500 or 25%")
    number = float(match[1])
    if match[2] and not 0 < number < 100:
        raise ValueError(f"{name}={target!r} must lie between 0% and 100%")
    count = int(total * number / 100) if match[2] else int(number)
    if count < 1 and not match[2]:
        raise ValueError(f"{name}={target!r} must be 1 or more")
    return max(count, 1)


def file_name(method: str, target: str) -> str:
    """The name of a mesh's file, for example `glance_25pct.npz`."""
    return f"{method}_{str(target).strip().replace('%', 'pct')}.npz"
