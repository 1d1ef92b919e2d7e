"""What a window of the studio holds: meshes, looks, clicks, levels and work, without a browser."""

import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from threading import Event

import numpy as np
import pytest

from haptic_glance.base.files import write_mesh
from haptic_glance.look.points import detect
from haptic_glance.look.points.find import Looked
from haptic_glance.mesh import MeshError, load, normalise, rotate_to_z_up
from haptic_glance.studio.jobs import Job, Stopped
from haptic_glance.studio.panels.levels import HARD, SOFT, Levels
from haptic_glance.studio.specimen import Specimen, files_at, open_content, open_file, turned

PATIENCE = 300  # seconds, on a machine with other work


def quiet(share, text):
    """Reports nothing."""


@pytest.mark.slow
def test_a_look_is_that_of_the_library_and_is_computed_once(knob_file):
    specimen = open_file(knob_file)
    with ThreadPoolExecutor(4) as pool:
        looks = list(pool.map(lambda _: specimen.look("glance", 3), range(4)))
    assert all(look is looks[0] for look in looks)
    detection = detect(load(knob_file), "glance", 3)
    assert np.array_equal(looks[0].saliency, detection.saliency) and set(looks[0].vertices) == set(detection.points)


def test_a_look_that_nobody_waits_for_any_more_is_not_computed(mesh):
    specimen = Specimen(mesh, "ball")
    known = specimen.look("height", 3)

    def stop():
        raise Stopped

    with pytest.raises(Stopped):
        specimen.look("height", 4, stop)
    assert specimen.look("height", 3, stop) is known
    assert specimen._looks.keys() == {("height", 3)}


@pytest.mark.slow
def test_a_click_and_a_known_look_do_not_wait_for_another_method(mesh, monkeypatch):
    specimen, begun, go = Specimen(mesh, "ball"), Event(), Event()
    specimen.look()

    def slow(*source):
        begun.set()
        go.wait(PATIENCE)
        return Looked(*source)

    monkeypatch.setattr("haptic_glance.studio.specimen.Looked", slow)
    with ThreadPoolExecutor(3) as pool:
        other = pool.submit(specimen.look, "height")
        begun.wait(PATIENCE)
        pool.submit(specimen.look).result(PATIENCE)
        pool.submit(specimen.pick, np.array([5.0, 0, 0]), np.array([-1.0, 0, 0])).result(PATIENCE)
        assert not other.done()
        go.set()


# In a process of its own, as the studio is: a context of OpenGL belongs to the thread that drew first.
ON_THREADS = """
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from haptic_glance.look.points import find
from haptic_glance.studio.specimen import open_file
find.VIEW_SIZE = 225, 300
specimen = open_file(Path(sys.argv[1]))
with ThreadPoolExecutor(2) as pool:
    for look in pool.map(lambda count: specimen.look("itti", count), (2, 3)):
        print(len(look.points))
"""


@pytest.mark.slow
def test_a_look_that_needs_pictures_may_be_asked_for_on_any_thread(knob_file):
    process = subprocess.run([sys.executable, "-c", ON_THREADS, str(knob_file)], capture_output=True, text=True)
    assert process.stdout.split() == ["2", "3"], process.stderr


def test_a_click_finds_the_face_and_its_nearest_corner(mesh):
    specimen = Specimen(mesh, "ball")
    hit = specimen.pick(np.array([5.0, 0, 0]), np.array([-1.0, 0, 0]))
    assert hit is not None
    tip = specimen.mesh.vertices[hit.vertex]
    assert tip[0] == specimen.mesh.vertices[:, 0].max() and hit.vertex in specimen.mesh.faces[hit.face]
    assert hit.normal[0] > 0.5 and np.linalg.norm(hit.position - tip) < 0.05
    assert specimen.pick(np.array([5.0, 0, 0]), np.array([1.0, 0, 0])) is None
    inverted = Specimen(type(mesh)(mesh.vertices, mesh.faces[:, ::-1]), "ball")
    hit = inverted.pick(np.array([5.0, 0, 0]), np.array([-1.0, 0, 0]))
    assert hit is not None and hit.normal[0] > 0.5


def test_turning_keeps_the_vertices_and_changes_what_is_high(mesh):
    specimen = Specimen(mesh, "ball")
    other = turned(specimen, "x")
    tip = int(mesh.vertices[:, 0].argmax())
    assert specimen.mesh.vertices[tip, 2] == pytest.approx(0, abs=0.05) and other.mesh.vertices[tip, 2] > 0.4
    assert not np.allclose(other.look("height").saliency, specimen.look("height").saliency)


