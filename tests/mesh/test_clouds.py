"""Point clouds and depth images of shapes that are known give their surfaces, or the reason why they cannot."""

import io
import json
from pathlib import Path

import cv2
import laspy
import numpy as np
import pytest
import trimesh
from pypcd4 import Encoding, PointCloud

from haptic_glance import as_mesh, load
from haptic_glance.mesh import MeshError, clean, clouds
from haptic_glance.mesh.clouds import Cloud, cloud_of_depth, normals_of, read_cloud, surface_of
from haptic_glance.mesh.files import as_stated, load_as_stated
from haptic_glance.mesh.mesh import Mesh, unit
from haptic_glance.mesh.rays import RayScene

ROOT = Path(__file__).parents[2]
RANDOM = np.random.default_rng(0)
BALL = unit(RANDOM.normal(size=(1200, 3)))
COLORS = np.tile(np.array([[200, 10, 30]], np.uint8), (len(BALL), 1))
INTENSITY = np.arange(len(BALL))[:, None] % 200
TORUS = trimesh.creation.torus(1.0, 0.25, 64, 32)
SHEET = Mesh(np.eye(3), np.array([[0, 1, 2]]))
DEPTH = {"image": "a.png", "fx": 100.0, "fy": 100.0, "cx": 32.0, "cy": 32.0, "scale": 0.001}


def text(values):
    return "\n".join(" ".join(map(str, row)) for row in np.asarray(values).tolist()).encode()


def pcd(encoding, normals=()):
    made = PointCloud.from_xyzrgb_points(np.column_stack([BALL, PointCloud.encode_rgb(COLORS)]))
    if normals:
        made = PointCloud.from_points(np.hstack([BALL, BALL]), ("x", "y", "z", *normals), (np.float32,) * 6)
    file = io.BytesIO()
    made.save(file, encoding)
    return file.getvalue()


def las():
    made = laspy.create(point_format=2, file_version="1.2")
    made.header.scales = [1e-4] * 3
    made.x, made.y, made.z = BALL.T
    made.red, made.green, made.blue = COLORS.T.astype(np.uint16) << 8
    file = io.BytesIO()
    made.write(file)
    return file.getvalue()


FILES = {
    "bare.xyz": lambda: text(BALL),
    "commas.xyz": lambda: b"x,y,z\n" + text(BALL).replace(b" ", b","),
    "normals.xyz": lambda: text(np.hstack([BALL, BALL])),
    "all.pts": lambda: b"1200\n" + text(np.hstack([BALL, COLORS, BALL])),
    "intense.pts": lambda: b"1200\n" + text(np.hstack([BALL, COLORS[:, :1], COLORS])),
    "weighed.pts": lambda: b"1200\n" + text(np.hstack([BALL, BALL, COLORS[:, :1]])),
    "intense_all.pts": lambda: b"1200\n" + text(np.hstack([BALL, COLORS[:, :1], COLORS, BALL])),
    "ascii.pcd": lambda: pcd(Encoding.ASCII),
    "binary.pcd": lambda: pcd(Encoding.BINARY),
    "renamed.pcd": lambda: pcd(Encoding.BINARY).replace(b" rgb", b" rgba", 1),
    "packed.pcd": lambda: pcd(Encoding.BINARY_COMPRESSED),
    "air.las": las,
    "intense.xyz": lambda: text(np.hstack([BALL, INTENSITY / 7, COLORS])),
    "named.xyz": lambda: b"//X Y Z Intensity R G B\n" + text(np.hstack([BALL, INTENSITY, COLORS])),
    "last.asc": lambda: text(np.hstack([BALL, COLORS, INTENSITY])),
    "shares.xyz": lambda: b"x y z red green blue\n" + text(np.hstack([BALL, COLORS / 255])),
    "fractions.xyz": lambda: b"x y z red green blue\n" + text(np.hstack([BALL, COLORS + 0.2])),
    "named_all.xyz": lambda: b"x y z nx ny nz r g b\n" + text(np.hstack([BALL, BALL, unit(COLORS / 255.0)])),
    "unit.xyz": lambda: b"x y z red green blue\n" + text(np.hstack([BALL, unit(COLORS / 255.0)])),
    "long.xyz": lambda: b"x y z nx ny nz r g b\n" + text(np.hstack([BALL, COLORS[:, ::-1], COLORS])),
    "decimals.xyz": lambda: text(BALL).replace(b".", b","),
    "semicolons.xyz": lambda: b"X;Y;Z\n" + text(BALL).replace(b" ", b";").replace(b".", b","),
    "mark.xyz": lambda: b"\xef\xbb\xbf" + text(BALL),
    "wide.xyz": lambda: text(BALL).decode().encode("utf-16"),
    "normals.pcd": lambda: pcd(Encoding.BINARY, ("normal_x", "normal_y", "normal_z")),
    "short_names.pcd": lambda: pcd(Encoding.BINARY, ("nx", "ny", "nz")),
}
COLOURED = ("all.pts", "intense.pts", "intense_all.pts", "binary.pcd", "renamed.pcd", "packed.pcd", "air.las",
            "intense.xyz", "named.xyz", "last.asc", "shares.xyz", "fractions.xyz", "long.xyz")  # fmt: skip
