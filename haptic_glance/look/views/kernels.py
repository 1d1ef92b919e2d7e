"""Compiled kernels of the renderer: the nearest face and its shade at each pixel, and depths packed as bytes."""

import numpy as np

from haptic_glance.base.jit import cached_njit, greater, helper, lesser

kernel = cached_njit()

FLAT = 1e-12  # square pixels: a face seen from its edge has no single crossing point and counts as missed
SLACK = 1e-9  # of a face: a pixel on the edge of two faces belongs to both, whichever way rounding goes


@kernel
def rasterise(corners: np.ndarray, faces: np.ndarray, top: int, left: int, face: np.ndarray, depth: np.ndarray) -> None:
    """Writes the nearest face at each pixel centre of a box, the first of equals, and its depth.

    corners (n, 3) f8: row, column and depth of each vertex; faces (m, 3) i8. face (h, w) i4 and depth (h, w) f8: the
    box whose first pixel is (top, left), filled with -1 and infinity before. Both sides of a face count.
    """
    height, width = face.shape
    for f in range(len(faces)):
        i, j, k = faces[f, 0], faces[f, 1], faces[f, 2]  # numbers: a row is an object whose references numba counts
        r0, c0, z0 = corners[i, 0], corners[i, 1], corners[i, 2]
        r1, c1, z1 = corners[j, 0], corners[j, 1], corners[j, 2]
        r2, c2, z2 = corners[k, 0], corners[k, 1], corners[k, 2]
        area = (r1 - r0) * (c2 - c0) - (c1 - c0) * (r2 - r0)
        above = greater(int(np.ceil(lesser(lesser(r0, r1), r2) - SLACK)), top)
        below = lesser(int(np.floor(greater(greater(r0, r1), r2) + SLACK)), top + height - 1)
        if above > below or abs(area) <= FLAT:
            continue
        # The weights of the second and the third corner grow by these along a row and along a column.
        second_row, second_column = (c2 - c0) / area, (r0 - r2) / area
        third_row, third_column = (c0 - c1) / area, (r1 - r0) / area
        first_column = -second_column - third_column
        over = 1 / first_column, 1 / second_column, 1 / third_column
        step = second_column * (z1 - z0) + third_column * (z2 - z0)
        for row in range(above, below + 1):
            second = (row - r0) * second_row - c0 * second_column
            third = (row - r0) * third_row - c0 * third_column
            first = 1 - second - third
            low, high = _columns(second, second_column, over[1], float(left), float(left + width - 1))
            low, high = _columns(third, third_column, over[2], low, high)
            low, high = _columns(first, first_column, over[0], low, high)
            z = z0 + second * (z1 - z0) + third * (z2 - z0)
            y = np.uint64(row - top)  # unsigned: numba looks for no index from the end
            for column in range(int(np.ceil(low)), int(np.floor(high)) + 1):
                x, distance = np.uint64(column - left), z + column * step
                if distance < depth[y, x]:
                    depth[y, x], face[y, x] = distance, f


@helper
def _columns(start, slope, over, low, high):
    """The columns, between low and high, at which a weight start + column * slope is not below 0; over is 1 / slope."""
    end = (-SLACK - start) * over
    if slope > 0:
        low = greater(low, end)
    elif slope < 0:
        high = lesser(high, end)
    elif start < -SLACK:
        high = -1.0
    return low, high


