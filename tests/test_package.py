"""The package that people install: light where they have a mesh of their own, whole where they run the pipeline."""

import ast
import os
import re
import signal
import subprocess
import sys
import tomllib
import zipfile
from importlib.metadata import packages_distributions
from pathlib import Path

import pytest

import haptic_glance
from haptic_glance import __main__ as command
from haptic_glance.base.extras import EXTRAS, MODULES, MissingExtra, from_extra
from stages.engine.settings import conf_folder

ROOT = Path(__file__).parents[1]
OURS = sys.stdlib_module_names | {"stages", "haptic_glance"}
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
BROUGHT = {"omegaconf": "hydra-core", "yaml": "hydra-core"}  # by a package that we list


def without(modules):
    """Code after which none of the modules can be imported."""
    return f"""
import sys
from importlib.machinery import PathFinder

class Rest(PathFinder):
    @classmethod
    def find_spec(cls, name, path=None, target=None):
        return None if name.partition(".")[0] in {sorted(modules)} else super().find_spec(name, path, target)

sys.meta_path[:] = [Rest if finder is PathFinder else finder for finder in sys.meta_path]
"""


CORE = without(EXTRAS)  # what a core install is: none of the modules that the extras bring
SIX = """
import numpy as np
from haptic_glance import Camera, Placed, Scene, budget, find_points, follow, load, normalise, press, saliency, simplify
from haptic_glance.know import learn, primitives, stand, touch_until_known

mesh = load(sys.argv[1])
assert saliency(mesh).shape == (len(mesh.vertices),)
points = find_points(mesh, count=5)
assert len(points) == 5
assert len(simplify(mesh, 200, keep=points[:2]).faces) <= 200
assert press(mesh, points[0]).shape == (16, 16)
plane = np.stack([mesh.vertices.mean(axis=0), *mesh.vertices[points[:2]]])
assert len(follow(mesh, plane, frames=4).images) == 4
cameras = tuple(Camera((-far, 0.0, 0.5), (0.0, 0.0, 0.5), 40.0, (60, 80)) for far in (2.0, 4.0))
scene = Scene((Placed("one", (0.0, 0.0, 0.0), 0.0, 1.0),), cameras, tolerance=1.0, kind="pixels")
assert budget({"one": mesh}, scene).faces.max() <= len(mesh.faces)
known = learn(primitives() | {"mine": normalise(mesh)})
*_, last = touch_until_known(known.belief(), stand(normalise(mesh), turn=30))
assert last.belief.known == "mine"
"""


def python(code, *arguments, **options):
    """The finished process of a fresh interpreter that runs the code in the repository's root."""
    options = {"cwd": ROOT, "capture_output": True, "text": True} | options
    return subprocess.run([sys.executable, "-c", code, *map(str, arguments)], **options)


def run_command(*arguments, before="", **options):
    options = {"env": os.environ | {"PYTHONPATH": str(ROOT)}} | options
    return python(f"{before}\nfrom haptic_glance.__main__ import main\nmain()", *arguments, **options)


RULE = "=========\n"


def run_all(*lines):
    """The finished process that runs these commands in turn in a core install, with a RULE between what they print."""
    code = f"""{CORE}
from haptic_glance.__main__ import run
for number, (name, *given) in enumerate({[[*map(str, line)] for line in lines]!r}):
    for stream in (sys.stdout, sys.stderr):
        print({RULE!r} if number else "", end="", file=stream, flush=True)
    try:
        run(name, given)
    except SystemExit as ended:
        assert not ended.code
"""
    return python(code)


def distributions(requirements):
    """Their names as packages_distributions() has them, in lower case with dashes."""
    return {normalised(re.split(r"[^\w.-]", text)[0]) for text in requirements}


def normalised(name):
    return re.sub(r"[-_.]+", "-", name).lower()


def third_party():
    """{top-level module that the stages import and Python does not have: one file that does}."""
    modules = {}
    guard = ROOT / "haptic_glance/studio/guard.py"  # wraps parts of websockets, which viser brings
    for path in sorted({*ROOT.glob("stages/**/*.py"), *ROOT.glob("haptic_glance/**/*.py")} - {guard}):
        for node in ast.walk(ast.parse(path.read_bytes())):
            if isinstance(node, ast.Import):
                names = [alias.name for alias in node.names]
            elif isinstance(node, ast.ImportFrom) and node.module and not node.level:
                names = [node.module]
            else:
                continue
            modules |= {name.partition(".")[0]: str(path) for name in names}
    return {name: path for name, path in modules.items() if name not in OURS}


