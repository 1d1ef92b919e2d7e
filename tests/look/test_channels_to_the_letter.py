"""Every formula of T3.1.1 on inputs with an answer worked out by hand; beside the tests of the whole channels."""

import numpy as np
import pytest
import trimesh

from haptic_glance.look.channels import conspicuity, operators
from haptic_glance.look.channels.colour import LINEAR, MECHANISMS, RGB_TO_LMS, mechanisms, opponency
from haptic_glance.look.channels.kernels import mean_of_other_maxima
from haptic_glance.look.channels.operators import PEAK, centre_surround, expand, normalise, pyramid
from haptic_glance.look.channels.symmetry import shape_symmetries
from haptic_glance.look.channels.texture import (
    ANGLES,
    WINDOW,
    energy,
    laplacian_of_gaussian,
    local_entropy,
    local_variance,
)
from haptic_glance.look.views import View, Viewpoint, render
from haptic_glance.mesh.mesh import Mesh

TRIANGLE = Mesh([[0, -0.5, -0.5], [0, 0.5, -0.5], [0, 0, 0.5]], [[0, 1, 2]])
PAIRS = [(2, 5), (2, 6), (3, 6), (3, 7), (4, 7), (4, 8)]


def maps(rgb, *names):
    """Maps of an image that the object fills."""
    shape = rgb.shape[:2]
    view = View(rgb, np.full(shape, 10, np.float32), np.zeros(shape, np.int32), Viewpoint(0, 0))
    return conspicuity(TRIANGLE, view, names)


def grey(image):
    return np.asarray(image, dtype=np.uint8)[..., None].repeat(3, axis=2)


def everywhere(levels):
    return {scale: np.ones(levels[scale].shape, dtype=bool) for scale in (2, 3, 4)}


@pytest.fixture
def terms(monkeypatch):
    """What goes into N(.), call by call."""
    seen = []
    monkeypatch.setattr(operators, "normalise", lambda values, *rest: seen.append(values) or normalise(values, *rest))
    return seen


def test_centre_surround_has_the_six_terms_of_equation_3_1(terms):
    levels = pyramid(np.random.default_rng(0).random((512, 512)).astype(np.float32))
    centre_surround(levels, everywhere(levels))
    expected = [np.abs(levels[c] - expand(levels, s, c)) for c, s in PAIRS]
    assert len(terms) == 6 and sorted(levels) == list(range(9))
    for term, pair in zip(terms, expected, strict=True):
        np.testing.assert_array_equal(term, pair)


