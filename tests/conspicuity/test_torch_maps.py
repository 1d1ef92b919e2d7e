"""The maps on tensors are OpenCV's: every step of them, and all nine together, for views of different crops."""

import dataclasses
import functools
import subprocess
import sys
from pathlib import Path

import cv2
import numpy as np
import pytest
import torch
import trimesh

from stages.conspicuity import CHANNELS, background, channels, conspicuity, cropped_view, operators
from stages.conspicuity.batch import conspicuity_batch, maps, peaks, pixels, resize, stack
from stages.conspicuity.batch.grid import Grid
from stages.conspicuity.entropy import local_entropy
from stages.kit import Mesh
from stages.kit.files import read_mesh
from stages.views import View, Viewpoint, render

MESHES = Path(__file__).parents[2] / "data/household/meshes"
VIEWPOINTS = (Viewpoint(20, 10), Viewpoint(130, -50), Viewpoint(0, 90))
CLOSE = 1e-3

no_cuda = pytest.mark.skipif(not torch.cuda.is_available(), reason="torch finds no CUDA device here")
on_each_device = pytest.mark.parametrize("device", ["cpu", pytest.param("cuda", marks=no_cuda)])


@pytest.fixture(autouse=True)
def one_core():
    threads = torch.get_num_threads()
    torch.set_num_threads(1)
    yield
    torch.set_num_threads(threads)


@pytest.fixture
def at_once(monkeypatch):
    """All views of a call in one stack, on the CPU too."""
    monkeypatch.setattr(maps, "BATCH", {"cpu": 99, "cuda": 99})


@functools.cache
def bumpy(kind="grey"):
    """A lopsided blob; `colour`: smoothly painted; `noise`: a colour of its own at each vertex."""
    ball = trimesh.creation.icosphere(subdivisions=4)
    v = ball.vertices.copy()
    for direction, height, width in (((1, 0.2, 0), 1.2, 0.3), ((-0.3, 1, 0.5), 0.7, 0.2), ((0.1, -0.4, -1), 0.9, 0.5)):
        towards = np.array(direction) / np.linalg.norm(direction)
        v *= 1 + height * np.exp(-(1 - v @ towards / np.linalg.norm(v, axis=1)) / width**2)[:, None]
    v -= (v.max(axis=0) + v.min(axis=0)) / 2
    v /= 2 * np.linalg.norm(v, axis=1).max()
    painted = (127 + 120 * np.sin(v * [9, 14, 21] + [0, 1, 2])).astype(np.uint8)
    noise = np.random.default_rng(0).integers(0, 256, v.shape).astype(np.uint8)
    return Mesh(v, ball.faces, {"grey": None, "colour": painted, "noise": noise}[kind])


def looks(mesh, size=(300, 400), viewpoints=VIEWPOINTS):
    return [render(mesh, viewpoint, size, "raster") for viewpoint in viewpoints]


def check(mesh, views, size=None, device="cpu"):
    found = conspicuity_batch(mesh, views, size=size, device=device)
    assert list(found) == list(CHANNELS)
    for k, view in enumerate(views):
        for channel, values in conspicuity(mesh, view, size=size).items():
            assert found[channel].dtype == np.float32 and found[channel][k].shape == values.shape
            assert np.abs(found[channel][k] - values).max() < CLOSE, (channel, k)
    return found


@pytest.mark.slow
@on_each_device
@pytest.mark.parametrize("kind", ["grey", "colour", "noise"])
def test_the_nine_maps_are_those_of_opencv(at_once, kind, device):
    found = check(bumpy(kind), looks(bumpy(kind)), device=device)
    for channel in set(CHANNELS) - {"symmetry"} - ({"color"} if kind == "grey" else set()):
        assert found[channel].max() > 1e-3, channel


@on_each_device
@pytest.mark.parametrize("name", ["elephant", "cup", "airplane", "cubesmall", "eyeglasses"])
def test_the_maps_of_real_objects_are_those_of_opencv(at_once, name, device):
    if not (MESHES / f"{name}.npz").exists():
        pytest.skip("data/household/meshes is not here: `dvc repro meshes@household` makes it")
    mesh = read_mesh(MESHES / f"{name}.npz")
    check(mesh, looks(mesh), device=device)