@pytest.fixture
def ball(tmp_path):
    """The file of a bent ellipsoid."""
    import trimesh

    ball = trimesh.creation.icosphere(subdivisions=3)
    ball.vertices *= [1.0, 0.7, 0.5]
    ball.vertices[:, 2] += 0.2 * ball.vertices[:, 0] ** 2
    ball.export(tmp_path / "ball.stl")
    return tmp_path / "ball.stl"


@pytest.mark.slow
def test_what_a_mesh_of_ones_own_needs_runs_in_a_core_install(ball):
    process = python(CORE + SIX, ball)
    assert process.returncode == 0, process.stderr


@pytest.mark.slow
def test_the_studio_needs_no_picture_table_or_learner():
    pytest.importorskip("viser")
    absent = without([*MODULES["pictures"], "pandas", "pywt", "sklearn"])
    code = "from haptic_glance.studio import app, guard, opening, window\n"
    process = python(f"{absent}\n{code}from haptic_glance.know import learn, primitives\nlearn(primitives())")
    assert process.returncode == 0, process.stderr


@pytest.mark.slow
def test_the_commands_do_their_work_in_a_core_install(ball):
    written = [ball.with_suffix(suffix) for suffix in (".glb", ".csv", ".png")]
    options = [word for pair in zip(("--out", "--points", "--picture"), written, strict=True) for word in pair]
    process = run_all(
        ("simplify", ball, "--faces", 200, "--out", ball.with_suffix(".ply")),
        ("saliency", ball, *options),
        ("touch", ball, "--at", "0,0,0.5", "--up", "z", "--out", ball.parent / "out"),
    )
    assert process.returncode == 0 and all(path.exists() for path in (*written, ball.with_suffix(".ply"))), (
        process.stderr
    )
    (simplified, salient, _), (messages, _, of_touch) = (text.split(RULE) for text in (process.stdout, process.stderr))
    measures = [line.split() for line in simplified.splitlines() if "SSIM" in line or "pyramid" in line]
    assert len(measures) == 3 and all(words[-3:] == ["-", "-", "-"] for words in measures)
    assert messages.count("which is not installed: pip install '.[pictures]'\n") == 1
    assert salient.startswith("rank,vertex,x,y,z,score")
    assert {path.name for path in (ball.parent / "out").iterdir()} == {"imprints.npz", "places.csv"}
    (line,) = (line for line in of_touch.splitlines() if "imprints.png" in line)
    assert line.endswith("by matplotlib, which is not installed: pip install '.[pictures]'")


@pytest.mark.slow
def test_a_stage_names_the_extra_that_a_core_install_lacks():
    process = python(f"{CORE}\nimport runpy\nrunpy.run_module('stages.lod', run_name='__main__')")
    assert process.returncode == 1 and process.stderr.strip().endswith("pip install -e '.[pipeline]'")


@pytest.mark.slow
def test_every_import_belongs_to_the_core_or_to_one_extra():
    known = packages_distributions()
    for module, path in third_party().items():
        extra = EXTRAS.get(module)
        listed = PROJECT["optional-dependencies"][extra] if extra else PROJECT["dependencies"]
        brought = BROUGHT.get(module) or known.get(module, [module])[0]
        assert normalised(brought) in distributions(listed), f"{path} imports {module}"


def test_every_extra_is_one_of_the_package_and_every_package_that_we_list_is_pinned():
    assert set(MODULES) <= set(PROJECT["optional-dependencies"])
    assert f"haptic-glance[{','.join(MODULES)}]" in PROJECT["optional-dependencies"]["all"]
    pins = dict(line.split("==") for line in (ROOT / "constraints.txt").read_text().split())
    lists = [PROJECT["dependencies"], *PROJECT["optional-dependencies"].values()]
    listed = set().union(*map(distributions, lists)) - {"haptic-glance"}
    assert listed <= set(map(normalised, pins))