WITH_NORMALS = ("normals.xyz", "all.pts", "weighed.pts", "intense_all.pts", "normals.pcd", "short_names.pcd",
                "named_all.xyz")  # fmt: skip


@pytest.mark.parametrize("name", FILES)
def test_every_format_gives_its_points_colours_and_normals(name):
    cloud = read_cloud(FILES[name](), Path(name).suffix)
    assert cloud.points == pytest.approx(BALL, abs=1e-4)
    assert name not in COLOURED or (cloud.colors == COLORS).all()
    if name in ("named_all.xyz", "unit.xyz"):
        assert cloud.colors[0].tolist() == (255 * unit(COLORS[:1] / 255.0)).round()[0].tolist()
    assert cloud.normals is None or cloud.normals == pytest.approx(BALL)
    assert (cloud.normals is not None) == (name in WITH_NORMALS)


PLY = trimesh.PointCloud(BALL, colors=np.c_[COLORS, COLORS[:, :1]]).export(file_type="ply")


OFF = b"COFF\n1200 0 0\n" + text(np.hstack([BALL, COLORS]))


@pytest.mark.parametrize(
    ("name", "content"), [("bare.xyz", text(BALL)), ("cloud.ply", PLY), ("cloud.off", OFF), ("air.las", las())]
)
@pytest.mark.slow
def test_a_ball_of_points_becomes_a_ball(name, content, tmp_path):
    (tmp_path / name).write_bytes(content)
    mesh, notes = clean(load(tmp_path / name))
    assert mesh.watertight and not notes
    assert np.abs(np.linalg.norm(mesh.vertices, axis=1) - 1).max() < 0.02
    assert (np.einsum("ij,ij->i", mesh.vertex_normals, mesh.vertices) > 0.9).all()
    assert (mesh.colors is None) == (name == "bare.xyz") and (mesh.colors is None or (mesh.colors == COLORS[0]).all())


@pytest.mark.slow
def test_place_and_size_of_the_points_do_not_matter():
    near, far = surface_of(Cloud(BALL)), surface_of(Cloud(BALL * 1e3 + 1e6))
    assert len(near.faces) == pytest.approx(len(far.faces), rel=0.01)
    assert np.abs(np.linalg.norm((far.vertices - 1e6) / 1e3, axis=1) - 1).max() < 0.02


def test_normals_point_outwards_even_where_the_shape_has_a_hole():
    points, faces = trimesh.sample.sample_surface(TORUS, 4000, seed=0)
    alike = np.einsum("ij,ij->i", normals_of(np.asarray(points)), TORUS.face_normals[faces])
    assert (alike > 0.9).mean() > 0.99


SIGNS = {
    "random": RANDOM.choice([-1, 1], len(BALL)),
    "towards the origin": -np.ones(len(BALL)),
    "towards a far viewpoint": np.where(BALL[:, 2] > 0.2, 1, -1),
}


