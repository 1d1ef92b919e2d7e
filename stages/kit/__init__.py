"""What several stages share: mesh arrays, camera, rays, files, params, parallel map, statistics.

The kit imports no stage. Its geometry speaks arrays only; embree, joblib and OmegaConf stay inside the file that
adapts them.
"""

from .camera import Viewpoint
from .mesh import Mesh
from .parallel import parallel_map
from .params import params
from .rays import RayScene
from .run import StageRun, arguments
from .timing import Stopwatch

__all__ = ["Mesh", "RayScene", "StageRun", "Stopwatch", "Viewpoint", "arguments", "parallel_map", "params"]
