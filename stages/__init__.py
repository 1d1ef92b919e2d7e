"""The pipeline: one package per stage, in the order of the data; `engine` runs them, `report` shows their rows."""

import sys
from importlib.util import find_spec

if find_spec("omegaconf") is None:
    sys.exit("the pipeline needs its extra: pip install -e '.[pipeline]'")