@pytest.mark.slow
@pytest.mark.parametrize("signs", SIGNS)
def test_wrong_normals_of_every_format_are_estimated_anew_with_a_warning(signs, tmp_path, monkeypatch):
    monkeypatch.setattr(clouds, "surface_of", lambda cloud: SHEET if cloud.normals is None else None)
    normals = BALL * SIGNS[signs][:, None]
    made = PointCloud.from_points(np.hstack([BALL, normals]), ("x", "y", "z", "nx", "ny", "nz"), (np.float32,) * 6)
    made.save(tmp_path / "scan.pcd")
    header = "ply\nformat ascii 1.0\nelement vertex 1200\n" + "".join(
        f"property float {name}\n" for name in ("x", "y", "z", "nx", "ny", "nz")
    )
    (tmp_path / "scan.ply").write_bytes(header.encode() + b"end_header\n" + text(np.hstack([BALL, normals])))
    (tmp_path / "scan.xyz").write_bytes(text(np.hstack([BALL, normals])))
    for name in ("scan.pcd", "scan.ply", "scan.xyz"):
        with pytest.warns(
            UserWarning, match=rf"^{name}: \d+ % of its normals look to the wrong side, so normals are est"
        ):
            assert load(tmp_path / name, up="z").faces.tolist() == SHEET.faces.tolist()
    with pytest.warns(UserWarning, match=r"^the point cloud: \d+ % of its normals look to the wrong side"):
        assert as_mesh(Cloud(BALL, normals, up="z")).faces.tolist() == SHEET.faces.tolist()


def test_normals_look_to_the_sensor_that_a_file_states():
    bowl, sensor = BALL[BALL[:, 2] < -0.2], np.array([0, 0, 5.0])
    seen = Cloud(bowl, -bowl, sensor=sensor)
    assert clouds.checked_normals(seen) == (seen, "")
    mended, note = clouds.checked_normals(Cloud(bowl, bowl, sensor=sensor))
    assert mended.normals is None and note.startswith("100 % of its normals look to the wrong side")


@pytest.mark.slow
def test_right_normals_are_kept_also_of_thin_parts_of_few_flips_and_of_a_hollow():
    plate, sides = trimesh.sample.sample_surface(trimesh.creation.box((1, 1, 0.01)), 3000, seed=0)
    few = np.where(np.arange(len(BALL)) % 10, 1, -1)[:, None]
    hollow = BALL[:, 2] < 0.2
    for points, normals in (
        (BALL, BALL),
        (BALL, BALL * few),
        (np.asarray(plate), trimesh.creation.box((1, 1, 0.01)).face_normals[sides]),
        (BALL[hollow], BALL[hollow]),
        (BALL[hollow], -BALL[hollow]),
    ):
        cloud = Cloud(points, normals)
        assert clouds.checked_normals(cloud) == (cloud, "")


@pytest.mark.slow
def test_what_was_not_seen_stays_a_hole():
    front = BALL[BALL[:, 2] > 0.1]
    mesh = surface_of(Cloud(front, sensor=np.array([0, 0, 5.0])))
    assert not mesh.watertight and mesh.vertices[:, 2].min() > -0.15
    assert (mesh.face_normals[:, 2] > 0).mean() > 0.95


@pytest.mark.slow
def test_a_sensor_within_a_hollow_sees_its_inside():
    mesh = surface_of(Cloud(BALL, sensor=np.zeros(3)))
    assert (np.einsum("ij,ij->i", mesh.vertex_normals, mesh.vertices) < -0.9).mean() > 0.99


SHAPES = {
    "ball": lambda: trimesh.creation.icosphere(4),
    "box": lambda: trimesh.creation.box((1, 0.7, 0.5)),
    "dromedary": lambda: trimesh.load(ROOT / "samples/dromedary.glb", force="mesh"),
}


def as_pcd(points, viewpoint="0 0 0 1 0 0 0"):
    made = PointCloud.from_xyz_points(points.astype(np.float32))
    file = io.BytesIO()
    made.save(file, Encoding.BINARY)
    return file.getvalue().replace(b"VIEWPOINT 0.0 0.0 0.0 1.0 0.0 0.0 0.0", f"VIEWPOINT {viewpoint}".encode())


