"""What several stages share: mesh arrays, camera, rays, files, settings, parallel map, statistics.

The kit imports no stage. Its geometry speaks arrays only; embree, joblib and OmegaConf stay inside the file that
adapts them. What only the pipeline needs is imported from its file: `stages.kit.run`, `stages.kit.workspace`.
"""

from .camera import Viewpoint
from .mesh import Mesh
from .rays import RayScene
from .timing import Stopwatch

__all__ = ["Mesh", "RayScene", "Stopwatch", "Viewpoint"]
