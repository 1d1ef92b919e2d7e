"""The two renderers draw the same picture, and the camera of OpenGL is the camera of the rays."""

import numpy as np
import pytest

from haptic_glance.look.camera import Viewpoint, pixels_per_unit
from haptic_glance.look.views import gl, render, renderer

SIZE = (300, 400)
FOOTPRINT = 1 / pixels_per_unit(SIZE[0])


@pytest.mark.slow
@pytest.mark.skipif(bool(gl.egl_error()), reason=f"no EGL context on this machine: {gl.egl_error()}")
@pytest.mark.parametrize("viewpoint", [Viewpoint(0, 0), Viewpoint(120, 45), Viewpoint(240, -45, 30), Viewpoint(0, 90)])
@pytest.mark.parametrize("name", ["sphere", "torus", "cube", "bowl", "coloured"])
def test_renderers_agree(shapes, name, viewpoint):
    rays, drawn = (render(shapes[name], viewpoint, SIZE, which) for which in ("raster", "pyrender"))
    on = rays.mask & drawn.mask
    assert on.sum() > 0.99 * (rays.mask | drawn.mask).sum()
    # On the pixels of an edge between a near and a far surface either may be right.
    assert (rays.face[on] == drawn.face[on]).mean() > 0.99
    same = on & (rays.face == drawn.face)
    assert np.abs(rays.depth[same] - drawn.depth[same]).max() < FOOTPRINT
    assert np.quantile(np.abs(rays.depth[on] - drawn.depth[on]), 0.999) < FOOTPRINT
    assert np.abs(rays.rgb[same].astype(int) - drawn.rgb[same]).max() <= 2
    assert np.abs(rays.rgb[on].astype(int) - drawn.rgb[on]).mean() < 0.5


def test_auto_without_egl_takes_the_rays_and_says_so_once(shapes, monkeypatch, capsys):
    monkeypatch.setattr(gl, "egl_error", lambda: "no libEGL")
    renderer._available.cache_clear()
    try:
        views = [render(shapes["cube"], Viewpoint(0, 0), (90, 120), "auto") for _ in range(2)]
    finally:
        renderer._available.cache_clear()
    assert all(view.mask.any() for view in views)
    assert capsys.readouterr().err.count("raster") == 1


def test_pyrender_without_egl_says_what_to_install(shapes, monkeypatch):
    monkeypatch.setattr(gl, "egl_error", lambda: "no libEGL")
    with pytest.raises(OSError, match="libegl1"):
        render(shapes["cube"], Viewpoint(0, 0), (90, 120), "pyrender")
