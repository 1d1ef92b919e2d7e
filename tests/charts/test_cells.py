"""Figures in sentences that come from tables."""

import pandas as pd
import pytest

from haptic_glance.base.files import write_table
from stages.charts.cells import filled


@pytest.fixture
def reports(tmp_path):
    """A folder with one table and the claims."""
    frame = pd.DataFrame({"method": ["one", "two", "two"], "note": ["", "", "x"], "mean": [1234.5, 0.5, None]})
    write_table(tmp_path / "tables/rates.csv", frame.assign(low=[1000.0, 0.25, 0], high=[2000.0, 0.75, 1]))
    claims = {"key": ["kept", "read", "untested"], "effect": -100.0, "low": -120.0, "high": 0.0}
    claims["verdict"] = ["contradicted", "open", "not testable"]
    write_table(tmp_path / "claims.csv", pd.DataFrame(claims))
    signs = {
        "kind": ["none of both", "open", "tiny"],
        "mean": [1, 1, -0.2],
        "low": [-2, None, -0.4],
        "high": [4, 2, 0.3],
    }
    write_table(tmp_path / "tables/signs.csv", pd.DataFrame(signs))
    return tmp_path


@pytest.mark.parametrize(("place", "words"), [
    ("tables/rates method=one: mean", "1,234"),
    ("tables/rates method=one: mean low high", "1,234 [1,000, 2,000]"),
    ("tables/rates method=two note=: 100*mean 100*low 100*high .0f", "50 [25, 75]"),
    ("tables/rates method=two note=: 1/mean 1/low 1/high", "2 [1.33, 4]"),
    ("tables/rates method=two note=: 1-mean", "0.500"),
    ("claims key=kept: times:effect times:low times:high .2f", "3.00 [1.00, 4.00]"),
    ("claims key=kept: -effect", "100"),
    ("claims key=read: effect low high", "-100 [-120, 0]"),
    ("claims key=untested: effect low high more|less .0f",
     "neither more nor less beyond chance (-100 [-120, 0]) (not testable)"),
    ("tables/rates method=o*: mean", "1,234"),
    ("tables/rates note=x method!=one: rows", "1"),
    ("tables/rates : rows", "3"),
    ("tables/signs kind=open: mean low high", "1"),
    ("tables/signs kind=tiny: mean low high .0f", "0 [0, 0]"),
    ("tables/rates highest=low: method", "one"),
    ("tables/rates method=two lowest=mean: mean low high NSS higher|NSS lower .2f", "0.50 [0.25, 0.75] NSS higher"),
    ("tables/rates method=two note=: -mean -low -high higher|lower .1f", "0.5 [0.2, 0.8] lower"),
    ("tables/signs kind=none of both: mean low high points higher|points lower .0f",
     "neither points higher nor points lower beyond chance (1 [-2, 4])"),
])  # fmt: skip
def test_a_place_becomes_what_its_cell_holds(reports, place, words):
    assert filled(f"It is {{{place}}}.", reports) == (f"It is {words}.", [tuple(place.split(":")[0].split(" ", 1))])


@pytest.mark.parametrize("place", [
    "tables/none method=one: mean", "tables/rates method=three: mean", "tables/rates method=two: mean",
    "tables/rates method=two note=x: mean", "tables/rates gone=1: mean", "tables/rates method=one: gone",
    "tables/signs kind=open: mean low high more|less",
    "tables/rates highest=gone: mean", "tables/rates method=two note=x highest=mean: mean", "tables/none : rows",
])  # fmt: skip
def test_what_was_not_measured_or_is_not_one_row_is_an_error(reports, place):
    with pytest.raises(LookupError):
        filled(f"{{{place}}}", reports)
