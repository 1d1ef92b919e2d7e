"""Kernels that a first run interprets while another process compiles them: both give the same numbers, bit for bit."""

import numpy as np
import pytest
import trimesh

from haptic_glance.base import kept
from haptic_glance.base.jit import UntilCompiledBeside
from haptic_glance.lod.kernels import mesh as kernels
from haptic_glance.mesh.kernels.planes import corner_weights

PARTS = trimesh.util.concatenate(
    [trimesh.creation.icosphere(subdivisions=2), trimesh.creation.torus(2.0, 0.5, major_sections=9, minor_sections=7)]
)
VERTICES = PARTS.vertices * [1.0, 0.7, 0.4] + 0.01 * np.sin(np.arange(3 * len(PARTS.vertices))).reshape(-1, 3)
CLOSED, OPEN = PARTS.faces, np.delete(PARTS.faces, [3, 40, 41], axis=0)


def answers(faces):
    """The results of all light kernels on the mesh with such faces."""
    corners = faces.astype(np.int32).ravel()
    other, count = kernels.opposites(corners, len(VERTICES), oriented=True)
    fan, fans = kernels.split_fans(corners, other)
    component, parts = kernels.face_components(other)
    volumes = kernels.signed_volumes(VERTICES, corners, other)
    faults = kernels.count_faults(VERTICES, corners, other, 0.3, 0.9)
    ids = np.arange(len(VERTICES), dtype=np.int32)
    compact = kernels.compact(corners, ids % 5 == 0, ids // 2, len(ids))
    weights = corner_weights(VERTICES[:50] + 0.1, np.arange(50), VERTICES, faces)
    return [other, count, fan, fans, component, parts, volumes, faults, *compact, weights]


@pytest.mark.parametrize("faces", [CLOSED, OPEN])
def test_interpreted_kernels_give_the_numbers_of_compiled_ones(faces, monkeypatch):
    compiled, used = answers(faces), set()
    interpret = UntilCompiledBeside.__call__

    def anew(self, *arguments):
        used.add(self.kernel.__name__)
        monkeypatch.setattr(self, "_waits", True)
        return interpret(self, *arguments)

    monkeypatch.setattr(UntilCompiledBeside, "__call__", anew)
    monkeypatch.setattr("haptic_glance.base.jit.is_kept", lambda *_: False)
    monkeypatch.setattr(kept.beside, "is_set", lambda: True)
    for first, second in zip(answers(faces), compiled, strict=True):
        np.testing.assert_array_equal(first, second)
    assert len(used) == 7


def test_half_edges_are_paired_where_two_faces_share_an_edge():
    generator = np.random.default_rng(0)
    soups = [generator.integers(0, 5, (int(generator.integers(1, 9)), 3)) for _ in range(300)]
    soups += [CLOSED, OPEN, CLOSED[:, ::-1], np.concatenate([CLOSED, CLOSED]), generator.permutation(CLOSED)]
    for faces in (soup[(soup != np.roll(soup, 1, axis=1)).all(axis=1)] for soup in soups):
        tails, heads = faces.ravel(), np.roll(faces, -1, axis=1).ravel()
        edges = {}
        for h, ends in enumerate(zip(tails.tolist(), heads.tolist(), strict=True)):
            edges.setdefault(frozenset(ends), []).append(h)
        for oriented in (True, False):
            wanted = np.full(len(tails), -1)
            for halves in edges.values():
                if len(halves) == 2 and not (oriented and tails[halves[0]] == tails[halves[1]]):
                    wanted[halves] = halves[::-1]
            other, count = kernels.opposites(tails.astype(np.int32), len(VERTICES), oriented)
            np.testing.assert_array_equal(other, wanted)
            assert count == sum(len(halves) for halves in edges.values() if len(halves) > 2)
