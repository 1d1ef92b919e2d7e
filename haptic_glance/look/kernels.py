"""Compiled kernels of detectors and rivals: descriptors of points, sums over neighbours, maxima, spacing."""

import math

import numpy as np

from haptic_glance.base.jit import kernel_of

kernel = kernel_of(__file__)

BINS = 11  # per angle; an odd number, so that a plane lies in the middle of one


@kernel
def fpfh(positions: np.ndarray, normals: np.ndarray, neighbours: np.ndarray, starts: np.ndarray) -> np.ndarray:
    """(n, 33) histograms of three angles, each of sum one, of positions (n, 3) with unit normals (n, 3).

    neighbours: of point i, those at starts[i] to starts[i + 1], which may hold i. A point without neighbours, or with a
    zero normal, has zeros. Source: Rusu, Blodow, Beetz, Fast point feature histograms (FPFH) for 3D registration, ICRA
    2009, with the weights 1 / distance^2 of the Point Cloud Library, which do not depend on the unit of length.
    """
    spfh, result = np.zeros((len(positions), 3 * BINS)), np.zeros((len(positions), 3 * BINS))
    for i in range(len(positions)):
        for j in neighbours[starts[i] : starts[i + 1]]:
            _count(spfh[i], positions[j] - positions[i], normals[i], normals[j])
        _normalise(spfh[i])
    for i in range(len(positions)):
        for j in neighbours[starts[i] : starts[i + 1]]:
            line = positions[j] - positions[i]
            square = _dot(line, line)
            if square > 0:
                result[i] += spfh[j] / square
        _normalise(result[i])
        result[i] += spfh[i]
        _normalise(result[i])
    return result


@kernel
def _count(histogram, line, first, second):
    """Adds the three angles of a pair of normals to a histogram; the pair's frame is of the one nearer to the line."""
    length = math.sqrt(_dot(line, line))
    if length == 0:
        return
    line = line / length
    source, target, along = first, second, _dot(first, line)
    if abs(_dot(second, line)) > abs(along):
        source, target, line, along = second, first, -line, -_dot(second, line)
    v = _cross(line, source)
    size = math.sqrt(_dot(v, v))
    if size < 1e-9 or not _dot(target, target) > 0:
        return
    turn = math.atan2(_dot(_cross(source, v), target) / size, _dot(source, target))
    for k, share in enumerate((turn / math.pi, _dot(v, target) / size, along)):
        histogram[k * BINS + min(max(int((share + 1) / 2 * BINS), 0), BINS - 1)] += 1


@kernel
def _normalise(histogram):
    """Gives each of the three histograms the sum one, in place, where it holds anything."""
    for k in range(0, 3 * BINS, BINS):
        total = histogram[k : k + BINS].sum()
        if total > 0:
            histogram[k : k + BINS] /= total


@kernel
def _dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@kernel
def _cross(a, b):
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


FINEST = 128  # cells along the longest side, so that a small sigma does not ask for a grid that fills the memory


@kernel
def gaussian_sums(places: np.ndarray, points: np.ndarray, values: np.ndarray, sigma: float) -> np.ndarray:
    """(n, d) f8: at each of places (n, 3) the sum of values (s, d) times exp(-distance^2 / (2 sigma^2)) within 2 sigma.

    points (s, 3) f8, where the values are.
    """
    sums, reach = np.zeros((len(places), values.shape[1])), 2 * sigma
    if len(points) == 0:
        return sums
    low, high = np.empty(3), np.empty(3)
    for axis in range(3):
        low[axis], high[axis] = points[:, axis].min(), points[:, axis].max()
    cell = max(sigma, (high - low).max() / FINEST)
    shape = ((high - low) / cell).astype(np.int64) + 1
    order, starts = _sorted_by_cell(points, low, cell, shape)
    first, last = np.empty(3, np.int64), np.empty(3, np.int64)
    for i in range(len(places)):
        x, y, z = places[i]
        for axis in range(3):
            first[axis] = max(int(np.floor((places[i, axis] - reach - low[axis]) / cell)), 0)
            last[axis] = min(int(np.floor((places[i, axis] + reach - low[axis]) / cell)), shape[axis] - 1)
        if first[0] > last[0]:
            continue
        for a in range(first[2], last[2] + 1):
            for b in range(first[1], last[1] + 1):
                row = (a * shape[1] + b) * shape[0]
                for k in order[starts[row + first[0]] : starts[row + last[0] + 1]]:
                    square = (points[k, 0] - x) ** 2 + (points[k, 1] - y) ** 2 + (points[k, 2] - z) ** 2
                    if square <= reach * reach:
                        weight = np.exp(square / (-2 * sigma * sigma))
                        for column in range(values.shape[1]):
                            sums[i, column] += weight * values[k, column]
    return sums


