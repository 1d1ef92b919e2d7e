"""What `python -m stages.imprints MESH --at salient` shows, for the README."""

import numpy as np

from stages.imprints import Surface, distances, normalise, sensor_axes, sensor_normals, touchable
from stages.imprints.pictures import draw
from stages.report.items import Figure
from stages.report.style import plt, save

METHOD, TOUCHES = "enhanced", 6
CELLS, PITCH = (16, 16), 0.01  # as the command has them by default


def build(results):
    name = results.choose([results.settings.hero_object], 1)[0]
    mesh = results.mesh(name)
    points = results.points(name)[METHOD]
    points = points[touchable(mesh, points)][:TOUCHES]
    axes = sensor_axes(sensor_normals(mesh, points))
    raw = distances(Surface(mesh), points, CELLS, PITCH)
    figure = plt.figure(figsize=(12, 5.4))
    draw(figure, mesh, mesh.vertices[points], axes, normalise(raw, PITCH), np.ptp(raw, axis=(1, 2)), PITCH)
    path = save(figure, results.reports / "figures/touch_one_mesh.png", dpi=110)
    return Figure(
        "Touching one mesh",
        f"Left: {name}, with {len(points)} numbered places and the outline of the array at each. Right: the grey "
        "imprints of these places.",
        f"What `python -m stages.imprints MESH --at salient` shows of {name}: the {len(points)} places that draw the "
        f"eye most, and what an array of {CELLS[0]} x {CELLS[1]} cells, {PITCH:g} units apart, feels there.",
        [path],
    )
