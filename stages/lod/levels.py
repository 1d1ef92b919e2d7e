"""Files of simplified meshes, data/SET/lod/NAME/METHOD_TARGET.npz."""

from haptic_glance.base.files import files_below, read_mesh
from haptic_glance.mesh.mesh import Mesh
from stages.charts.results import Results, require_rows


def levels_of(results: Results, name: str, method: str) -> list[tuple[str, Mesh]]:
    """The simplified meshes of an object by one method, most faces first: list of (target, mesh); NotRun for none."""
    paths = [path for path in files_below(results.folder("lod") / name) if path.match(f"{method}_*.npz")]
    message = f"lod/{name} has no mesh by {method}: lod.methods lacks the method, or it reached no face count"
    require_rows(paths, message, "lod", runnable=False)
    levels = [(path.stem.removeprefix(f"{method}_").replace("pct", "%"), read_mesh(path)) for path in paths]
    return sorted(levels, key=lambda level: (-len(level[1].faces), level[0]))
