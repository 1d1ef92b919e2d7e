import trimesh

from haptic_glance.mesh.mesh import Mesh


def as_mesh(shape: trimesh.Trimesh) -> Mesh:
    return Mesh(shape.vertices, shape.faces)