@kernel
def shade_pixels(
    corners: np.ndarray, faces: np.ndarray, crosses: np.ndarray, groups: np.ndarray, normals: np.ndarray,
    colors: np.ndarray, grey: float, material: np.ndarray, back: np.ndarray, top: int, left: int, face: np.ndarray,
    rgb: np.ndarray,
) -> None:  # fmt: skip
    """Writes the shade of each pixel of a box on the object to rgb (h, w, 3) u1.

    corners, faces, face and the box as in `rasterise`. crosses (m, 3): the faces' normals, of any length. groups (m, 3)
    and normals (g, 3): the unit normal of each corner of a face. colors (n, 3) u1, or (0, 3) for the grey of a
    brightness in 0..255. material (4,): see haptic_glance.look.views.Material. back (3,): the direction towards the
    camera and its head light.
    """
    ambient, diffuse, specular, shininess = material[0], material[1], material[2], material[3]
    for i in range(face.shape[0]):
        for j in range(face.shape[1]):
            f = face[i, j]
            if f < 0:
                continue
            a, b, c = faces[f, 0], faces[f, 1], faces[f, 2]
            r0, c0 = corners[a, 0], corners[a, 1]
            br, bc, dr, dc = corners[b, 0] - r0, corners[b, 1] - c0, corners[c, 0] - r0, corners[c, 1] - c0
            over = 1 / (br * dc - bc * dr)
            p, q = (top + i - r0) * over, (left + j - c0) * over
            # On an edge rounding may lead out of the face: clipped.
            second = lesser(greater(dc * p - dr * q, 0.0), 1.0)
            third = lesser(greater(br * q - bc * p, 0.0), 1.0 - second)
            first = 1 - second - third
            u, v, w = groups[f, 0], groups[f, 1], groups[f, 2]
            x = first * normals[u, 0] + second * normals[v, 0] + third * normals[w, 0]
            y = first * normals[u, 1] + second * normals[v, 1] + third * normals[w, 1]
            z = first * normals[u, 2] + second * normals[v, 2] + third * normals[w, 2]
            towards = crosses[f, 0] * back[0] + crosses[f, 1] * back[1] + crosses[f, 2] * back[2]
            cosine = (x * back[0] + y * back[1] + z * back[2]) * (-1.0 if towards < 0 else 1.0)
            brightness = lesser(greater(cosine / greater(np.sqrt(x * x + y * y + z * z), 1e-300), 0.0), 1.0)
            light = ambient + diffuse * brightness
            highlight = 255 * specular * brightness**shininess if specular > 0 else 0.0
            shade = int(np.rint(lesser(grey * light + highlight, 255.0)))
            for channel in range(3):
                if len(colors):
                    value = first * colors[a, channel] + second * colors[b, channel] + third * colors[c, channel]
                    shade = int(np.rint(lesser(value * light + highlight, 255.0)))
                rgb[i, j, channel] = shade


@kernel
def background_colour(rgb: np.ndarray, mask: np.ndarray) -> tuple[np.ndarray, bool]:
    """((3,) u1 the first colour of rgb (h, w, 3) u1 off the mask (h, w), whether all pixels there have it).

    Black when the mask covers the image.
    """
    colour, has_colour = np.zeros(3, dtype=np.uint8), False
    for i in range(mask.shape[0]):
        for j in range(mask.shape[1]):
            if mask[i, j]:
                continue
            for k in range(3):
                if not has_colour:
                    colour[k] = rgb[i, j, k]
                elif rgb[i, j, k] != colour[k]:
                    return colour, False
            has_colour = True
    return colour, True


@kernel
def fold_depth(depth: np.ndarray, inside: np.ndarray, behind: float, step: float) -> np.ndarray:
    """(4, h * w) u1: the mixed second differences of a depth map in steps, near zero on a smooth surface.

    depth (h, w) f4; inside (h, w) boolean: the pixels that count; behind: the depth that the others get. The sign of a
    difference is in the lowest bit. Low bytes come first, so that high bytes are mostly zero.
    """
    height, width = depth.shape
    planes = np.empty((4, height * width), dtype=np.uint8)
    above = np.zeros(width + 1, dtype=np.int64)
    row = np.zeros(width + 1, dtype=np.int64)
    for i in range(height):
        for j in range(width):
            row[j + 1] = int(np.rint((depth[i, j] - behind) / step)) if inside[i, j] else 0
            bend = row[j + 1] - row[j] - above[j + 1] + above[j]
            folded = 2 * bend if bend >= 0 else -2 * bend - 1
            for byte in range(4):
                planes[byte, i * width + j] = folded >> (8 * byte) & 255
        above, row = row, above
    return planes


@kernel
def unfold_depth(planes: np.ndarray, inside: np.ndarray, behind: float, step: float, depth: np.ndarray) -> None:
    """Writes the depths that fold_depth folded to the pixels inside of depth (h, w) f4."""
    height, width = depth.shape
    above = np.zeros(width, dtype=np.int64)
    for i in range(height):
        risen = 0
        for j in range(width):
            folded = 0
            for byte in range(4):
                folded |= int(planes[byte, i * width + j]) << (8 * byte)
            risen += -(folded >> 1) - 1 if folded & 1 else folded >> 1
            above[j] += risen
            if inside[i, j]:
                depth[i, j] = behind + above[j] * step
