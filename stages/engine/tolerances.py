"""Tolerances of metrics: rules by name, and the metrics that left their bounds about the baseline.

A file of rules is YAML. Under `rules`, the first rule whose pattern fits a metric holds the metric; a metric without a
rule is held exactly. Under `pairs`, a difference of two metrics is held as `pairs.NAME`; two patterns with a `*` give
one difference for each text that fits both:

    rules:
      - {metric: "*.accuracy", direction: more, abs: 0.02}
      - {metric: "*.seconds", free: true}
    pairs:
      ours over blind: ["*.ours.accuracy", "*.blind.accuracy"] # pairs.ours over blind.touch, and so on
"""

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, fields
from difflib import get_close_matches
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any

DIRECTIONS = ("both", "more", "less")
PAIRS = "pairs"  # the first part of the name of a difference
DIGITS = 1e-9  # of a value: what six digits in a file and a difference of two of them lose


@dataclass(frozen=True)
class Rule:
    """The metrics that fit a pattern may move by `abs`, or by `rel` of their baseline where that is more.

    direction: more or less, where that is better: moves to the better side are free then. free: never held. why: what
    the numbers rest on.
    """

    metric: str
    abs: float = 0.0
    rel: float = 0.0
    direction: str = "both"
    free: bool = False
    why: str = ""

    def bounds(self, value: float, moved: float = 0.0) -> tuple[float, float]:
        """(lowest, highest) that holds, about a baseline; moved: how far other runs moved it."""
        room = max(self.abs, self.rel * abs(value), DIGITS * abs(value), moved)
        low = float("-inf") if self.free or self.direction == "less" else value - room
        return low, float("inf") if self.free or self.direction == "more" else value + room


EXACT = Rule("*")


@dataclass(frozen=True)
class Tolerances:
    """rules: in their order. pairs: {name: (metric, metric)}, whose difference is held, too.

    moves: {metric: how far it moved in runs with other seeds, threads or machines}, which it may, whatever its rule.
    """

    rules: list[Rule] = field(default_factory=list)
    pairs: dict[str, tuple[str, str]] = field(default_factory=dict)
    moves: Mapping[str, float] = field(default_factory=dict)

    def of(self, metric: str) -> Rule:
        """The rule that holds a metric."""
        return next((rule for rule in self.rules if fnmatchcase(metric, rule.metric)), EXACT)

    def with_pairs(self, metrics: Mapping[str, float]) -> dict[str, float]:
        """The metrics and the differences of those pairs that are both there."""
        values = dict(metrics)
        for name, (first, second) in self.pairs.items():
            pattern = re.compile(re.escape(first).replace(r"\*", "(.+)"))
            for metric in metrics:
                if (fits := pattern.fullmatch(metric)) and (
                    partner := second.replace("*", "".join(fits.groups()))
                ) in metrics:
                    values[".".join([PAIRS, name, *fits.groups()])] = metrics[metric] - metrics[partner]
        return values

    def check(self, metrics: Iterable[str]) -> None:
        """ValueError for a pattern that fits none of the metrics, or a pair of metrics that are not there."""
        names = [*self.with_pairs(dict.fromkeys(metrics, 0.0))]
        patterns = [rule.metric for rule in self.rules] + [name for pair in self.pairs.values() for name in pair]
        for pattern in patterns:
            if not any(fnmatchcase(name, pattern) for name in names):
                close = "".join(f", did you mean {name}?" for name in get_close_matches(pattern, names, 1))
                raise ValueError(f"a tolerance is for {pattern}, but no metric is called so{close}")


def read_tolerances(path: Path) -> Tolerances:
    """The rules of a file; ValueError that names the file and the rule for one that cannot be read."""
    import yaml

    try:
        content = yaml.safe_load(path.read_text(encoding="utf-8"))
    except yaml.YAMLError as error:
        raise ValueError(f"{path} is not YAML: {error}") from None
    if not isinstance(content, dict) or set(content) - {"rules", PAIRS}:
        raise ValueError(f"{path} must have `rules` and may have `{PAIRS}`, nothing else")
    pairs = {name: _pair(path, name, pair) for name, pair in (content.get(PAIRS) or {}).items()}
    return Tolerances([_rule(path, rule) for rule in content.get("rules") or []], pairs)


def compare(metrics: Mapping[str, float], baseline: Mapping[str, float], tolerances: Tolerances) -> list[str]:
    """Sentences on every metric that left its bounds or is missing; [] when all hold."""
    metrics, sentences = tolerances.with_pairs(metrics), []
    for name, value in tolerances.with_pairs(baseline).items():
        if (new_value := metrics.get(name)) == value:
            continue
        low, high = tolerances.of(name).bounds(value, tolerances.moves.get(name, 0.0))
        if new_value is None:
            sentences.append(f"{name} is missing (baseline {value:g})")
        elif not low <= new_value <= high:
            move = f"{name} moved by {new_value - value:+.4g} from {value:.4g} to {new_value:.4g}"
            sentences.append(f"{move}, outside {low:.4g} .. {high:.4g}")
    return sentences


def widest_moves(runs: Iterable[Mapping[str, float]], baseline: Mapping[str, float]) -> dict[str, float]:
    """{metric: how far the one of several runs that moved it most did so}; without those that never moved."""
    runs = list(runs)
    moves = {name: max(abs(run.get(name, value) - value) for run in runs) for name, value in baseline.items()}
    wider = 1.006  # or three digits may be less than the move itself
    return {name: float(f"{wider * move:.3g}") for name, move in moves.items() if move > DIGITS * abs(baseline[name])}


def _rule(path: Path, entry: Any) -> Rule:
    names = [attribute.name for attribute in fields(Rule)]
    if not isinstance(entry, dict) or "metric" not in entry or set(entry) - set(names):
        raise ValueError(f"{path}: a rule has metric and some of {', '.join(names[1:])}, got {entry}")
    rule = Rule(**entry)
    numbers = [number for number in (rule.abs, rule.rel) if isinstance(number, int | float) and number >= 0]
    if len(numbers) < 2 or rule.direction not in DIRECTIONS:
        raise ValueError(f"{path}, {rule.metric}: abs and rel are at least 0, direction is one of {DIRECTIONS}")
    return rule


def _pair(path: Path, name: str, pair: Any) -> tuple[str, str]:
    if not isinstance(pair, list) or [str(metric).count("*") for metric in pair] not in ([0, 0], [1, 1]):
        raise ValueError(f"{path}: pair {name!r} must list two metrics, with one * each or none, got {pair}")
    return pair[0], pair[1]
