"""Surfaces to simplify: balls, tori, boxes, sheets and a tube with a picture."""

import numpy as np
import trimesh

from haptic_glance.mesh.mesh import Mesh, Texture
from tests.shapes import mesh_of


def ball(subdivisions=4, radius=0.5):
    """A closed ball of 20 * 4 ** subdivisions faces."""
    return mesh_of(trimesh.creation.icosphere(subdivisions, radius))


def torus():
    """A ring of 2,304 faces."""
    return mesh_of(trimesh.creation.torus(0.35, 0.15, major_sections=48, minor_sections=24))


def bumpy():
    """A ball of 5,120 faces with noise on its radius."""
    smooth = ball(radius=1.0)
    radius = 0.4 + 0.01 * np.random.default_rng(0).normal(size=len(smooth.vertices))
    return Mesh(smooth.vertices * radius[:, None], smooth.faces)


def subdivided_box(times=4):
    """A box whose sides are flat and of many faces."""
    box = trimesh.creation.box(extents=(0.6, 0.5, 0.4))
    for _ in range(times):
        box = box.subdivide()
    return mesh_of(box)


def sheet(side=48, paint=None, height=0.0):
    """A square of 2 side^2 faces over 0..1, flat or wavy by `height`, grey as paint(x, y) in 0..255 says."""
    x, y = np.meshgrid(np.arange(side + 1) / side, np.arange(side + 1) / side, indexing="ij")
    vertices = np.stack([x, y, height * np.sin(9 * x) * np.cos(7 * y)], axis=-1).reshape(-1, 3)
    a = np.arange((side + 1) ** 2).reshape(side + 1, side + 1)[:-1, :-1].ravel()
    faces = np.r_[np.c_[a, a + side + 1, a + side + 2], np.c_[a, a + side + 2, a + 1]]
    return Mesh(vertices, faces, None if paint is None else grey(paint(*vertices[:, :2].T)))


def grey(values):
    """(n, 3) the same value in three channels."""
    return np.repeat(np.rint(values).astype(np.uint8)[:, None], 3, axis=1)


def centres(mesh):
    """(m, 3) the middles of the faces."""
    return mesh.vertices[mesh.faces].mean(axis=1)


def nothing(mesh):
    """(m,) no face is frozen."""
    return np.zeros(len(mesh.faces), dtype=bool)


GREY = np.full((1, 1, 4), 128, np.uint8)  # a picture of one pixel


def tube(around=48, along=24):
    """A cylinder whose picture is wrapped round it once: one chart, a seam where its two ends meet, no end faces."""
    angle, height = np.meshgrid(np.arange(around), np.linspace(0, 1, along + 1), indexing="ij")
    turn = 2 * np.pi * angle / around
    vertices = np.stack([0.3 * np.cos(turn), 0.3 * np.sin(turn), height], axis=-1).reshape(-1, 3)
    at = np.arange(len(vertices)).reshape(around, along + 1)
    a, b = at[:, :-1].ravel(), np.roll(at, -1, axis=0)[:, :-1].ravel()
    faces = np.concatenate([np.stack([a, b, b + 1], 1), np.stack([a, b + 1, a + 1], 1)])
    u = (faces // (along + 1)) / around
    u[(u.max(axis=1) - u.min(axis=1) > 0.5)[:, None] & (u == 0)] = 1
    uv = np.stack([u, vertices[faces][:, :, 2]], axis=-1)
    return Mesh(vertices, faces, None, Texture(uv, np.zeros(len(faces)), (GREY,)))
