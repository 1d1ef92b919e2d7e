"""The documentation's own extension modules, importable as `_extensions`."""

import sys
from pathlib import Path

DOCS = Path(__file__).parents[2] / "docs"

if str(DOCS) not in sys.path:
    sys.path.append(str(DOCS))
