"""The gate passes what holds, names what moved and by how much, and is not fooled by two methods that change places."""

import gzip
import json
import re
import subprocess
from itertools import combinations
from pathlib import Path
from types import SimpleNamespace

import pytest

from haptic_glance.base.files import read_json, write_json
from stages import gate
from stages.engine.tolerances import Rule, Tolerances, compare

ROOT = Path(__file__).parents[1]
PROFILES = ["smoke", "laptop"]
CAUGHT = 0.95  # of the swaps of two methods


@pytest.fixture
def workspace(make_workspace):
    """A set `toys` with one stage, beside the metrics of a set that is not switched on."""
    toys = make_workspace({"lod": {}})
    write_json(toys.metrics / "lod.json", {"meshes": 100, "error": 0.5})
    write_json(toys.on("other").metrics / "lod.json", {"error": 3})
    write_json(toys.reports / "metrics/report.json", {"tables": 2})
    gate.update(gate.measured(toys), gate.baseline_of(toys))
    return toys


def test_the_gate_names_what_moved(workspace):
    path, rules = gate.baseline_of(workspace), Tolerances([Rule("*.error", rel=0.1)])
    assert "3 metrics within" in gate.hold(gate.measured(workspace), path, rules)
    write_json(workspace.metrics / "lod.json", {"meshes": 100, "error": 0.1})
    with pytest.raises(SystemExit, match=r"1 of 3 metrics left .*\n.*toys.lod.error moved by -0.4"):
        gate.hold(gate.measured(workspace), path, rules)


def test_only_sets_that_are_switched_on_count_and_nested_metrics_are_flat_without_intervals(workspace):
    nested = {"a": {"b": {"value": 1.0, "low": 0, "high": 2}}, "c": True}
    assert gate.flatten(nested) == {"a.b.value": 1.0, "c": True}
    assert gate.measured(workspace) == {"toys.lod.meshes": 100, "toys.lod.error": 0.5, "report.tables": 2}


def test_what_the_baseline_lacks_is_named(workspace):
    write_json(workspace.metrics / "lod.json", {"meshes": 100, "error": 0.5, "new": 1})
    message = gate.hold(gate.measured(workspace), gate.baseline_of(workspace), Tolerances())
    assert message.endswith("not in the baseline yet: toys.lod.new")
    many = {"a": 1.0} | {f"new{k}": 1.0 for k in range(10)}
    write_json(workspace.reports / "a.json", {"a": 1.0})
    message = gate.hold(many, workspace.reports / "a.json", Tolerances())
    assert message.endswith(f"yet: {', '.join(f'new{k}' for k in range(8))} and 2 more")


def test_a_published_run_has_the_baseline_of_its_profile_and_one_of_ones_own_that_of_its_folder(workspace):
    assert gate.baseline_of(workspace) == workspace.published / "baselines/test.json"
    own_run = SimpleNamespace(params={}, reports=Path("runs/mine"), published=workspace.published)
    assert gate.baseline_of(own_run) == Path("runs/mine/baseline.json")
    write_json(workspace.published / "baselines/mine.json", {})
    assert gate.baseline_of(own_run) == workspace.published / "baselines/mine.json"
    own_run = SimpleNamespace(params={}, reports=workspace.published, published=workspace.published)
    assert gate.baseline_of(own_run) == workspace.published / "baselines/laptop.json"


def test_a_run_of_ones_own_is_held_by_the_rules_about_published_metrics(workspace, monkeypatch, capsys):
    root = workspace.root
    write_json(workspace.published / "baselines/laptop.json", {"toys.lod.error": 1.0, "other.svm": 1.0})
    (workspace.published / "tolerances.yaml").write_text('rules: [{metric: "*.svm", rel: 0.1}]\n')
    text = (root / "params.yaml").read_text()
    (root / "params.yaml").write_text(f"{text}out: runs/mine\n")
    (root / "dvc.yaml").touch()
    monkeypatch.chdir(root)
    write_json(root / "runs/mine/metrics/toys/lod.json", {"error": 0.5})
    gate.run(["--update"])
    gate.run([])
    assert "gate: 1 metrics within their tolerances about runs/mine/baseline.json" in capsys.readouterr().out


