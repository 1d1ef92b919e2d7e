"""Meshes, views, imprints and runs that several folders test with."""

import gc
import shutil
from importlib import import_module

import numpy as np
import pytest
import trimesh
from omegaconf import OmegaConf

from haptic_glance.base.files import write_table, write_text
from haptic_glance.look import camera
from haptic_glance.look.channels import ViewMaps
from haptic_glance.look.channels.channels import CHANNELS as NINE
from haptic_glance.look.channels.channels import OTHERS
from haptic_glance.look.views import TWELVE, gl
from haptic_glance.mesh.mesh import Mesh
from haptic_glance.mesh.rays import RayScene
from stages.engine import run
from stages.engine.settings import Workspace

BROWSERS = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "microsoft-edge")
SOFTWARE_GL = ("--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader")  # WebGL without a card
SIZE = (75, 100)
CHANNELS = (*NINE, *OTHERS)


@pytest.hookimpl(wrapper=True)
def pytest_collection():
    """Keeps the garbage collector to the objects of tests: a pass over the modules of all tests takes a second."""
    gc.disable()
    result = yield
    gc.freeze()
    gc.enable()
    return result


def pytest_ignore_collect(collection_path, config):
    """`-m "not slow"` does not import a file whose tests are all slow: some files import packages for a second."""
    is_file = collection_path.suffix == ".py" and config.option.markexpr == "not slow"
    return is_file and "\npytestmark = pytest.mark.slow\n" in collection_path.read_text("utf-8") or None


def spot_maps(mesh, spot, viewpoints=TWELVE, width=0.15, channels=CHANNELS):
    """dict channel -> (v, h, w): a Gaussian round a place in space, zero off the object."""
    scene, maps = RayScene(mesh), []
    rows, columns = np.mgrid[: SIZE[0], : SIZE[1]].reshape(2, -1)
    for viewpoint in viewpoints:
        origins, directions = camera.pixel_rays(rows, columns, viewpoint, SIZE)
        hits = scene.cast(origins, directions)
        place = origins + np.where(hits.hit, hits.distance, 0)[:, None] * directions
        values = np.exp(-((place - spot) ** 2).sum(axis=1) / (2 * width**2))
        maps.append(np.where(hits.hit, values, 0).reshape(SIZE))
    return dict.fromkeys(channels, np.stack(maps))


@pytest.fixture(scope="session")
def make_maps():
    """The function spot_maps; its images have 75 x 100 pixels."""
    return spot_maps


@pytest.fixture(scope="session")
def ball():
    mesh = trimesh.creation.icosphere(subdivisions=4, radius=0.5)
    return Mesh(mesh.vertices, mesh.faces)


@pytest.fixture(scope="session")
def spot():
    return np.array([0.3, 0.3, 0.26458])  # on the ball, on no axis of a view


@pytest.fixture(scope="session")
def sight(ball, spot):
    return ViewMaps(ball, TWELVE, spot_maps(ball, spot))