@kernel
def _sorted_by_cell(points, low, cell, shape):
    """(ids of the points cell by cell, start of each cell's ids and one more at the end)."""
    at = np.empty(len(points), np.int64)
    starts = np.zeros(shape[0] * shape[1] * shape[2] + 1, np.int64)
    for k in range(len(points)):
        x, y, z = ((points[k] - low) / cell).astype(np.int64)
        at[k] = (z * shape[1] + y) * shape[0] + x
        starts[at[k] + 1] += 1
    for k in range(1, len(starts)):
        starts[k] += starts[k - 1]
    order, free = np.empty(len(points), np.int64), starts.copy()
    for k in range(len(points)):
        order[free[at[k]]] = k
        free[at[k]] += 1
    return order, starts


@kernel
def scale_peaks(values: np.ndarray, floor: float) -> np.ndarray:
    """(k,) i8 flat ids, in order, of values (scales, a, b, c) above `floor` that no neighbour of 80 exceeds.

    The first and the last scale have none. At the border of the grid there are fewer neighbours.
    """
    scales, a, b, c = values.shape
    peaks = []
    for s in range(1, scales - 1):
        for i in range(a):
            for j in range(b):
                for k in range(c):
                    value = values[s, i, j, k]
                    if value > floor and not _exceeded(values, value, s, i, j, k):
                        peaks.append(((s * a + i) * b + j) * c + k)
    return np.array(peaks, dtype=np.int64)


@kernel
def _exceeded(values, value, s, i, j, k):
    _, a, b, c = values.shape
    for scale in range(s - 1, s + 2):
        for x in range(max(i - 1, 0), min(i + 2, a)):
            for y in range(max(j - 1, 0), min(j + 2, b)):
                for z in range(max(k - 1, 0), min(k + 2, c)):
                    if values[scale, x, y, z] > value:
                        return True
    return False


EDGE_ON = 0.02  # cosine between the normals of a disc and of an array below which the array does not meet the disc


@kernel
def pressed(
    points: np.ndarray, normals: np.ndarray, radii: np.ndarray, axes: np.ndarray, at: np.ndarray, cells: int,
    width: float,
) -> np.ndarray:  # fmt: skip
    """(k, cells, cells) distances below arrays of a width at points `at` (k,), whose axes (k, 3, 3) are their own.

    Each of the points (s, 3) stands for a disc of its radius, perpendicular to its normal. Of the discs that a cell
    meets from outside, the nearest one counts; a cell that meets none within the width reports the width.
    """
    step, half = width / cells, width / 2
    depths = np.full((len(at), cells, cells), width)
    for i in range(len(at)):
        right, up, out = axes[i, 0], axes[i, 1], axes[i, 2]
        for j in range(len(points)):
            x, y, z = points[j, 0] - points[at[i], 0], points[j, 1] - points[at[i], 1], points[j, 2] - points[at[i], 2]
            reach = radii[j]
            height = out[0] * x + out[1] * y + out[2] * z
            if abs(height) > width + reach:
                continue
            u = right[0] * x + right[1] * y + right[2] * z
            if abs(u) > half + reach:
                continue
            v = up[0] * x + up[1] * y + up[2] * z
            if abs(v) > half + reach:
                continue
            x, y, z = normals[j, 0], normals[j, 1], normals[j, 2]
            facing = out[0] * x + out[1] * y + out[2] * z
            if facing <= EDGE_ON:
                continue
            slope_u = (right[0] * x + right[1] * y + right[2] * z) / facing
            slope_v = (up[0] * x + up[1] * y + up[2] * z) / facing
            left = max(int(math.ceil((u - reach + half) / step - 0.5)), 0)
            end = min(int(math.floor((u + reach + half) / step - 0.5)), cells - 1)
            top = max(int(math.ceil((half - v - reach) / step - 0.5)), 0)
            bottom = min(int(math.floor((half - v + reach) / step - 0.5)), cells - 1)
            for column in range(left, end + 1):
                du = (column + 0.5) * step - half - u
                for row in range(top, bottom + 1):
                    dv = half - (row + 0.5) * step - v
                    rise = -(slope_u * du + slope_v * dv)
                    below = -(height + rise)
                    if du * du + dv * dv + rise * rise <= reach * reach and abs(below) < abs(depths[i, row, column]):
                        depths[i, row, column] = below
    return depths


