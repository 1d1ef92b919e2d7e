"""Every topic of the report where nothing was measured: it names what is missing, and makes nothing up."""

import re
import sys
from dataclasses import asdict
from pathlib import Path

import pytest
from omegaconf import OmegaConf

from haptic_glance.base.files import write_text
from stages.engine.measurements import Measurements
from stages.engine.settings import load_params
from stages.report.__main__ import main
from stages.report.claims import load
from stages.report.parts import KINDS, PARTS, Built, build_part
from stages.report.verdict import judge

UNMEASURED = {"table_3_1_5_combinations", "fidelity", "recognition"}  # of the thesis, or of one's own meshes
REMEDY = "no measurements of|`dvc repro |`make bench`|run the stage"


@pytest.mark.parametrize("topic", PARTS.values(), ids=PARTS)
def test_a_topic_without_measurements_names_what_is_missing_of_each_item(topic, empty):
    for kind, items in KINDS.items():
        missing = build_part(topic, empty, [kind]).not_run
        assert {name.partition("/")[2] for name in missing} == set(getattr(topic, items)) - UNMEASURED
        assert all(re.search(REMEDY, reason) for reason in missing.values()), missing


def test_every_claim_is_open_without_measurements(empty):
    table = judge(load(), Measurements(empty.reports))
    assert table["key"].is_unique and set(table["verdict"]) == {"open"} and not table["pairs"].any()
    assert table["caveat"].str.startswith("not run: no measurements of ").all()


@pytest.mark.slow
def test_a_folder_of_ones_own_has_the_reasons_of_the_stages_that_ran_on_it_alone(root, small):
    small.write_measurements(root, "classification", small.classification().assign(group="mine"))
    small.write_measurements(root, "salient_points", small.judged(), "test")
    results = small.own_results(root)
    missing = sum((build_part(part, results, ["tables"]) for part in PARTS.values()), Built()).not_run
    assert missing["tables/table_4_1"] == "group six is not among those that classification measured on test"
    assert not {f"tables/{name}" for name in ("table_4_4", "table_4_9", "attention_gaze", "recognition")} & set(missing)


def test_a_named_stage_is_drawn_alone_and_its_files_are_printed(root, small, monkeypatch, capsys):
    values = load_params(root / "params.yaml") | {"report": asdict(small.settings())}
    write_text(root / "params.yaml", OmegaConf.to_yaml(OmegaConf.create(values)))
    (root / "dvc.yaml").touch()
    write_text(root / "reports/claims.md", "old")
    monkeypatch.setattr("sys.argv", ["report", "lod", "--root", str(root)])
    monkeypatch.setattr("sys.excepthook", sys.excepthook)
    main()
    printed = capsys.readouterr().out.splitlines()
    files = [line for line in printed if Path(line).exists()]
    assert {str(root / f"reports/tables/lod_detectors{end}") for end in (".csv", ".md")} <= set(files)
    assert any(line.startswith("tables/backends: no ") for line in printed)
    assert {*(root / "reports/tables").iterdir()} == {Path(line) for line in files if "/tables/" in line}
    assert (root / "reports/claims.md").read_text() == "old\n" and not (root / "reports/index.html").exists()
    monkeypatch.setattr("sys.argv", ["report", "lodd", "--root", str(root)])
    with pytest.raises(ValueError, match="no stage lodd has a part in the report: .*lod"):
        main()