@pytest.mark.parametrize("count", [2000, 20_000])
@pytest.mark.parametrize("place", ["on the ground", "beside"])
@pytest.mark.parametrize("shape", SHAPES)
def test_a_viewpoint_of_zeros_is_a_sensor_where_the_points_are_what_it_sees(shape, place, count):
    solid = SHAPES[shape]()
    solid.apply_translation(-solid.bounds.mean(axis=0))
    solid.apply_scale(1 / solid.extents.max())
    floor = [0.1, 1e-3 - solid.bounds[0][1], 0]
    offset = np.array(floor if place == "on the ground" else [0.2, 0.3, 1.5])
    points = trimesh.sample.sample_surface(solid, count, seed=0)[0] + offset
    assert read_cloud(as_pcd(points), ".pcd").sensor is None
    assert read_cloud(as_pcd(points, "5 0 0 1 0 0 0"), ".pcd").sensor.tolist() == [5, 0, 0]
    if place == "beside":
        scene = RayScene(Mesh(np.asarray(solid.vertices), np.asarray(solid.faces)))
        rays = unit(points)
        hits = scene.cast(np.tile(-offset, (count, 1)), rays)
        noise = 0.002 * RANDOM.normal(size=count)
        view = ((hits.distance + noise)[:, None] * rays)[hits.hit]
        assert read_cloud(as_pcd(view), ".pcd").sensor.tolist() == [0, 0, 0]


@pytest.mark.slow
@pytest.mark.parametrize(("kind", "warned"), [("<f4", True), ("<f8", False)])
def test_single_precision_points_far_from_the_origin_are_named(recwarn, tmp_path, kind, warned):
    header = f"ply\nformat binary_little_endian 1.0\nelement vertex {len(BALL)}\n"
    header += "".join(f"property {'float' if warned else 'double'} {axis}\n" for axis in "xyz") + "end_header\n"
    (tmp_path / "far.ply").write_bytes(header.encode() + (BALL * 20 + 5e6).astype(kind).tobytes())
    load_as_stated(tmp_path / "far.ply")
    assert ["far.ply: its coordinates have steps of" in str(warning.message) for warning in recwarn] == [True] * warned


@pytest.mark.slow
@pytest.mark.parametrize(("gap", "warned"), [pytest.param(3, False, marks=pytest.mark.slow), (300, True)])
def test_parts_too_far_apart_for_one_surface_are_named(recwarn, gap, warned):
    surface_of(Cloud(np.concatenate([BALL, BALL + [gap, 0, 0]])))
    assert ["coarser than the points" in str(warning.message) for warning in recwarn] == [True] * warned


@pytest.mark.slow
def test_a_cloud_without_a_surface_near_its_points_is_refused(monkeypatch):
    monkeypatch.setattr(clouds, "GAP", 0)
    with pytest.raises(MeshError, match="no surface passes near the points"):
        surface_of(Cloud(BALL))


@pytest.mark.slow
def test_outliers_and_pixels_without_a_reading_change_nothing():
    holes = [np.full((50, 3), np.nan), np.zeros((50, 3)), RANDOM.uniform(-30, 30, (100, 3))]
    mesh = surface_of(Cloud(np.concatenate([BALL, *holes])))
    assert mesh.watertight and np.abs(np.linalg.norm(mesh.vertices, axis=1) - 1).max() < 0.02


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: surface_of(Cloud(BALL[:1])), "a point cloud of 1 points, 1 of them usable: a surface needs 50"),
        (lambda: surface_of(Cloud(np.tile(BALL[:1], (100, 1)))), "of 100 points, 1 of them usable"),
        (lambda: surface_of(Cloud(np.full((100, 3), np.nan))), "of 100 points, 0 of them usable"),
        (lambda: surface_of(Cloud(BALL * [1, 1, 0])), "lie on one plane"),
        (lambda: surface_of(Cloud(BALL * [1, 0, 0])), "lie on one line"),
        (lambda: cloud_of_depth(np.zeros((48, 64)), 100.0, 100.0, 32.0, 24.0), "no reading"),
        (lambda: cloud_of_depth(np.ones((48, 64)), -1.0, 100.0, 32.0, 24.0), "fx=-1.0"),
        (lambda: cloud_of_depth(np.ones((48, 64)), 100.0, np.nan, 32.0, 24.0), "fy=nan"),
        (lambda: cloud_of_depth(np.ones((48, 64)), np.inf, 100.0, 32.0, 24.0), "fx=inf"),
        (lambda: cloud_of_depth(np.ones((48, 64)), 100.0, 100.0, 900.0, 24.0), "cannot be of 64 x 48 pixels"),
        (lambda: cloud_of_depth(np.ones((48, 64, 3)), 100.0, 100.0, 32.0, 24.0), "one channel"),
    ],
)
def test_wrong_arguments_are_named_with_what_is_right(call, words):
    with pytest.raises(MeshError, match=words):
        call()