def test_an_uploaded_file_is_that_on_disk_and_reads_no_other(knob_file):
    opened = open_content(f"../../{knob_file.name}", knob_file.read_bytes())
    assert opened.name == "knob"
    assert np.array_equal(opened.source.vertices, load(knob_file).vertices)
    with pytest.raises(MeshError, match="formats are"):
        open_content("/etc/passwd", b"root")
    with pytest.raises(MeshError, match="empty"):
        open_content("x.stl", b"")


def test_meshes_of_the_pipeline_are_opened(tmp_path, mesh):
    write_mesh(tmp_path / "vase.npz", normalise(mesh))
    (path,) = files_at(tmp_path)
    assert open_file(path).name == "vase" and len(open_file(path).source.faces) == len(mesh.faces)
    (tmp_path / "bad.npz").write_bytes(b"no zip")
    np.savez(tmp_path / "other.npz", a=1)
    for name in ("bad.npz", "other.npz"):
        with pytest.raises(ValueError, match=name):
            open_file(tmp_path / name)
    (tmp_path / "empty").mkdir()
    with pytest.raises(MeshError, match="no mesh in this folder"):
        files_at(tmp_path / "empty")


@pytest.mark.slow
def test_levels_have_the_faces_asked_for_and_larger_errors_with_fewer(mesh):
    specimen = Specimen(mesh, "ball")
    levels = Levels(specimen, specimen.look("glance", 3))
    pair = [levels.at(faces, SOFT, quiet) for faces in (640, 160)]
    assert [len(level.mesh.faces) for level in pair] == [640, 160]
    assert 0 < pair[0].mean < pair[1].mean <= pair[1].most
    assert all(level.error.shape == level.saliency.shape == (len(level.mesh.vertices),) for level in pair)
    assert pair[1].error.max() <= pair[1].most * 1.01
    assert levels.at(640, SOFT, quiet) is pair[0]
    whole = levels.at(levels.faces, SOFT, quiet)
    assert whole.most == pytest.approx(0, abs=1e-6)


def test_hard_levels_keep_the_points_and_a_level_that_cannot_be_names_what_can(mesh):
    specimen = Specimen(mesh, "ball")
    levels = Levels(specimen, specimen.look("glance", 2))
    level = levels.at(200, HARD, quiet)
    assert list(levels.tasks[HARD].points_kept(level.mesh)) == [True, True]
    with pytest.raises(ValueError, match="ask for .* or more"):
        levels.at(2, HARD, quiet)


@pytest.mark.parametrize("suffix", [".glb", ".ply"])
@pytest.mark.slow
def test_a_level_comes_back_in_the_units_of_the_file(tmp_path, mesh, suffix):
    far = type(mesh)(mesh.vertices * 30 + 100, mesh.faces, up="z")
    specimen = Specimen(far, "ball")
    levels = Levels(specimen, specimen.look("glance", 2))
    path = tmp_path / f"level{suffix}"
    path.write_bytes(levels.content(levels.at(300, SOFT, quiet), SOFT, suffix))
    again = load(path)
    assert len(again.faces) == 300 and again.diagonal == pytest.approx(far.diagonal, rel=0.05)
    assert rotate_to_z_up(again).vertices[:, 2].mean() == pytest.approx(far.vertices[:, 2].mean(), abs=3)


class Log(list):
    """What a job says when it ends."""

    def job(self, work):
        return Job(
            "x", work, lambda answer: self.append(answer), self.append, lambda _: self.append("end"), lambda _: 0
        )


def test_a_job_hands_over_its_result_or_its_error():
    log, error = Log(), ValueError("no")
    log.job(lambda report: 3).start().thread.join(PATIENCE)
    log.job(lambda report: (_ for _ in ()).throw(error)).start().thread.join(PATIENCE)
    assert log == [3, "end", error, "end"]


def test_a_stopped_job_ends_at_its_next_report_and_its_result_is_dropped():
    log, begun, go = Log(), Event(), Event()

    def work(report):
        begun.set()
        go.wait(PATIENCE)
        report(0.5, "half")
        log.append("went on")

    job = log.job(work).start()
    begun.wait(PATIENCE)
    job.stop()
    go.set()
    job.thread.join(PATIENCE)
    assert log == ["end"] and job.stopped
    late = log.job(lambda report: late.stop())  # stopped after its last report
    late.start().thread.join(PATIENCE)
    assert log == ["end", "end"]
