"""All settings of conf/config.yaml with their defaults and meaning, as one table a stage.

```{settings}
```
"""

import re
from pathlib import Path

import yaml
from docutils import nodes
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective

from .tables import made_table

FOREIGN = ("defaults", "hydra")  # sections that Hydra itself reads
CONF = Path(__file__).resolve().parents[2] / "conf" / "config.yaml"


def setup(app: Sphinx) -> dict[str, bool]:
    """Adds the directive."""
    app.add_directive("settings", SettingsTable)
    return {"parallel_read_safe": True, "parallel_write_safe": True}


def settings() -> dict[str, dict[str, tuple[str, str]]]:
    """{section: {setting: (default, meaning; empty where a group of conf/ says it)}} of conf/config.yaml."""
    sections: dict[str, dict[str, tuple[str, str]]] = {}
    section, text = "", CONF.read_text(encoding="utf-8")
    values = yaml.safe_load(text)
    for line in text.splitlines():
        if head := re.match(r"(\w+):(?:\s*#.*)?$", line):
            section = head[1]
        elif section in FOREIGN:
            continue
        elif setting := re.match(r"  (\w+):(.*)$", line):
            default, _, meaning = setting[2].partition(" # ")
            value = default.strip() or flow(values[section][setting[1]])
            sections.setdefault(section, {})[setting[1]] = value, meaning.strip()
    return sections


def flow(value: object) -> str:
    """A default that stands on lines of its own, in one line."""
    return yaml.safe_dump(value, default_flow_style=True, width=10**6, sort_keys=False).strip()


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
