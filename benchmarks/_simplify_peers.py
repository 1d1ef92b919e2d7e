"""Simplifiers of others, for benchmarks.simplification, where they are installed.

`meshoptimizer` is the newest, which npm alone carries (1.3.0), as WebAssembly that `wasmtime` compiles for this
processor; `meshoptimizer_native` the newest that PyPI carries as machine code (0.2.30a0), through ctypes. Both take
single precision. The first moves vertices (simplifyWithUpdate), which the second cannot. VTK's and pyfqmr keep nothing.
"""

import ctypes
import importlib.util
import re
from pathlib import Path

import numpy as np

from haptic_glance.mesh.mesh import Mesh

LOCK = 1  # the bit of a vertex that meshoptimizer keeps
NO_LIMIT = 1e30  # of the error: the target alone decides
UNABLE = ("vtk", "pyfqmr", "fast_simplification")  # to keep vertices
PAGE = 65_536  # bytes of a WebAssembly memory page
NEEDS = {
    "meshoptimizer": "wasmtime", "meshoptimizer_native": "meshoptimizer", "vtk": "vtk", "pyfqmr": "pyfqmr",
    "fast_simplification": "fast_simplification",
}  # fmt: skip


def peers(javascript=None):
    """dict name -> backend(mesh, faces, frozen) of those that are installed; names the others, a line each.

    javascript: path of meshopt_simplifier.js in what `npm pack meshoptimizer` fetches.
    """
    made = {"meshoptimizer": lambda: Meshoptimizer(javascript), "meshoptimizer_native": meshoptimizer_native}
    made |= {"vtk": lambda: vtk, "pyfqmr": lambda: pyfqmr, "fast_simplification": lambda: fast_simplification}
    backends = {}
    for name, module in NEEDS.items():
        if importlib.util.find_spec(module) is None:
            print(f"{name} is left out: no module {module}")
        elif name == "meshoptimizer" and javascript is None:
            print(f"{name} is left out: --meshoptimizer names no meshopt_simplifier.js")
        else:
            backends[name] = made[name]()
    return backends


class Unseen(Mesh):
    """A mesh that equals itself alone: the library caches results of meshes and would find those of an equal one."""

    __eq__, __hash__ = object.__eq__, object.__hash__


def fresh(mesh, colors=None):
    """The same mesh, of which nothing is known yet."""
    return Unseen(mesh.vertices, mesh.faces, colors)