@pytest.mark.parametrize("scale", range(9))
def test_a_level_enters_the_terms_of_its_own_scale_alone(terms, scale):
    levels = pyramid(np.zeros((512, 512), dtype=np.float32))
    levels[scale][tuple(side // 2 for side in levels[scale].shape)] = 1
    centre_surround(levels, everywhere(levels))
    assert [bool(term.any()) for term in terms] == [scale in pair for pair in PAIRS]


@pytest.mark.parametrize("c", [2, 3, 4])
def test_a_blob_answers_most_at_the_pair_of_its_size(terms, c):
    # A blob of variance v keeps v / (v + (4^s - 1) / 3) of its height at scale s; the difference between two scales is
    # greatest where v is the geometric mean of what they add.
    variance = np.sqrt((4**c - 1) / 3 * (4 ** (c + 3) - 1) / 3)
    y, x = np.mgrid[:1024, :1024] - 512
    levels = pyramid(np.exp(-(y * y + x * x) / (2 * variance)).astype(np.float32))
    centre_surround(levels, everywhere(levels))
    assert np.argmax([term.max() for term in terms[::2]]) == c - 2
    middle = terms[2 * (c - 2)].shape[0] // 2
    assert terms[2 * (c - 2)].argmax() == middle * (2 * middle) + middle
    assert levels[c].max() == pytest.approx(variance / (variance + (4**c - 1) / 3), abs=0.02)


def test_n_of_a_map_of_three_peaks_by_hand():
    values = np.zeros((9, 21), dtype=np.float32)
    values[4, 4], values[4, 10], values[4, 16] = 5, 2, 1
    assert mean_of_other_maxima(values / 5, PEAK) == pytest.approx((0.4 + 0.2) / 2)
    np.testing.assert_allclose(normalise(values, np.ones_like(values, bool)), values / 5 * 0.7**2, rtol=1e-6)


def test_n_counts_peaks_at_the_border_and_none_under_a_tenth():
    values = np.zeros((9, 21), dtype=np.float32)
    values[4, 10], values[0, 0], values[4, 16] = 1, 0.5, 0.1
    assert mean_of_other_maxima(values, PEAK) == pytest.approx(0.5)


def test_n_wipes_out_two_peaks_of_one_height_but_not_one_that_touches_itself_at_a_corner():
    values = np.zeros((9, 21), dtype=np.float32)
    values[4, 4] = values[5, 5] = 1
    assert normalise(values, np.ones_like(values, bool)).max() == 1
    values[4, 16] = 1
    assert not normalise(values, np.ones_like(values, bool)).any()


@pytest.mark.parametrize("angle", ANGLES)
def test_gabor_answers_most_to_bars_that_lie_its_way(angle):
    y, x = np.mgrid[:48, :48].astype(np.float32)
    across = -y * np.cos(np.radians(angle)) - x * np.sin(np.radians(angle))  # rows run down, angles against the clock
    bars = np.cos(np.pi / 2 * across).astype(np.float32)
    energies = {other: energy(bars, other)[12:36, 12:36] for other in ANGLES}
    for other in set(ANGLES) - {angle}:
        assert energies[angle].min() > 4 * energies[other].max()


@pytest.mark.parametrize("angle", ANGLES)
def test_orientation_of_a_line_is_its_gabors(angle):
    line = np.zeros((48, 48), dtype=np.float32)
    k = np.arange(-20, 21)
    rows = np.rint(24 - k * np.sin(np.radians(angle))).astype(int)
    line[rows, np.rint(24 + k * np.cos(np.radians(angle))).astype(int)] = 1
    assert max(ANGLES, key=lambda other: energy(line, other)[24, 24]) == angle


@pytest.mark.parametrize(
    ("rgb", "answer"),
    {
        "red": ((255, 0, 0), (1, 0)),
        "green": ((0, 255, 0), (-1, 0)),
        "blue": ((0, 0, 255), (0, 1)),
        "yellow": ((255, 255, 0), (0, -1)),
        "white": ((255, 255, 255), (0, 0)),
        "grey": ((90, 90, 90), (0, 0)),
        "orange": ((255, 153, 0), (0.7 - 0.1, -0.6)),  # R = 1 - 0.3, G = 0.6 - 0.5, Y = 0.8 - 0.2
    }.values(),
)
def test_opponency_by_hand(rgb, answer):
    found = opponency(np.full((2, 2, 3), rgb, dtype=np.uint8))
    np.testing.assert_allclose([plane[0, 0] for plane in found], answer, atol=1e-6)


@pytest.mark.parametrize(("around", "dot"), [((40, 160, 40), (160, 40, 40)), ((150, 150, 20), (20, 20, 220))])
def test_a_dot_of_the_opponent_colour_is_the_only_peak_of_color(around, dot):
    rgb = np.full((300, 400, 3), around, dtype=np.uint8)
    rgb[140:160, 260:280] = dot
    found = maps(rgb, "color")["color"]
    peak = np.array(np.unravel_index(found.argmax(), found.shape)) * 4 + 1.5
    assert found.max() > 0.5 and np.abs(peak - (149.5, 269.5)).max() < 12


def test_a_lighter_dot_on_grey_has_no_color():
    rgb = np.full((300, 400, 3), 90, dtype=np.uint8)
    rgb[140:160, 260:280] = 200
    assert not maps(rgb, "color")["color"].any()


def test_dkl_is_the_cited_matrix_and_its_white_is_a_hundred():
    # Vienot, Brettel and Mollon 1999, equation 4: L + M of the white is 100.
    np.testing.assert_allclose(RGB_TO_LMS[:2].sum(), 100, atol=0.01)
    np.testing.assert_allclose(MECHANISMS[0], RGB_TO_LMS[:2].sum(axis=0) / RGB_TO_LMS[:2].sum())
    cones = np.linalg.solve(RGB_TO_LMS.T, MECHANISMS.T).T  # the mechanisms as sums of L, M, S
    np.testing.assert_allclose(cones[1, 2], 0, atol=1e-12)
    assert cones[1, 0] > 0 > cones[1, 1] and cones[2, 2] > 0 > cones[2, 0] == pytest.approx(cones[2, 1])


def test_dkl_of_greys_is_luminance_alone_and_rises_with_it():
    levels = np.arange(256)
    found = mechanisms(LINEAR.astype(np.float32)[grey(levels[None])])[0]
    assert (np.diff(found[:, 0]) > 0).all() and found[0, 0] == 0 and found[-1, 0] == pytest.approx(1)
    assert np.abs(found[:, 1:]).max() < 1e-6


def test_contrast_of_a_step_is_p_times_one_minus_p():
    side = round(WINDOW * 900)
    assert side == 80
    low, high = 60, 160
    image = np.where(np.arange(300) < 150, low, high).astype(np.uint8)[None].repeat(90, axis=0)
    found = local_variance(image, np.ones(image.shape, dtype=bool), side)[45]
    share = np.array([(np.arange(x - 40, x + 40) >= 150).mean() for x in range(300)])
    np.testing.assert_allclose(found[40:-40], (share * (1 - share) * ((high - low) / 255) ** 2)[40:-40], atol=1e-7)
    assert not found[:110].any() and found[150] == pytest.approx((100 / 255) ** 2 / 4, rel=1e-6)


def test_the_contrast_of_a_view_of_900_rows_reaches_forty_pixels():
    image = np.where(np.arange(1200) < 600, 60, 160)[None].repeat(900, axis=0)
    found = maps(grey(image), "contrast")["contrast"]
    row = found[112] / found.max()
    assert abs(row.argmax() * 4 + 1.5 - 599.5) < 9
    half = np.flatnonzero(row > 0.5) * 4 + 1.5
    # p (1 - p) is half of its height where p is (1 - 1 / sqrt(2)) / 2, that is 28 pixels from the step.
    assert abs(600 - half[0] - 28) < 6 and abs(half[-1] - 600 - 28) < 6
    assert row[: (600 - 40 - 24) // 4].max() < 0.01


def test_two_levels_as_likely_are_one_bit_and_four_are_two():
    y, x = np.mgrid[:30, :30] >= 15
    counted = np.ones(x.shape, dtype=bool)
    counted[19] = counted[:, 19] = False  # the last row and column of the window round (15, 15): 8 x 8 are left
    for levels, bits in ((x, 1), (2 * y + x, 2)):
        image = (levels * 60).astype(np.uint8)
        found = local_entropy(image, counted, np.array([15]), np.array([15]))[0]
        assert found == pytest.approx(bits, abs=1e-6)


def test_a_lone_salt_pixel_is_no_entropy_but_a_block_is():
    image = np.full((300, 400), 120)
    image[150, 200] = 255
    assert local_entropy(image.astype(np.uint8), image > 0, np.array([150]), np.array([200]))[0] > 0
    assert not maps(grey(image), "entropy")["entropy"].any()
    image[149:152, 199:202] = 255
    found = maps(grey(image), "entropy")["entropy"]
    assert np.hypot(*(np.array(np.unravel_index(found.argmax(), found.shape)) * 4 + 1.5 - (150, 200))) < 12


@pytest.mark.parametrize("sigma", [2, 4])
def test_log_of_a_step_crosses_zero_at_the_step_and_peaks_one_sigma_beside_it(sigma):
    image = np.where(np.arange(120) < 60, 20, 220).astype(np.uint8)[None].repeat(40, axis=0)
    row = laplacian_of_gaussian(image, sigma)[20]
    assert abs(row.argmax() - (59.5 - sigma)) <= 0.5 and abs(row.argmin() - (59.5 + sigma)) <= 0.5
    assert row[59] > 0 > row[60] and row[59] == pytest.approx(-row[60], rel=1e-3)
    assert np.abs(row[59 - 5 * sigma]) < 1e-3 * row.max()


def test_edges_of_a_shaded_slope_are_none():
    slope = np.linspace(40, 200, 400)[None].repeat(300, axis=0)
    step = slope.copy()
    step[140:160, 240:260] += 40
    found = maps(grey(step), "edge")["edge"]
    assert np.abs(np.array(np.unravel_index(found.argmax(), found.shape)) * 4 + 1.5 - (149.5, 249.5)).max() < 16
    assert maps(grey(slope), "edge")["edge"].max() < 0.05 and found.max() > 0.5


def test_of_two_balls_the_smaller_stands_out_in_curvature():
    ball = trimesh.creation.icosphere(subdivisions=4)
    v, f = ball.vertices, ball.faces
    mesh = Mesh(np.r_[v * 0.2 - [0, 0.22, 0], v * 0.1 + [0, 0.3, 0]], np.r_[f, f + len(v)])
    found = conspicuity(mesh, render(mesh, Viewpoint(0, 0), (300, 400), "raster"), ["curvature"])["curvature"]
    assert found[:, 60:].max() > 1.8 * found[:, :55].max() > 0


def test_a_prism_of_five_sides_has_one_axis_and_five_planes_through_it():
    angle = 2 * np.pi * np.arange(5) / 5
    outline = np.c_[0.35 * np.cos(angle), 0.35 * np.sin(angle)]
    v = np.r_[np.c_[outline, np.full(5, -0.3)], np.c_[outline, np.full(5, 0.3)], [[0, 0, -0.3], [0, 0, 0.3]]]
    k, n = np.arange(5), (np.arange(5) + 1) % 5
    sides = np.r_[np.c_[k, n, n + 5], np.c_[k, n + 5, k + 5]]
    found = shape_symmetries(Mesh(v, np.r_[sides, np.c_[n, k, k * 0 + 10], np.c_[k + 5, n + 5, k * 0 + 11]]))
    ((axis, score, revolves),) = [each for each in found.axes if abs(each[0][2]) > 0.99]
    assert score > 0.9 and not revolves
    upright = [normal for normal, _, _ in found.planes if abs(normal[2]) < 0.05]
    turns = np.degrees([np.arctan2(normal[1], normal[0]) for normal in upright]) % 36
    np.testing.assert_allclose(turns, [18] * 5, atol=2.5)
