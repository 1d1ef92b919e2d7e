"""The budget holds what it promises in the rendered frames; the rivals and the limit."""

import numpy as np
import pytest

from haptic_glance.lod import write_any
from haptic_glance.lod.scene import Frames, Level, Placed, budget
from haptic_glance.lod.scene.chain import ERRORS, finest
from haptic_glance.lod.scene.level_renders import picture_error
from haptic_glance.mesh.mesh import Mesh
from stages.scene import compare as rivals
from stages.scene.rows import saved


@pytest.fixture(scope="module")
def scene(make_scene):
    return make_scene()


@pytest.fixture(scope="module")
def plan(meshes, chains, scene):
    return budget(meshes, scene, chains=chains)


def test_every_rendered_frame_holds_the_tolerance_and_uses_it(plan, scene):
    assert 0.3 * scene.tolerance < plan.errors.max() <= scene.tolerance
    assert plan.jumps and max(jump for _, _, jump in plan.jumps) <= scene.tolerance
    coarser = rivals.by_counts(plan.frames, plan.chains, np.maximum(plan.faces // 2, 1))
    assert coarser.errors.max() > scene.tolerance
    total = plan.faces.sum(axis=1)  # far frames need fewer
    assert total[0] < total[-1] < 0.5 * sum(chain[0].faces for chain in plan.chains)


def test_a_wider_tolerance_needs_no_more_faces(meshes, chains, make_scene, plan):
    wide = budget(meshes, make_scene(tolerance=2.0), chains=chains)
    assert wide.faces.sum() < plan.faces.sum() and wide.errors.max() <= 2.0


def test_a_file_stands_upright_in_a_scene(meshes, make_scene, tmp_path):
    """A glTF is y up, a scene z up."""
    high = Mesh(meshes["two"].vertices * [0.5, 1, 0.5], meshes["two"].faces, up="y")
    write_any(tmp_path / "high.glb", high)
    scene = make_scene(objects=(Placed("high", (0.0, 0.0, 0.0), 0.0, 0.3),), frames=1)
    for source in (high, tmp_path / "high.glb"):
        low, top = budget({"high": source}, scene).chains[0][0].box
        assert (top - low).argmax() == 2
    with pytest.raises(ValueError, match="^options of hihg: there are high$"):
        budget({"high": high}, scene, {"hihg": {"weights": np.ones(len(high.vertices))}})
    with pytest.raises(ValueError, match="^no levels of high: there are none$"):
        budget({"high": high}, scene, chains={})


@pytest.mark.parametrize("aside", [0.28, 0.34])
def test_the_perceptual_tolerance_holds_for_what_another_partly_hides(meshes, chains, make_scene, aside):
    """The outline of the one in front is what breaks the other's picture: finer levels of the latter do not help."""
    objects = (Placed("one", (0, 0, 0), 0.0, 0.5), Placed("two", (aside, 0.6, 0.1), 0.0, 0.2))
    scene = make_scene(objects=objects, frames=3, tolerance=0.05, kind="ssim")
    planned = budget(meshes, scene, chains=chains)
    assert 0 < planned.errors.max() <= 0.05
    assert planned.faces[:, 1].max() < len(meshes["two"].faces) / 2


def test_a_limit_below_the_smallest_total_names_it(meshes, chains, make_scene):
    smallest = 2 * chains["one"][-1].faces + chains["two"][-1].faces
    with pytest.raises(ValueError, match=f"{smallest} together"):
        budget(meshes, make_scene(limit=smallest - 1), chains=chains)
    assert budget(meshes, make_scene(limit=smallest), chains=chains).faces.sum(axis=1).max() == smallest


def test_what_is_out_of_view_costs_nothing(meshes, chains, make_scene):
    objects = (Placed("one", (0, 0, 0), 0.0, 0.25), Placed("one", (0, -9.0, 0), 0.0, 0.25))
    planned = budget(meshes, make_scene(objects=objects), chains=chains)
    assert (planned.faces[:, 0] > 0).all() and (planned.faces[:, 1] == 0).all()


def test_what_leaves_the_view_close_to_the_eye_does_not_need_all_its_faces(meshes, chains, make_scene):
    """Its box reaches behind the camera, so that its distance says nothing of what is seen of it."""
    scene = make_scene(objects=(Placed("one", (0.42, -1.1, 0.2), 0.0, 0.4),))
    planned = budget(meshes, scene, chains=chains)
    behind = [camera.project(planned.frames.poses[0].corners())[2].min() < 0.1 for camera in scene.cameras]
    assert behind[-1] and planned.frames.in_view[-1, 0]
    assert planned.errors.max() <= 1 and planned.faces[-1, 0] < 0.5 * len(meshes["one"].faces)


def test_what_is_hidden_takes_the_coarsest_level(meshes, chains, make_scene):
    objects = (Placed("one", (0, 0, 0), 0.0, 0.6), Placed("two", (0, 0.8, 0.1), 0.0, 0.1))
    planned = budget(meshes, make_scene(objects=objects), chains=chains)
    assert (planned.levels[:, 1] == len(chains["two"]) - 1).all()


def shifted(mesh, by):
    return Level(Mesh(mesh.vertices + by, mesh.faces), dict.fromkeys(ERRORS, 0.0))


def test_a_plate_moved_towards_the_eye_is_off_by_its_shift_in_pixels(make_scene):
    corners = np.array([[-0.5, 0, -0.5], [0.5, 0, -0.5], [0.5, 0, 0.5], [-0.5, 0, 0.5]])
    plate = Mesh(corners, [[0, 1, 2], [0, 2, 3]])
    scene = make_scene(objects=(Placed("plate", (0, 0, 0), 0.0, 0.4),), frames=1)
    frames = Frames(scene, {"plate": plate}, [finest(plate)])
    checked = frames.check(0, [shifted(plate, [0.0, -0.02, 0.0])])
    depth = 4.0  # of the middle
    expected = 0.02 * 0.4 * scene.cameras[0].focal / depth
    assert checked.error == pytest.approx(expected, rel=0.05)
    assert checked.displacements.mean() == pytest.approx(expected, rel=0.05)


def test_the_full_scene_has_no_error(frames_of, make_scene):
    frames = frames_of(make_scene(frames=2))
    assert rivals.full(frames).errors.tolist() == [0, 0]
    assert picture_error(frames, 1, frames.full) == 0
    assert frames.check(1, frames.full).displacements.max() == 0


def test_joined_frames_show_what_one_ray_cast_of_the_whole_scene_shows(meshes, frames_of, make_scene):
    from haptic_glance.lod.scene.camera import world_mesh
    from haptic_glance.mesh.rays import RayScene

    scene = make_scene(frames=2)
    frames = frames_of(scene)
    parts = [world_mesh(meshes[placed.name], pose) for placed, pose in zip(scene.objects, frames.poses, strict=True)]
    first = np.cumsum([0, *(len(part.vertices) for part in parts)])
    whole = Mesh(np.concatenate([part.vertices for part in parts]),
                 np.concatenate([part.faces + k for part, k in zip(parts, first, strict=False)]))  # fmt: skip
    camera = scene.cameras[1]
    rows, columns = (grid.ravel() for grid in np.mgrid[: camera.size[0], : camera.size[1]])
    along = camera.directions(rows, columns)
    hits = RayScene(whole).cast(np.broadcast_to(camera.eye, along.shape), along)
    ends = np.cumsum([len(part.faces) for part in parts])
    expected = np.where(hits.hit, np.searchsorted(ends, hits.face, side="right"), -1)
    assert (frames.owners(1, frames.full) == expected).mean() > 0.999


def test_uniform_levels_go_by_distance_alone(frames_of, make_scene, chains):
    """Half of the faces at twice the distance: two levels of the chain that ours is chosen from."""
    scene = make_scene()
    frames = frames_of(scene)
    ladders = tuple((full, *chains[placed.name][1:]) for full, placed in zip(frames.full, scene.objects, strict=True))
    planned = rivals.uniform(frames, ladders, 1.0)
    expected = np.maximum(np.rint(2 * np.log2(frames.distance)), 0)
    assert np.array_equal(planned.levels, expected) and len(np.unique(expected)) > 2
    assert (rivals.uniform(frames, ladders, 1e3).levels == 0).all()
    assert (rivals.uniform(frames, ladders, 1e-3).levels == [len(chain) - 1 for chain in ladders]).all()


def test_uniform_levels_by_size_show_a_larger_copy_finer(frames_of, make_scene, chains):
    objects = (Placed("one", (-0.3, 0, 0), 0.0, 0.2), Placed("one", (0.3, 0, 0), 0.0, 0.4))
    frames = frames_of(make_scene(objects=objects))
    ladders = tuple((full, *chains["one"][1:]) for full in frames.full)
    planned = rivals.uniform(frames, ladders, 2.0, by_size=True)
    assert (planned.levels[:, 1] < planned.levels[:, 0]).all()


def test_a_limit_holds_and_costs_error(meshes, chains, make_scene, plan):
    limit = int(plan.faces.sum(axis=1).max() * 0.6)
    limited = budget(meshes, make_scene(limit=limit), chains=chains)
    assert limited.faces.sum(axis=1).max() <= limit
    assert plan.errors.max() < limited.errors.max()


def test_a_level_that_sticks_out_of_the_box_is_seen_to_its_end(chains, make_scene, frames_of):
    frames = frames_of(make_scene(frames=1))
    full = chains["one"][0]
    wide = Level(Mesh(full.mesh.vertices * [1.5, 1, 1], full.mesh.faces), dict.fromkeys(ERRORS, 0.0))
    columns = [np.ptp(frames.rendering(0, 0, level).pixels % 80) for level in (full, wide)]
    assert columns[1] > columns[0] + 1


def test_what_hides_an_object_counts_nothing_for_its_structure(meshes, chains, make_scene):
    """The hidden one is at full detail: the picture changes where the other stands, and that is the other's alone."""
    objects = (Placed("one", (0, 0, 0), 0.0, 0.6), Placed("two", (0, 0.8, 0.1), 0.0, 0.1))
    scene = make_scene(objects=objects, frames=1, kind="ssim", tolerance=0.1)
    frames = Frames(scene, meshes, [chains["one"][0], chains["two"][0]])
    errors = frames.check(0, [chains["one"][-1], chains["two"][0]]).objects
    assert errors[0] > 0.05 and errors[1] == 0
    assert frames.between(0, 1, chains["two"][0], chains["two"][-1]) == 0


@pytest.mark.slow
def test_tuning_meets_the_wanted_error_from_above(frames_of, make_scene, chains):
    scene = make_scene()
    frames = frames_of(scene)
    ladders = tuple((full, *chains[placed.name][1:]) for full, placed in zip(frames.full, scene.objects, strict=True))
    plan_of = lambda factor: rivals.uniform(frames, ladders, 1 / factor)  # noqa: E731
    wanted = 0.6 * plan_of(1e3).errors.mean()  # the coarsest has more
    tuned = rivals.tune(plan_of, lambda plan: plan.errors.mean(), wanted)
    assert wanted <= tuned.errors.mean() < 1.6 * wanted
    assert rivals.tune(plan_of, lambda plan: plan.errors.max(), wanted, below=True).errors.max() <= wanted


def test_copies_of_an_object_are_one_object_to_the_interval():
    assert saved(np.array([10, 30]), np.array([20, 60]), ["cup", "mug"]) == (0.5, 0.5, 0.5)
    ours, others, names = np.array([10, 40, 30]), np.array([20, 50, 90]), ["cup", "mug", "pan"]
    once = saved(ours, others, names)
    often = saved(np.repeat(ours, 9), np.repeat(others, 9), np.repeat(names, 9))
    assert once == pytest.approx(often) and once[1] < once[0] < once[2]
    assert saved(ours, ours, names) == (0, 0, 0)
