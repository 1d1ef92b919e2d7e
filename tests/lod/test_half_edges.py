"""Half-edges of any faces, against a table of edges."""

import numpy as np
import trimesh

from haptic_glance.lod.kernels import mesh as kernels

PARTS = trimesh.util.concatenate(
    [trimesh.creation.icosphere(subdivisions=2), trimesh.creation.torus(2.0, 0.5, major_sections=9, minor_sections=7)]
)
CLOSED, OPEN = PARTS.faces, np.delete(PARTS.faces, [3, 40, 41], axis=0)


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
            other, count = kernels.opposites(tails.astype(np.int32), len(PARTS.vertices), oriented)
            np.testing.assert_array_equal(other, wanted)
            assert count == sum(len(halves) for halves in edges.values() if len(halves) > 2)