@pytest.mark.parametrize(
    ("name", "content", "reason"),
    [
        ("a.xyz", b"x y z\n", "no line of the point cloud holds three numbers"),
        ("a.pcd", pcd(Encoding.BINARY)[:-4000], "truncated: its header states 1200 points, 950 follow"),
        ("a.pcd", b"VERSION .7\nPOINTS 99999999\nDATA ascii\n1 2 3\n", "truncated: its header states 99999999 points"),
        ("a.las", b"LASF" + b"\0" * 300, "unreadable as LAS|truncated"),
        ("a.depth", b"{}", "KeyError: 'image'; a .depth file is like {\"image\""),
        ("a.depth", json.dumps(DEPTH).encode(), "the depth image a.png is not there"),
    ],
)
def test_a_damaged_file_is_refused_by_name(name, content, reason, tmp_path):
    (tmp_path / name).write_bytes(content)
    with pytest.raises(MeshError, match=reason) as error:
        load(tmp_path / name)
    assert name in str(error.value)


@pytest.mark.slow
def test_a_depth_image_gives_the_side_that_was_seen(tmp_path):
    """A ball of radius 0.3 at distance 2, in millimetres."""
    v, u = np.mgrid[:240, :320]
    ray = np.stack([(u - 160) / 300, np.ones(u.shape), (120 - v) / 300], axis=2)
    a, b = (ray**2).sum(axis=2), 2 * ray[..., 1]
    inner = b**2 - a * (4 - 0.09)
    away = np.where(inner > 0, (b - np.sqrt(np.maximum(inner, 0))) / a, 0)
    cv2.imwrite(str(tmp_path / "a.png"), np.rint(away * 1000).astype(np.uint16))
    intrinsics = {"fx": 300.0, "fy": 300.0, "cx": 160.0, "cy": 120.0, "scale": 0.001}
    (tmp_path / "scan.depth").write_text(json.dumps(intrinsics | {"image": "a.png"}))
    mesh = load(tmp_path / "scan.depth")
    assert np.abs(np.linalg.norm(mesh.vertices - [0, 2, 0], axis=1) - 0.3).mean() < 0.002
    assert not mesh.watertight and mesh.vertices[:, 1].max() < 2.05
    assert (mesh.face_normals[:, 1] < 0.1).mean() > 0.99


def test_a_depth_image_has_z_up_and_its_mask_means_no_reading(monkeypatch):
    monkeypatch.setattr(clouds, "surface_of", lambda cloud: SHEET)
    rows, columns = np.mgrid[:40, :40] - 20
    depth = 1 - 0.01 * np.exp(-(rows**2 + columns**2) / 100)
    whole = cloud_of_depth(depth, 60, 60, 20, 20)
    assert whole.up == whole.part(np.arange(9)).up == "z" and Cloud(whole.points).up == ""
    half = cloud_of_depth(np.ma.masked_array(depth, columns > 0), 60, 60, 20, 20)
    assert half.points[:, 0].max() < 0 < whole.points[:, 0].max()
    assert as_stated(whole).up == "z" and as_stated(Cloud(whole.points, sensor=whole.sensor)).up == "auto"