def test_metrics_of_any_project_are_held_and_kept(tmp_path, capsys):
    metrics, baseline, rules = (tmp_path / name for name in ("train.json", "base.json", "rules.yaml"))
    metrics.write_text(json.dumps({"accuracy": 0.8, "epochs": 10}))
    rules.write_text("rules: [{metric: train.accuracy, abs: 0.05, direction: more}]")
    options = [str(metrics), "--baseline", str(baseline)]
    with pytest.raises(SystemExit, match="--update makes it"):
        gate.run(options)
    gate.run([*options, "--update"])
    assert read_json(baseline) == {"train.accuracy": 0.8, "train.epochs": 10}
    metrics.write_text(json.dumps({"accuracy": 0.9, "epochs": 10}))
    gate.run([*options, "--tolerances", str(rules)])
    assert "\ngate: 2 metrics within their tolerances" in capsys.readouterr().out
    with pytest.raises(SystemExit, match=r"(?s)1 of 2 metrics left.*\n- train.accuracy moved by \+0.1"):
        gate.run([*options, "--markdown"])  # exact without rules
    assert capsys.readouterr().out == ""
    gate.run([*options, "--tolerances", str(rules), "--markdown"])
    assert capsys.readouterr().out.startswith("## Metrics against their baseline\n\n2 metrics within")
    with pytest.raises(SystemExit):
        gate.run([str(metrics)])
    assert "needs --baseline" in capsys.readouterr().err
    with pytest.raises(SystemExit, match="no metrics to write"):
        gate.update({}, tmp_path / "none.json")
    with pytest.raises(SystemExit, match="b of the metrics at hand are no finite numbers"):
        gate.update({"a": 1.0, "b": float("nan")}, tmp_path / "none.json")
    assert not (tmp_path / "none.json").exists()
    metrics.write_text("[0.9, 10]")
    with pytest.raises(ValueError, match=r"train.json is no table of metrics: it needs \{NAME: number\}"):
        gate.run(options)
    baseline.write_text(json.dumps({"train": {"accuracy": 0.9}}))  # as a project's own metrics are
    metrics.write_text(json.dumps({"accuracy": 0.9}))
    gate.run(options)
    assert "1 metrics within" in capsys.readouterr().out


def test_what_moved_with_the_seed_may_move_as_far(workspace, tmp_path, monkeypatch):
    monkeypatch.chdir(workspace.root)
    (workspace.root / "dvc.yaml").touch()
    monkeypatch.setattr(gate, "Workspace", lambda _: workspace)
    for folder, error in (("one", 0.6), ("two", 0.45)):
        write_json(tmp_path / folder / "toys/lod.json", {"meshes": 100, "error": error})
        write_json(tmp_path / folder / "report.json", {"tables": 3})
    gate.run(["--spread", str(tmp_path / "one"), str(tmp_path / "two")])
    assert read_json(gate.spread_of(gate.baseline_of(workspace))) == {"toys.lod.error": 0.101}  # rounded up
    write_json(workspace.metrics / "lod.json", {"meshes": 100, "error": 0.41})
    gate.run([])
    write_json(workspace.metrics / "lod.json", {"meshes": 100, "error": 0.39})
    with pytest.raises(SystemExit, match="toys.lod.error moved by -0.11"):
        gate.run([])
    (tmp_path / "none").mkdir()
    with pytest.raises(SystemExit, match="folder 1 of --spread has none of the metrics"):
        gate.run(["--spread", str(tmp_path / "none")])


def test_a_baseline_holds_against_itself_and_every_rule_is_of_a_metric():
    for profile in PROFILES:
        baseline, rules = committed(profile)
        assert compare(baseline, baseline, rules) == []
    committed("smoke")[1].check([name for profile in PROFILES for name in committed(profile)[0]])


@pytest.mark.parametrize("profile", PROFILES)
@pytest.mark.parametrize(
    ("stage", "method"),
    [("lod", r"\.metro_mean_(.+)"), ("salient_points", r"\.([^.]+)\.spread"), ("classification", r"\.([^.]+)\.knn\.")],
)
@pytest.mark.slow
def test_two_methods_that_change_places_are_caught(profile, stage, method):
    baseline, rules = committed(profile)
    metrics = {name: value for name, value in baseline.items() if name.split(".")[1] == stage}
    methods = sorted({match[1] for name in metrics if (match := re.search(method, name))})
    swaps = [exchanged(metrics, *pair) for pair in combinations(methods, 2)]
    swaps = [swapped for swapped in swaps if swapped != metrics]  # the rest has the same values
    caught = [bool(compare(swapped, metrics, rules)) for swapped in swaps]
    assert len(swaps) >= 3 and sum(caught) >= CAUGHT * len(swaps)