class Meshoptimizer:
    """meshopt_simplifyWithUpdate of the WebAssembly module in meshopt_simplifier.js."""

    def __init__(self, javascript):
        import wasmtime

        self.store = wasmtime.Store()
        module = wasmtime.Module(self.store.engine, unpacked(Path(javascript).read_text()))
        self.exports = wasmtime.Instance(self.store, module, []).exports(self.store)
        self._call("__wasm_call_ctors")

    def __call__(self, mesh, faces, frozen):
        """The mesh with so many faces, the corners of frozen faces locked."""
        bits = locks(mesh, frozen)
        ids, points = mesh.faces.astype(np.uint32), mesh.vertices.astype(np.float32)
        start = self._call("sbrk", 0)
        at, place, byte, error = (self._put(array) for array in (ids, points, bits, np.zeros(1, np.float32)))
        no_colours = 0, 0, 0, 0
        surface = at, ids.size, place, len(points), points.strides[0], *no_colours, byte if bits.any() else 0
        left = self._call("meshopt_simplifyWithUpdate", *surface, 3 * faces, NO_LIMIT, 0, error)
        points, ids = self._get(place, points), self._get(at, ids).ravel()[:left].reshape(-1, 3)
        self._call("sbrk", start - self._call("sbrk", 0))
        return in_use(points, ids)

    def _call(self, name, *values):
        return self.exports[name](self.store, *values)

    def _put(self, array):
        at = self._call("sbrk", -(-array.nbytes // 16) * 16)
        self._memory()[at : at + array.nbytes] = array.view(np.uint8).ravel()
        return at

    def _get(self, at, like):
        return self._memory()[at : at + like.nbytes].copy().view(like.dtype).reshape(like.shape)

    def _memory(self):
        memory = self.exports["memory"]
        first = ctypes.addressof(memory.data_ptr(self.store).contents)
        return np.frombuffer((ctypes.c_ubyte * (PAGE * memory.size(self.store))).from_address(first), np.uint8)


def unpacked(javascript):
    """The bytes of the module, which the file holds as letters: one for each of 60 frequent bytes, two for others."""
    numbers = re.findall(r"\d+", re.search(r"wasmpack = new Uint8Array\(\[([^]]*)", javascript)[1])
    letters = re.search(r"var wasm =\s*'([^']*)'", javascript)[1]
    codes = iter(ord(c) - 97 if c > "`" else ord(c) - 39 if c > "@" else ord(c) + 4 for c in letters)
    return bytes(int(numbers[code]) if code < 60 else 64 * (code - 60) + next(codes) for code in codes)


def meshoptimizer_native():
    """meshopt_simplifyWithAttributes of the library in PyPI's wheel, whose own binding ends in an ArgumentError."""
    folder = Path(importlib.util.find_spec("meshoptimizer").submodule_search_locations[0])
    run = ctypes.CDLL(str(next(folder.glob("_meshoptimizer*.so")))).meshopt_simplifyWithAttributes
    size, real, array = ctypes.c_size_t, ctypes.c_float, ctypes.c_void_p
    run.restype = size
    run.argtypes = [array, array, size, array, size, size, array, size, array, size, array, size, real, ctypes.c_uint,
                    array]  # fmt: skip

    def backend(mesh, faces, frozen):
        ids, points = mesh.faces.astype(np.uint32), mesh.vertices.astype(np.float32)
        corners, bits = np.empty_like(ids), locks(mesh, frozen)
        surface = corners.ctypes.data, ids.ctypes.data, ids.size, points.ctypes.data, len(points), points.strides[0]
        lock = bits.ctypes.data if bits.any() else None
        left = run(*surface, None, 0, None, 0, lock, 3 * faces, NO_LIMIT, 0, None)
        return in_use(points, corners.ravel()[:left].reshape(-1, 3))

    return backend


def locks(mesh, frozen):
    """(n,) u1: LOCK at the corners of frozen faces."""
    bits = np.zeros(len(mesh.vertices), np.uint8)
    bits[mesh.faces[frozen]] = LOCK
    return bits


def in_use(points, faces):
    """The Mesh of those points that have faces."""
    used = np.zeros(len(points), bool)
    used[faces] = True
    return Mesh(points[used], (np.cumsum(used) - 1)[faces])


def vtk(mesh, faces, _):
    """VTK's vtkQuadricDecimation, which knows shares of faces only."""
    from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy
    from vtkmodules.vtkCommonCore import vtkPoints
    from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
    from vtkmodules.vtkFiltersCore import vtkQuadricDecimation

    points, cells, surface, work = vtkPoints(), vtkCellArray(), vtkPolyData(), vtkQuadricDecimation()
    points.SetData(numpy_to_vtk(mesh.vertices))
    cells.SetData(3, numpy_to_vtkIdTypeArray(np.ascontiguousarray(mesh.faces, np.int64).ravel()))
    surface.SetPoints(points)
    surface.SetPolys(cells)
    work.SetInputData(surface)
    work.SetTargetReduction(1 - faces / len(mesh.faces))
    work.Update()
    reduced = work.GetOutput()
    ids = vtk_to_numpy(reduced.GetPolys().GetConnectivityArray()).reshape(-1, 3)
    return Mesh(vtk_to_numpy(reduced.GetPoints().GetData()), ids)


def pyfqmr(mesh, faces, _):
    """pyfqmr, as fast_simplification after Sp4cerat's Fast-Quadric-Mesh-Simplification."""
    from pyfqmr import Simplify

    work = Simplify()
    work.setMesh(mesh.vertices, mesh.faces)
    work.simplify_mesh(target_count=faces, verbose=False)
    vertices, left, _ = work.getMesh()
    return Mesh(vertices, left)


def fast_simplification(mesh, faces, _):
    """fast-simplification, which cannot keep anything."""
    from fast_simplification import simplify

    return Mesh(*simplify(mesh.vertices, mesh.faces.astype(np.int32), target_count=faces))
