"""Every kind of OFF file that Geomview defines is read, with its exact counts; what is no OFF has a reason."""

import numpy as np
import pytest

from haptic_glance.mesh import MeshError, load
from haptic_glance.mesh.off import read_off

SQUARE = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n"
TRIANGLES = "3 0 1 2\n3 0 2 3\n"
FOUR = [line.split() for line in SQUARE.splitlines()]
BIG = ">i4"


def rows(*more):
    """The four vertices of the square, each followed by more numbers."""
    return "\n".join(" ".join([*row, *more]) for row in FOUR) + "\n"


def binary(keyword, extra, faces):
    vertices = np.column_stack([np.array(FOUR, dtype=float), np.tile(extra, (4, 1))]).astype(">f4")
    head = f"{keyword} BINARY\n".encode() + np.array([4, len(faces), 0], dtype=BIG).tobytes()
    tail = b"".join(np.array([len(ids), *ids, len(color)], dtype=BIG).tobytes()
                    + np.array(color, dtype=">f4").tobytes() for ids, color in faces)  # fmt: skip
    return head + vertices.tobytes() + tail


VALID = {  # name: (content, faces)
    "plain": ("OFF\n4 2 0\n" + SQUARE + TRIANGLES, 2),
    "no keyword": ("# a pencil\n4 2 0 # counts\n" + SQUARE + TRIANGLES, 2),
    "no count of edges": ("OFF\n4 2\n" + SQUARE + TRIANGLES, 2),
    "counts on the first line": ("OFF 4 2 0\n" + SQUARE + TRIANGLES, 2),
    "counts behind the word, as ModelNet has them": ("OFF4 2 0\n" + SQUARE + TRIANGLES, 2),
    "comments": (f"# a scanner\n#OFF\nOFF # kind\n# counts\n4 2 0 # two\n{SQUARE}# faces\n{TRIANGLES}", 2),
    "blank lines": ("\nOFF\n\n4 2 0\n\n" + SQUARE.replace("\n", "\n\n") + "\n" + TRIANGLES, 2),
    "carriage returns": (("OFF\n4 2 0\n" + SQUARE + TRIANGLES).replace("\n", "\r\n"), 2),
    "no last newline": (("OFF\n4 2 0\n" + SQUARE + TRIANGLES).rstrip(), 2),
    "tabs": (("OFF\n4 2 0\n" + SQUARE + TRIANGLES).replace(" ", "\t  "), 2),
    "a square": ("OFF\n4 1 4\n" + SQUARE + "4 0 1 2 3\n", 2),
    "mixed polygons": ("OFF\n4 3 0\n" + SQUARE + "3 0 1 2\n4 0 1 2 3\n3 0 2 3\n", 4),
    "a pentagon": ("OFF\n5 1 0\n" + SQUARE + "-1 0.5 0\n5 0 1 2 3 4\n", 3),
    "a point and a line": ("OFF\n4 4 0\n" + SQUARE + "1 0\n2 0 1\n" + TRIANGLES, 2),
    "faces coloured by integers": ("OFF\n4 2 0\n" + SQUARE + "3 0 1 2 255 0 0\n3 0 2 3 0 255 0 255\n", 2),
    "faces coloured by floats": ("OFF\n4 2 0\n" + SQUARE + "3 0 1 2 1.0 0.5 0\n3 0 2 3 0.1 0.2 0.3 1\n", 2),
    "faces coloured by index": ("OFF\n4 2 0\n" + SQUARE + "3 0 1 2 7\n3 0 2 3\n", 2),
    "colours": ("COFF\n4 2 0\n" + rows("255", "128", "0", "255") + TRIANGLES, 2),
    "normals": ("NOFF\n4 2 0\n" + rows("0", "0", "1") + TRIANGLES, 2),
    "texture": ("STOFF\n4 2 0\n" + rows("0.5", "0.5") + TRIANGLES, 2),
    "all of them": ("STCN4OFF\n4 2 0\n" + rows("1", "0", "0", "1", "1", "0.5", "0", "1", "0", "0") + TRIANGLES, 2),
    "four coordinates": ("4OFF\n4 2 0\n" + rows("1") + TRIANGLES, 2),
    "three of n coordinates": ("nOFF\n3\n4 2 0\n" + SQUARE + TRIANGLES, 2),
    "colours of OFF": ("OFF\n4 2 0\n" + rows("255", "128", "0") + TRIANGLES, 2),
    "binary": (binary("OFF", [], [([0, 1, 2], []), ([0, 2, 3], [1, 0, 0])]), 2),
    "binary polygon with colours": (binary("COFF", [1, 0.5, 0, 1], [([0, 1, 2, 3], [])]), 2),
}  # fmt: skip


def read(content):
    return read_off(content if isinstance(content, bytes) else content.encode())


@pytest.mark.parametrize("kind", VALID)
def test_every_kind_is_read(kind, tmp_path):
    content, faces = VALID[kind]
    path = tmp_path / "square.off"
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    mesh = load(path)
    assert len(mesh.vertices) == 4 + (kind == "a pentagon") and len(mesh.faces) == faces
    np.testing.assert_array_equal(mesh.vertices[:4], np.array(FOUR, dtype=float))
    if kind not in ("mixed polygons", "a pentagon"):
        assert mesh.faces.tolist() == [[0, 1, 2], [0, 2, 3]]


@pytest.mark.parametrize("kind", ["colours", "all of them", "binary polygon with colours"])
def test_colours_of_vertices_are_bytes(kind):
    assert read(VALID[kind][0])[2].tolist() == [[255, 128, 0]] * 4


def test_the_fourth_coordinate_divides_the_others():
    content = "4OFF\n4 2 0\n" + rows("2") + TRIANGLES
    np.testing.assert_array_equal(read(content)[0], np.array(FOUR, dtype=float) / 2)


REFUSED = {
    "PLY\n4 2 0\n": "does not begin with the word OFF",
    "OFFSET\n4 2 0\n": "does not begin with the word OFF",
    "OFF\n": "numbers of vertices and faces are missing",
    "OFF\n4\n": "numbers of vertices and faces are missing",
    "OFF\n4 -2 0\n" + SQUARE: "truncated",
    "OFF\n4 3 0\n" + SQUARE + TRIANGLES: "4 vertices and 3 faces, 6 lines follow",
    "OFF\n4 1 0\n" + SQUARE + "4 0 1 2\n": "fewer vertices than it states",
    "OFF\n4 1 0\n" + SQUARE + "-1 0 1 2\n": "fewer vertices than it states",
    "OFF\n4 1 0\n" + SQUARE + "3 0 1 x\n": "invalid literal",
    "COFF\n4 2 0\n" + SQUARE + TRIANGLES: "fewer than 6 numbers",
    "nOFF\n5\n4 2 0\n" + SQUARE + TRIANGLES: "5 dimensions",
    "OFF BINARY\n1234": "truncated",
    binary("OFF", [], [([0, 1, 2], [])])[:-8]: "truncated",
}


@pytest.mark.parametrize("content", REFUSED)
def test_another_file_has_its_reason(content):
    with pytest.raises(MeshError, match=REFUSED[content]):
        read(content)