@pytest.mark.slow
@on_each_device
@pytest.mark.parametrize(
    ("shape", "size"), [((301, 397), (61, 83)), ((97, 130), None), ((33, 44), (5, 9)), ((3, 5), None)]
)
def test_odd_sizes_are_no_matter(at_once, shape, size, device):
    check(bumpy("colour"), looks(bumpy("colour"), shape), size, device)


@pytest.mark.slow
@on_each_device
def test_empty_tiny_and_uniform_views_and_colour_beside_grey(at_once, device):
    mesh = bumpy()
    view = looks(mesh)[0]
    tiny = np.zeros_like(view.mask)
    tiny[100:103, 380:384] = view.mask[150, 200]
    rng = np.random.default_rng(1)
    views = [
        view,
        dataclasses.replace(view, face=np.full_like(view.face, -1), depth=np.full_like(view.depth, np.inf)),
        dataclasses.replace(view, face=np.where(tiny, 0, -1).astype(np.int32), depth=np.full_like(view.depth, 10)),
        dataclasses.replace(view, rgb=np.full_like(view.rgb, 127)),
        dataclasses.replace(view, rgb=rng.integers(0, 256, view.rgb.shape).astype(np.uint8)),
        dataclasses.replace(view, rgb=np.where(view.rgb > 120, np.uint8(255), np.uint8(0))),
    ]
    found = check(mesh, views, device=device)
    assert not any(values[1].any() for values in found.values())
    assert not conspicuity_batch(mesh, views[1:2], device=device)["edge"].any()


@pytest.mark.slow
@on_each_device
def test_how_many_views_go_together_does_not_matter(monkeypatch, device):
    mesh, views = bumpy("colour"), looks(bumpy("colour"), (150, 200))
    results = []
    for many in (1, 2, 99):
        monkeypatch.setattr(maps, "BATCH", {"cpu": many, "cuda": many})
        results.append(conspicuity_batch(mesh, views, device=device))
    for other in results[1:]:
        for channel in CHANNELS:
            np.testing.assert_allclose(results[0][channel], other[channel], atol=1e-5)


@pytest.mark.slow
def test_channels_come_in_the_order_asked_for_and_alone_as_together():
    mesh, views = bumpy("colour"), looks(bumpy("colour"), (150, 200))
    together = conspicuity_batch(mesh, views)
    for names in (["symmetry", "dkl"], ["contrast"], ["orientation"], []):
        some = conspicuity_batch(mesh, views, names)
        assert list(some) == names
        for name in names:
            np.testing.assert_allclose(some[name], together[name], atol=1e-6)


@on_each_device
def test_symmetry_agrees_where_planes_come_and_go_with_the_view(at_once, device):
    cone = trimesh.creation.revolve([[0, -0.4], [0.3, -0.4], [0.15, 0], [0, 0.4]], sections=48)
    mesh = Mesh(cone.vertices, cone.faces)
    views = looks(mesh, (150, 200), (Viewpoint(0, 90), Viewpoint(30, 60), Viewpoint(0, 0)))
    found = conspicuity_batch(mesh, views, ["symmetry"], device=device)["symmetry"]
    for values, view in zip(found, views, strict=True):
        np.testing.assert_allclose(values, conspicuity(mesh, view, ["symmetry"])["symmetry"], atol=CLOSE)
    assert found[0].max() > 0.5 and found[2].max() > 0.05


