"""All settings of the stages with their defaults and meaning, as one table a stage.

```{settings}
```
"""

from dataclasses import fields

import yaml
from docutils import nodes
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective

from stages.engine.settings import defaults_of
from stages.pipeline import STAGES

from .tables import made_table

BY_OPTION = "set by an option or a data set"


def setup(app: Sphinx) -> dict[str, bool]:
    """Adds the directive."""
    app.add_directive("settings", SettingsTable)
    return {"parallel_read_safe": True, "parallel_write_safe": True}


def settings() -> dict[str, dict[str, tuple[str, str]]]:
    """{stage: {setting: (default, meaning)}} of all stages."""
    sections = {}
    for name, stage in STAGES.items():
        defaults = defaults_of(stage.Params)
        sections[name] = {
            each.name: (flow(defaults[each.name]) if each.name in defaults else BY_OPTION, each.metadata["meaning"])
            for each in fields(stage.Params)
        }
    return sections


def flow(value: object) -> str:
    """A default in one line of YAML."""
    return yaml.safe_dump(value, default_flow_style=True, width=10**6, sort_keys=False).removesuffix("...\n").strip()


class SettingsTable(SphinxDirective):
    """A table for each section."""

    def run(self) -> list[nodes.Node]:
        """A heading and a table for each section."""
        made: list[nodes.Node] = []
        for section, entries in settings().items():
            rows = [
                (nodes.literal(text=name), nodes.literal(text=value), words) for name, (value, words) in entries.items()
            ]
            table = made_table(("setting", "default", "meaning"), rows, (20, 25, 55))
            made.append(nodes.section("", nodes.title(section, section), table, ids=[f"settings-{section}"]))
        return made
