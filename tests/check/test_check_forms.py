import dataclasses
import json
import re
from pathlib import Path
from xml.etree import ElementTree as ET

import pytest

from twin.check import forms
from twin.check.outcome import CheckOutcome, Finding
from twin.errors import ExitCode

PASSED = CheckOutcome(
    program="parts/ring.toml", verdict="pass", exit_code=ExitCode.OK,
    contour_um=1.234, worst_line=7, cycle_time_s=12.5, wall_s=0.5,
)  # fmt: skip
FAILED = CheckOutcome(
    program="parts/slot.nc", verdict="fail", exit_code=ExitCode.FAILED,
    contour_um=31.0, worst_line=12, cycle_time_s=3.0, wall_s=0.25,
    findings=(Finding("contour_um", "contour error 31.0 µm exceeds 20, by far", "parts/slot.nc", 12),),
)  # fmt: skip
BROKEN = CheckOutcome(
    program="parts/bad.nc", verdict="error", exit_code=ExitCode.PROGRAM,
    findings=(
        Finding("unknown-word", "no word 'Ж' <&>", "parts/bad.nc", 2, 5, "bad.nc:2:5: error\x00\n    G1 Ж"),
    ),
    warnings=(Finding("no-feed", "no feed", "parts/bad.nc", 1, 1),),
)  # fmt: skip
ALL = [PASSED, FAILED, BROKEN]


def test_the_table_shows_what_there_is():
    assert forms.table_rows(ALL) == [
        ("parts/ring.toml", "pass", "1.2 µm", "7", "12.50 s"),
        ("parts/slot.nc", "fail", "31.0 µm", "12", "3.00 s"),
        ("parts/bad.nc", "error", "–", "–", "–"),
    ]
    assert forms.summary_line(ALL) == "3 programs: 1 pass, 1 fail, 1 error; 1 warning"
    assert forms.summary_line([PASSED]) == "1 program: 1 pass"


def test_junit_counts_and_tells():
    root = ET.fromstring(forms.junit_xml(ALL))  # noqa: S314 (made here)
    suite = root[0]
    assert (suite.get("tests"), suite.get("failures"), suite.get("errors")) == ("3", "1", "1")
    ring, slot, bad = suite
    assert (ring.get("name"), ring.get("classname")) == ("ring.toml", "parts")
    assert ring.find("failure") is None
    assert (slot[0].tag, slot[0].get("type")) == ("failure", "contour_um")
    assert bad[0].tag == "error"
    assert bad[0].get("message") == "no word 'Ж' <&>"
    assert "G1 Ж" in (bad[0].text or "")


JUNIT_10 = {
    "testsuites": ({"name", "time", "tests", "failures", "errors"}, set(), {"testsuite"}),
    "testsuite": (
        {"name", "tests", "failures", "errors", "group", "time", "skipped", "timestamp", "hostname",
         "id", "package", "file", "log", "url"},
        {"name", "tests", "failures", "errors"},
        {"testsuite", "properties", "testcase", "system-out", "system-err"},
    ),
    "testcase": (
        {"name", "time", "classname", "group"},
        {"name"},
        {"skipped", "error", "failure", "system-out", "system-err"},
    ),
    "failure": ({"type", "message"}, set(), set()),
    "error": ({"type", "message"}, set(), set()),
    "system-out": (set(), set(), set()),
    "system-err": (set(), set(), set()),
}  # fmt: skip
"""Of every element what it may have, what it must have, and what may be in it: junit-10.xsd of
Jenkins' xUnit plugin."""


def test_junit_is_what_jenkins_validates():
    for element in ET.fromstring(forms.junit_xml(ALL)).iter():  # noqa: S314 (made here)
        allowed, needed, inside = JUNIT_10[element.tag]
        assert needed <= set(element.keys()) <= allowed
        assert {child.tag for child in element} <= inside
        assert re.fullmatch(r"[0-9]*(\.[0-9]*)?", element.get("time", "0"))


def test_junit_tells_figures_and_warnings():
    ring, _, bad = ET.fromstring(forms.junit_xml(ALL))[0]  # noqa: S314 (made here)
    assert "contour_um: 1.234" in (ring.findtext("system-out") or "")
    assert "no feed" in (bad.findtext("system-err") or "")


def test_github_gets_one_escaped_command_for_each_finding():
    slot, bad, warning = forms.github_annotations(ALL, Path())
    assert slot == (
        "::error file=parts/slot.nc,line=12,title=contour_um::contour error 31.0 µm exceeds 20, by far"
    )
    assert bad.startswith("::error file=parts/bad.nc,line=2,col=5,title=unknown-word::")
    assert warning.startswith("::warning file=parts/bad.nc,line=1,col=1,title=no-feed::")
    nasty = CheckOutcome(
        program="x", verdict="error", exit_code=ExitCode.USAGE,
        findings=(Finding("c", "a\nb 5%", "C:\\a,b.nc"),),
    )  # fmt: skip
    assert forms.github_annotations([nasty], Path()) == [
        "::error file=C%3A\\a%2Cb.nc,title=c::a%0Ab 5%25"
    ]


def test_markdown_and_code_quality_name_the_line():
    summary = forms.markdown_summary(ALL)
    assert "| parts/slot.nc | fail | 31.0 µm | 12 | 3.00 s |" in summary
    assert "parts/slot.nc:12: contour error" in summary
    quality = json.loads(forms.gitlab_code_quality([*ALL, BROKEN], Path()))
    assert [q["location"]["lines"]["begin"] for q in quality] == [12, 2, 1]
    assert [q["severity"] for q in quality] == ["major", "major", "minor"]
    assert len({q["fingerprint"] for q in quality}) == 3
    grown = dataclasses.replace(
        FAILED.findings[0], message="contour error 44.0 µm exceeds 20, by far"
    )
    again = json.loads(
        forms.gitlab_code_quality([dataclasses.replace(FAILED, findings=(grown,))], Path())
    )
    assert again[0]["fingerprint"] == quality[0]["fingerprint"]


def test_servers_are_told_paths_within_the_repository(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    (tmp_path / "nc").mkdir()
    monkeypatch.chdir(tmp_path / "nc")
    slot, *_ = forms.github_annotations(ALL, tmp_path)
    assert slot.startswith("::error file=nc/parts/slot.nc,line=12,")
    quality = json.loads(forms.gitlab_code_quality(ALL, tmp_path))
    assert quality[0]["location"]["path"] == "nc/parts/slot.nc"


def test_json_has_every_figure():
    content = json.loads(forms.json_text(ALL))
    assert [p["verdict"] for p in content["programs"]] == ["pass", "fail", "error"]
    assert content["programs"][0]["contour_um"] == 1.234
    assert content["programs"][2]["exit_code"] == 3
    assert content["programs"][2]["findings"][0]["column"] == 5