def committed(profile):
    """(baseline, tolerances) of the repository."""
    baseline = ROOT / f"reports/baselines/{profile}.json"
    return read_json(baseline), gate.allowed(ROOT / gate.TOLERANCES, baseline)


def exchanged(metrics, first, second):
    """The metrics with those of two methods in each other's place."""
    swapped, whole = dict(metrics), re.compile(rf"(?<![^._]){re.escape(first)}(?![^._])")
    for name in metrics:
        place = whole.sub(second, name, count=1)
        if place != name and place in metrics:
            swapped[name], swapped[place] = metrics[place], metrics[name]
    return swapped


@pytest.fixture
def repository(tmp_path):
    """A git repository with the rows of two sets, of which params.yaml would switch on one."""
    rows = [
        "item,method,metric,value,seconds,note,condition",
        *(f"{k},{way},error,{k + len(way)},0.1,old," for k in (1, 2) for way in ("a", "bb")),
    ]
    for name in ("toys", "off"):
        write(tmp_path, name, rows)
    for arguments in (
        ["init", "-q"],
        ["add", "."],
        ["-c", "user.name=A", "-c", "user.email=a@b.c", "commit", "-qm", "rows"],
    ):
        subprocess.run(["git", *arguments], cwd=tmp_path, check=True)
    return tmp_path, rows


def write(root, name, rows):
    path = root / gate.ROWS / name / "lod.csv.gz"
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(gzip.compress("\n".join(rows).encode()))


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        (lambda rows: [*rows[:2], rows[2].replace(",3,", ",3.15,"), *rows[3:]], "1 rows changed"),  # 5 %
        (lambda rows: [*rows[:2], rows[2].replace(",3,", ",-3,"), *rows[3:]], "1 rows changed"),
        (
            lambda rows: [row.replace(",a,", ",x,").replace(",bb,", ",a,").replace(",x,", ",bb,") for row in rows],
            "4 rows",
        ),
        (lambda rows: rows[:-1], "1 fewer"),
        (lambda rows: [*rows, rows[-1]], "1 more"),
    ],
    ids=["five per cent", "sign", "two methods that change places", "dropped", "twice"],
)
def test_every_changed_row_is_found_also_of_sets_that_are_off(repository, change, reason):
    root, rows = repository
    assert "2 files equal those of HEAD" in gate.hold_rows("HEAD", root)
    for name in ("toys", "off"):
        write(root, name, change(rows))
        with pytest.raises(SystemExit, match=rf"{name}/lod.csv.gz: .*{reason}"):
            gate.hold_rows("HEAD", root)


def test_times_and_the_order_of_rows_change_nothing(repository):
    root, rows = repository
    times = ["1,a,plan_ms,5,,,", "1,a,seconds,5,,,", "1,a,error,5,,,cost"]
    write(root, "toys", [rows[0], *(row.replace("0.1,old", "9,new") for row in rows[:0:-1]), *times])
    assert "equal" in gate.hold_rows("HEAD", root)
    write(root, "toys", [*rows, "1,a,,5,,,"])  # no metric is no time
    with pytest.raises(SystemExit, match="toys/lod.csv.gz: 0 rows changed, 1 more"):
        gate.hold_rows("HEAD", root)


def test_a_file_that_is_gone_and_a_revision_that_is_none_are_named(repository):
    root, _ = repository
    (root / gate.ROWS / "off/lod.csv.gz").unlink()
    with pytest.raises(SystemExit, match="off/lod.csv.gz: 0 rows changed, 0 more, 4 fewer"):
        gate.hold_rows("HEAD", root)
    with pytest.raises(SystemExit, match="gate: git ls-tree: .*nowhere"):
        gate.hold_rows("nowhere", root)


@pytest.mark.parametrize("cut", [lambda content: content[:40], lambda _: b"hello"], ids=["cut off", "no archive"])
def test_a_damaged_file_of_rows_is_named_and_the_others_are_compared(repository, cut):
    root, rows = repository
    path = root / gate.ROWS / "off/lod.csv.gz"
    path.write_bytes(cut(path.read_bytes()))
    write(root, "toys", rows[:-1])
    with pytest.raises(SystemExit, match=r"(?s)off/lod.csv.gz: not a valid table .*toys/lod.csv.gz: .*1 fewer"):
        gate.hold_rows("HEAD", root)