@on_each_device
def test_pyramids_are_opencvs_for_every_image_of_a_stack(device):
    sizes = [(57, 75), (40, 80), (1, 7), (9, 1), (2, 3), (1, 1), (64, 2)]
    rng = np.random.default_rng(0)
    images = [rng.random(size, dtype=np.float32) for size in sizes]
    grid = Grid(sizes, device)
    stacked = torch.full((len(sizes), 1, *grid.shape(0)), 9.0)  # what lies beyond an image must not matter
    for k, image in enumerate(images):
        stacked[k, 0, : image.shape[0], : image.shape[1]] = torch.from_numpy(image)
    lower = grid.down(stacked.to(device), 0)
    upper = grid.up(lower, 1)
    for k, image in enumerate(images):
        expected = operators.down(image)
        h, w = expected.shape
        np.testing.assert_allclose(lower[k, 0, :h, :w].cpu(), expected, atol=1e-6)
        back = cv2.pyrUp(expected, dstsize=image.shape[::-1])
        np.testing.assert_allclose(upper[k, 0, : image.shape[0], : image.shape[1]].cpu(), back, atol=1e-6)


@on_each_device
def test_filling_and_cores_are_opencvs(device):
    rng = np.random.default_rng(2)
    known = cv2.GaussianBlur(rng.random((70, 90), dtype=np.float32), (0, 0), 4) > 0.5
    image = rng.random((70, 90), dtype=np.float32)
    grid = Grid([(70, 90), (100, 60)], device)
    planes, masks = (np.zeros((2, 1, 100, 90), dtype) for dtype in (np.float32, bool))
    planes[0, 0, :70], masks[0, 0, :70] = image, known
    filled = grid.fill(torch.from_numpy(planes).to(device), torch.from_numpy(masks).to(device)).cpu()
    np.testing.assert_allclose(filled[0, 0, :70], background.fill(image, known), atol=1e-5)
    assert not filled[1].any()
    for rim in (1, 3):
        mine = stack.core(torch.from_numpy(known)[None, None].to(device), rim)[0, 0].cpu()
        np.testing.assert_array_equal(mine, cropped_view.core(known, rim))