@kernel
def spaced(positions: np.ndarray, radius: float, first: int, limit: int) -> np.ndarray:
    """Indices of positions (k, 3), in order, each farther than radius from all before it; the `first` ones stay.

    limit: stop at so many.
    """
    kept, count = np.empty(len(positions), np.int64), 0
    for i in range(len(positions)):
        if count >= max(limit, first):
            break
        if i < first or _apart(positions, i, kept[:count], radius):
            kept[count] = i
            count += 1
    return kept[:count]


@kernel
def _apart(positions, i, earlier, radius):
    for k in earlier:
        square = 0.0
        for axis in range(3):
            square += (positions[k, axis] - positions[i, axis]) ** 2
        if square <= radius**2:
            return False
    return True


@kernel
def spin_images(
    positions: np.ndarray, areas: np.ndarray, centres: np.ndarray, normals: np.ndarray, radius: float, bins: int
) -> np.ndarray:
    """(k, 2 bins, bins) shares of the area around each of k centres (k, 3) with normals (k, 3).

    Rows are heights over the tangent plane from -radius to radius, columns distances from the normal's line up to it.
    positions (n, 3) with areas (n,) make up the surface; each within radius counts in the four bins around it. An image
    sums to one, or to zero where nothing is near. Source: Johnson and Hebert, Using spin images for efficient object
    recognition in cluttered 3D scenes, PAMI 21(5), 1999.
    """
    images = np.zeros((len(centres), 2 * bins, bins))
    for k in range(len(centres)):
        for i in range(len(positions)):
            square, height = 0.0, 0.0
            for axis in range(3):
                side = positions[i, axis] - centres[k, axis]
                square += side * side
                height += side * normals[k, axis]
            if square <= radius**2:
                aside = math.sqrt(max(square - height * height, 0.0))
                _add(images[k], (height / radius + 1) * bins - 0.5, aside / radius * bins - 0.5, areas[i])
        total = images[k].sum()
        if total > 0:
            images[k] /= total
    return images


@kernel
def _add(image, row, column, amount):
    """Shares an amount among the four bins around a place; what falls off the edge goes to the bin there."""
    first, left = math.floor(row), math.floor(column)
    for i, down in ((first, first + 1 - row), (first + 1, row - first)):
        for j, right in ((left, left + 1 - column), (left + 1, column - left)):
            place = min(max(i, 0), len(image) - 1), min(max(j, 0), image.shape[1] - 1)
            image[place] += amount * down * right


@kernel
def splat(places: np.ndarray, values: np.ndarray, shape: tuple[int, int, int]) -> np.ndarray:
    """(d, a, b, c) f8 sums of values (s, d) over the eight grid points nearest to each of places (s, 3), by nearness.

    places are in steps of the grid; all of these grid points must lie in its shape (a, b, c).
    """
    field = np.zeros((values.shape[1], *shape))
    for i in range(len(places)):
        x, y, z = np.floor(places[i]).astype(np.int64)
        for a in range(2):
            for b in range(2):
                for c in range(2):
                    near = abs(1 - a - (places[i, 0] - x))
                    near *= abs(1 - b - (places[i, 1] - y))
                    near *= abs(1 - c - (places[i, 2] - z))
                    for column in range(values.shape[1]):
                        field[column, x + a, y + b, z + c] += near * values[i, column]
    return field


@kernel
def suppress(image: np.ndarray, radius: float, limit: int, floor: float) -> np.ndarray:
    """(k,) i8 flat ids of at most `limit` maxima above `floor`, each outside the discs around those before it.

    image (h, w) f8 is set to zero within `radius` pixels of each. Of equal pixels the first one is taken.
    """
    height, width = image.shape
    extent, maxima = int(radius), []
    tops, firsts = np.empty(height), np.empty(height, np.int64)  # largest value of each row, and its column
    for r in range(height):
        firsts[r] = image[r].argmax()
        tops[r] = image[r, firsts[r]]
    while len(maxima) < limit:
        row = tops.argmax()
        if tops[row] <= floor:
            break
        column = firsts[row]
        maxima.append(row * width + column)
        for r in range(max(row - extent, 0), min(row + extent + 1, height)):
            for c in range(max(column - extent, 0), min(column + extent + 1, width)):
                if (r - row) ** 2 + (c - column) ** 2 <= radius**2:
                    image[r, c] = 0.0
            firsts[r] = image[r].argmax()
            tops[r] = image[r, firsts[r]]
    return np.array(maxima, dtype=np.int64)