def test_the_list_of_commands_imports_no_stage():
    process = run_command("--help", before="import atexit, sys; atexit.register(lambda: print(sorted(sys.modules)))")
    assert process.returncode == 0
    for name in {**command.MESH_COMMANDS, **command.SHELL_COMMANDS}:
        assert re.search(rf"^  {name} +[A-Z].{{20,}}$", process.stdout, re.M)
    assert max(map(len, process.stdout.splitlines()[:-1])) <= 120
    loaded = ast.literal_eval(process.stdout.splitlines()[-1])
    assert not [name for name in loaded if name.startswith("stages.") or name in ("numpy", "torch", *EXTRAS)]


@pytest.mark.slow
def test_ctrl_c_during_imports_is_one_line(ball):
    stop = without(["numba"]).replace("return None if", "return exec('raise KeyboardInterrupt') if")
    process = run_command("saliency", ball, before=stop)
    assert process.returncode == -signal.SIGINT and process.stderr == "saliency: stopped\n"


@pytest.mark.slow
def test_an_unknown_command_is_named_with_one_like_it_and_none_at_all_shows_the_list():
    process = run_command("salience")
    assert process.returncode == 2 and "Traceback" not in process.stderr
    assert process.stderr.splitlines()[-1].endswith("there is no command 'salience': try saliency")
    assert "one of those that --help lists" in run_command("quux").stderr
    assert "`python -m stages.gate` in a clone" in run_command("gate", "--update").stderr.splitlines()[-1]
    process = run_command()
    assert process.returncode == 2 and "with a mesh of your own:" in process.stderr and not process.stdout


@pytest.mark.slow
def test_every_command_shows_its_name_examples_and_json_in_a_core_install():
    process = run_all(*((name, "--help") for name in command.MESH_COMMANDS))
    texts = dict(zip(command.MESH_COMMANDS, process.stdout.split(RULE), strict=True))
    for name, text in texts.items():
        assert text.startswith(f"usage: haptic-glance {name} ")
        assert f"  haptic-glance {name} " in text.partition("examples:")[2]
        assert "--json" in text or name == "studio"  # which prints nothing but its address


@pytest.mark.slow
def test_what_a_person_got_wrong_is_one_line_without_a_source_position(ball):
    process = run_command("simplify", ball, "--faces", "9000", "--out", "x.glb", cwd=ball.parent)
    assert process.returncode == 1 and not process.stdout
    assert process.stderr.splitlines()[-1].startswith("simplify: ") and ".py" not in process.stderr


def test_a_missing_module_of_nobodys_is_left_as_it_is():
    with pytest.raises(ModuleNotFoundError) as raised, from_extra():
        import no_such_module  # noqa: F401  # pyright: ignore[reportMissingImports]
    assert not isinstance(raised.value, MissingExtra)
    assert conf_folder() == ROOT / "conf" and (conf_folder() / "config.yaml").is_file()


@pytest.fixture(scope="module")
def installed(tmp_path_factory):
    """A folder that holds what the wheel does."""
    pytest.importorskip("hatchling")
    folder = tmp_path_factory.mktemp("wheel")
    build = [sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", folder]
    subprocess.run(build, cwd=ROOT, check=True, capture_output=True)
    (wheel,) = folder.glob("*.whl")
    zipfile.ZipFile(wheel).extractall(folder / "site")
    return folder / "site"


@pytest.mark.slow
def test_the_wheel_holds_the_library_and_nothing_else(installed):
    wanted = {str(path.relative_to(ROOT)) for path in ROOT.glob("haptic_glance/**/*.*") if path.is_file()}
    assert all((installed / "haptic_glance" / name).is_file() for name in ("samples/dromedary.glb", "py.typed"))
    held = {str(path.relative_to(installed)) for path in installed.rglob("*.*")}
    assert {name for name in wanted if "__pycache__" not in name} - held == set()
    assert {name.split("/")[0] for name in held} <= {"haptic_glance", *(p.name for p in installed.glob("*-info"))}


@pytest.mark.slow
def test_an_installed_demo_needs_no_extra_and_no_checkout(installed, tmp_path):
    code = f"{CORE}\nfrom haptic_glance.__main__ import main\nmain()"
    environment = {**os.environ, "PYTHONPATH": str(installed)}
    process = python(code, "demo", cwd=tmp_path, env=environment)
    assert process.returncode == 0, process.stderr
    assert (tmp_path / "haptic_glance_demo/index.html").stat().st_size > 50_000


def test_the_version_is_that_of_the_package():
    process = run_command("--version")
    assert process.stdout == f"haptic-glance {haptic_glance.__version__}\n" == f"haptic-glance {PROJECT['version']}\n"