def spiral(side=41):
    """(side, side) boolean: one region whose ends are a long way apart."""
    image = np.zeros((side, side), dtype=bool)
    for ring in range(0, side // 2, 2):
        image[ring, ring : side - ring] = image[side - 1 - ring, ring : side - ring] = True
        image[ring : side - ring, ring] = image[ring : side - ring, side - 1 - ring] = True
        image[ring + 1, ring] = False
        image[ring + 2 : ring + 3, ring : ring + 3] = True
    return image


@on_each_device
@pytest.mark.parametrize("name", ["spiral", "sparse", "dense", "rings", "all", "none"])
def test_every_region_is_counted_once(name, device):
    y, x = np.mgrid[:41, :41] - 20
    rng = np.random.default_rng(3)
    tops = {
        "spiral": spiral(),
        "sparse": rng.random((41, 41)) < 0.1,
        "dense": rng.random((41, 41)) < 0.4,
        "rings": np.maximum(abs(x), abs(y)) % 4 == 0,
        "all": np.ones((41, 41), dtype=bool),
        "none": np.zeros((41, 41), dtype=bool),
    }[name]
    count, labels = cv2.connectedComponents(tops.astype(np.uint8), connectivity=8)
    ones = peaks.one_per_plateau(torch.from_numpy(tops)[None, None].to(device))[0, 0].cpu().numpy()
    assert ones.sum() == count - 1 and sorted(labels[ones]) == list(range(1, count))


@on_each_device
def test_n_is_opencvs_with_plateaus_ties_and_flat_maps(device):
    rng = np.random.default_rng(4)
    levels = [rng.random((30, 40)), rng.integers(0, 4, (30, 40)), rng.integers(0, 2, (30, 40)), np.full((30, 40), 0.3)]
    values = np.stack(levels).astype(np.float32)[None]
    cover = cv2.GaussianBlur(rng.random((30, 40), dtype=np.float32), (0, 0), 3) > 0.48
    for here in (cover, np.ones_like(cover), np.zeros_like(cover)):
        masks = torch.from_numpy(here)[None, None].to(device)
        floors = torch.full((4,), operators.FLOOR, device=device)
        found = peaks.normalise(torch.from_numpy(values).to(device), masks, floors)[0].cpu()
        for ours, plane in zip(found, values[0], strict=True):
            np.testing.assert_allclose(ours, operators.normalise(plane, here), atol=1e-6)


@on_each_device
def test_median_luminance_and_entropy_are_opencvs(device):
    rng = np.random.default_rng(5)
    rgb = rng.integers(0, 256, (60, 80, 3)).astype(np.uint8)
    full = View(rgb, np.full((60, 80), 10, np.float32), np.zeros((60, 80), np.int32), Viewpoint(0, 0))
    luminance = stack.Stack([full], device).luminance
    expected = cropped_view.cropped_view(full).luminance
    np.testing.assert_array_equal(luminance[0, 0].cpu(), expected)
    framed = torch.nn.functional.pad(luminance, (1, 1, 1, 1), mode="replicate")
    np.testing.assert_array_equal(pixels._median(framed)[0, 0].cpu(), cv2.medianBlur(expected, 3))
    few, counted = (expected // 40).astype(np.uint8), rng.random((60, 80)) < 0.7
    rows, columns = (axis.ravel() for axis in np.mgrid[4:56:5, 4:76:5])
    levels = np.where(counted, few.astype(np.int16), -1)
    windows = np.stack([levels[r - 4 : r + 5, c - 4 : c + 5].ravel() for r, c in zip(rows, columns, strict=True)])
    found = pixels._entropies(torch.from_numpy(windows).to(device)).cpu()
    np.testing.assert_allclose(found, local_entropy(few, counted, rows, columns), atol=1e-6)


@on_each_device
@pytest.mark.parametrize("size", [(75, 100), (60, 83), (301, 400), (4, 5)])
def test_maps_reach_their_size_as_in_opencv(size, device):
    views = looks(bumpy(), (301, 397), VIEWPOINTS[:2])
    crops = stack.Stack(views, device)
    values = np.random.default_rng(6).random((2, 1, *crops.grid.shape(4)), dtype=np.float32)
    values *= crops.grid.within(4).cpu().numpy()
    found = resize.resize_maps(crops, torch.from_numpy(values).to(device), size).cpu()
    for k, view in enumerate(views):
        h, w = crops.grid.sizes_at(4)[k]
        whole = cropped_view.cropped_view(view).place_in_view(values[k, 0, :h, :w], 4)
        np.testing.assert_allclose(found[k, 0], channels.resize_map(whole, view.mask.shape, size), atol=1e-4)


def test_what_cannot_be_done_is_named():
    mesh, views = bumpy(), looks(bumpy(), (60, 80))
    with pytest.raises(ValueError, match="colour"):
        conspicuity_batch(mesh, views, ["colour"])
    with pytest.raises(ValueError, match="fine_grained"):
        conspicuity_batch(mesh, views, ["fine_grained"])
    with pytest.raises(ValueError, match="size of the maps"):
        conspicuity_batch(mesh, views, size=(0, 10))
    with pytest.raises(ValueError, match="no views"):
        conspicuity_batch(mesh, [])
    with pytest.raises(ValueError, match="different image sizes"):
        conspicuity_batch(mesh, [*views, *looks(mesh, (90, 120))])
    with pytest.raises(ValueError, match="render this mesh again"):
        conspicuity_batch(Mesh(mesh.vertices, mesh.faces[:5]), views)
    with pytest.raises(ValueError, match="uint8"):
        conspicuity_batch(mesh, [dataclasses.replace(views[0], rgb=views[0].rgb / 255)])
    with pytest.raises(ValueError, match="cpu or cuda"):
        conspicuity_batch(mesh, views, device="meta")


@pytest.mark.skipif(torch.cuda.is_available(), reason="this machine has the device")
def test_a_missing_gpu_is_named():
    with pytest.raises(ValueError, match="no CUDA device"):
        conspicuity_batch(bumpy(), looks(bumpy(), (60, 80)), device="cuda")


@pytest.mark.slow
def test_the_nine_channels_alone_do_not_load_torch():
    code = "import sys, stages.conspicuity; sys.exit('torch' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], cwd=Path(__file__).parents[2]).returncode == 0
