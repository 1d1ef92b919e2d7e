"""The pipeline: one package per stage, in the order of the data; `engine` runs them, `report` shows their rows."""

import sys

try:
    import omegaconf  # noqa: F401
except ModuleNotFoundError:
    sys.exit("the pipeline needs its extra: pip install -e '.[pipeline]'")
