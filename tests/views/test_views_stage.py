"""The stage on two meshes: files, measurements, and the same bytes whatever the number of workers."""

import shutil

import pandas as pd
import pytest

from haptic_glance.base.files import read_json, write_mesh
from haptic_glance.look.views import FOUR, Material, render
from haptic_glance.look.views.view import LAMBERT
from stages.engine.rows import read_rows
from stages.engine.settings import ParamsError
from stages.views import __main__ as stage
from stages.views.storage import read_view

SECTION = {"viewpoints": "four", "size": [90, 120], "renderer": "raster", "background": "black",
           "compare_sets": True}  # fmt: skip


@pytest.fixture
def workspace(shapes, make_workspace):
    workspace = make_workspace({"views": SECTION})
    for name in ("torus", "cube"):
        write_mesh(workspace.data / "meshes" / f"{name}.npz", shapes[name])
    return workspace


@pytest.mark.slow
def test_stage_writes_every_view_and_its_measurement_the_same_for_any_workers_and_one_mesh_more_costs_one_mesh(
    workspace, shapes, make_workspace, monkeypatch, capsys
):
    stored = []
    for parallel in ({"backend": "loky", "workers": 2}, {"backend": "sequential"}):
        shutil.rmtree(workspace.build, ignore_errors=True)
        stage.run(make_workspace({"views": SECTION}, parallel=parallel))
        assert capsys.readouterr().out.startswith("views: 2 objects, 8 views by raster")
        files = sorted((workspace.data / "views").rglob("*.*"))
        stored.append({str(path.relative_to(workspace.root)): path.read_bytes() for path in files})
    assert stored[0] == stored[1]
    assert len(stored[0]) == 2 * 4 + 1
    table = pd.read_csv(workspace.data / "views" / "viewpoints.csv")
    assert list(table.viewpoint) == [viewpoint.name for viewpoint in FOUR]
    rows = read_rows(workspace.measurements / "views.csv.gz")
    assert set(rows.metric) == {"coverage", "seen_share", "fewest_views"} and (rows.seconds > 0).all()
    rows = rows[rows.metric == "coverage"]
    view = read_view(workspace.data / "views" / "cube" / f"{FOUR[1].name}.npz")
    share = rows[(rows.item == "cube") & (rows.viewpoint == FOUR[1].name)].value.item()
    assert view.mask.mean() == pytest.approx(share, rel=1e-5)
    metrics = read_json(workspace.metrics / "views.json")
    assert metrics["views"] == 8 and metrics["coverage"] == pytest.approx(rows.value.mean(), abs=1e-6)

    rendered, render_view = [], stage.render
    monkeypatch.setattr(stage, "render", lambda *args: rendered.append(args) or render_view(*args))
    write_mesh(workspace.data / "meshes" / "bowl.npz", shapes["bowl"])
    stage.run(workspace)
    assert len(rendered) == 4
    assert set(read_rows(workspace.measurements / "views.csv.gz").item) == {"bowl", "cube", "torus"}


def test_the_material_of_the_settings_is_drawn_and_one_out_of_range_is_named(workspace, shapes, make_workspace):
    shiny = {"ambient": 0.1, "diffuse": 0.5, "specular": 0.4, "shininess": 20.0}
    stage.run(make_workspace({"views": SECTION | {"compare_sets": False, "material": shiny}}))
    stored = read_view(workspace.data / "views" / "torus" / f"{FOUR[0].name}.npz")
    drawn = [
        render(shapes["torus"], FOUR[0], (90, 120), "raster", material=material)
        for material in (Material(**shiny), LAMBERT)
    ]
    assert (stored.rgb == drawn[0].rgb).all() and (stored.rgb != drawn[1].rgb).any()
    assert set(read_rows(workspace.measurements / "views.csv.gz").metric) == {"coverage"}  # sets are not compared
    assert "fewest_views" not in read_json(workspace.metrics / "views.json")
    with pytest.raises(ParamsError, match="views: specular=4.0 of a material must be between 0 and 1"):
        stage.run(make_workspace({"views": SECTION | {"material": shiny | {"specular": 4.0}}}))