@pytest.fixture(scope="session", autouse=True)
def code_of_stages_by_name():
    """The name of a stage stands for the digest of its code, which takes seconds; tests of the digest use their own."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(run, "stage_digest", str)
        yield


@pytest.fixture
def make_workspace(tmp_path):
    """A function from sections of settings to the Workspace of a small run below tmp_path; its stages run in turn."""

    def make(sections, dataset="toys", seed=0, **shared):
        values = {"seed": seed, "profile": "test", "parallel": {"backend": "sequential"}, "sets": [dataset]}
        values |= {"graph": {stage: [dataset] for stage in sections}, dataset: sections} | shared
        write_text(tmp_path / "params.yaml", OmegaConf.to_yaml(OmegaConf.create(values)))
        return Workspace(tmp_path, dataset)

    return make


@pytest.fixture(scope="session")
def shapes():
    """Name -> Mesh: smooth, sharp, hollow, open and coloured."""
    sphere = trimesh.creation.icosphere(subdivisions=4, radius=0.5)
    torus = trimesh.creation.torus(0.3, 0.15, major_sections=64, minor_sections=32)
    cube = trimesh.creation.box(extents=[0.5, 0.5, 0.5])
    lower = sphere.faces[sphere.triangles_center[:, 2] < 0]
    return {
        "sphere": Mesh(sphere.vertices, sphere.faces),
        "torus": Mesh(torus.vertices, torus.faces),
        "cube": Mesh(cube.vertices, cube.faces),
        "bowl": Mesh(sphere.vertices, lower),
        "coloured": Mesh(torus.vertices, torus.faces, np.clip((torus.vertices + 0.5) * 255, 0, 255).astype(np.uint8)),
    }


@pytest.fixture(params=["raster", "pyrender"])
def renderer(request):
    """Each renderer that can run here."""
    if request.param == "pyrender" and gl.egl_error():
        pytest.skip(f"no EGL context on this machine: {gl.egl_error()}")
    return request.param


@pytest.fixture(scope="module")
def browser_program():
    program = next((path for path in map(shutil.which, BROWSERS) if path), None)
    if not program:
        pytest.skip(f"no browser is installed: one of {', '.join(BROWSERS)}")
    return program


@pytest.fixture(scope="module")
def driver():
    playwright = pytest.importorskip("playwright.sync_api", reason="pip install playwright: it drives the browser")
    with playwright.sync_playwright() as context:
        yield context


@pytest.fixture(scope="module")
def browser(driver, browser_program):
    opened = driver.chromium.launch(executable_path=browser_program, args=SOFTWARE_GL)
    yield opened
    opened.close()


@pytest.fixture
def tab(browser):
    """A page of the browser that fails the test where a script does."""
    opened, faults = browser.new_page(viewport={"width": 1280, "height": 800}), []
    opened.on("pageerror", lambda error: faults.append(str(error)))
    yield opened
    opened.close()
    assert not faults


@pytest.fixture(scope="module", autouse=True)
def few_pixels_and_resamples(request):
    """Most of the time of a report goes to the pixels of its pictures and to the resamples of its intervals."""
    if not request.path.stem.endswith("_report") and request.path.parent.name not in ("report", "charts"):
        yield
        return
    from stages.charts import items
    from stages.charts.drawing import save
    from stages.engine import statistics

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(items, "save", lambda figure, path, dpi: save(figure, path, dpi // 3))
        patch.setattr(statistics, "RESAMPLES", 400)
        yield


@pytest.fixture(scope="session")
def small():
    """The module tests.small_report; tests of the library do without its imports."""
    return import_module("tests.small_report")


@pytest.fixture(scope="session")
def measure(tmp_path_factory):
    """A function that writes the rows of a stage, on one set or on those of their column, and returns the results.

    stage: or `bench/NAME`, of a benchmark. results: of the root to write below; else a new one with nothing measured.
    """

    small = import_module("tests.small_report")  # some folders have a fixture `small` of their own

    def written(stage, frame, dataset=None, results=None):
        root = results.workspace.root if results else small.make_bare(tmp_path_factory.mktemp("measured"))
        if stage.startswith("bench/"):
            write_table(root / f"reports/{stage}.csv", frame)
        else:
            small.write_measurements(root, stage, frame, dataset)
        return small.read_results(root)

    return written


@pytest.fixture(scope="session")
def measured(measure):
    """As `measure`, but returns the Measurements that claims are judged by."""
    from stages.engine.measurements import Measurements

    return lambda *arguments: Measurements(measure(*arguments).reports)


@pytest.fixture(scope="session")
def empty(tmp_path_factory, small):
    """The results of a root with nothing measured, which no test changes."""
    return small.read_results(small.make_bare(tmp_path_factory.mktemp("empty")))


@pytest.fixture(scope="session")
def seen(tmp_path_factory, small):
    """The results of the small run with everything about attention; tests that change its files copy them."""
    root = small.make_root(tmp_path_factory.mktemp("seen"))
    small.write_attention(root)
    return small.read_results(root)


@pytest.fixture
def bare(tmp_path, small):
    """A root with nothing measured."""
    return small.make_bare(tmp_path)


@pytest.fixture
def root(tmp_path, small):
    """The root of a small run."""
    return small.make_root(tmp_path)


@pytest.fixture
def results(root, small):
    """The results of the small run."""
    return small.read_results(root)


@pytest.fixture
def bumps():
    """A function: {object: (count, 16, 16)}, a bump at the place of each object, give or take `jitter` cells."""

    def make(names=("cup", "duck", "hand"), count=16, jitter=0.3):
        random = np.random.default_rng(0)
        row, column = np.mgrid[:16, :16][..., None]
        images = {}
        for k, name in enumerate(names):
            down, along = jitter * random.normal(size=(2, count))
            bump = np.exp(-((row - 2 - 4 * k - down) ** 2 + (column - 12 + 3 * k - along) ** 2) / (6.0 + 6 * k))
            images[name] = bump.transpose(2, 0, 1)
        return images

    return make
