import json
from xml.etree import ElementTree as ET

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
)  # fmt: skip
ALL = [PASSED, FAILED, BROKEN]


def test_the_table_shows_what_there_is():
    assert forms.table_rows(ALL) == [
        ("parts/ring.toml", "pass", "1.2 µm", "7", "12.50 s"),
        ("parts/slot.nc", "fail", "31.0 µm", "12", "3.00 s"),
        ("parts/bad.nc", "error", "–", "–", "–"),
    ]
    assert forms.summary_line(ALL) == "3 programs: 1 pass, 1 fail, 1 error"


def test_junit_counts_and_tells():
    root = ET.fromstring(forms.junit_xml(ALL))  # noqa: S314 (made here)
    suite = root[0]
    assert (suite.get("tests"), suite.get("failures"), suite.get("errors")) == ("3", "1", "1")
    ring, slot, bad = suite
    assert (ring.get("name"), ring.get("classname"), len(ring)) == ("ring.toml", "parts", 0)
    assert (slot[0].tag, slot[0].get("type")) == ("failure", "contour_um")
    assert bad[0].tag == "error"
    assert bad[0].get("message") == "no word 'Ж' <&>"
    assert "G1 Ж" in (bad[0].text or "")


def test_github_gets_one_escaped_command_for_each_finding():
    slot, bad = forms.github_annotations(ALL)
    assert slot == (
        "::error file=parts/slot.nc,line=12,title=contour_um::contour error 31.0 µm exceeds 20, by far"
    )
    assert bad.startswith("::error file=parts/bad.nc,line=2,col=5,title=unknown-word::")
    nasty = CheckOutcome(
        program="x", verdict="error", exit_code=ExitCode.USAGE,
        findings=(Finding("c", "a\nb 5%", "C:\\a,b.nc"),),
    )  # fmt: skip
    assert forms.github_annotations([nasty]) == ["::error file=C%3A\\a%2Cb.nc,title=c::a%0Ab 5%25"]


def test_markdown_and_code_quality_name_the_line():
    summary = forms.markdown_summary(ALL)
    assert "| parts/slot.nc | fail | 31.0 µm | 12 | 3.00 s |" in summary
    assert "parts/slot.nc:12: contour error" in summary
    quality = json.loads(forms.gitlab_code_quality(ALL))
    assert [q["location"]["lines"]["begin"] for q in quality] == [12, 2]
    assert len({q["fingerprint"] for q in quality}) == 2


def test_json_has_every_figure():
    content = json.loads(forms.json_text(ALL))
    assert [p["verdict"] for p in content["programs"]] == ["pass", "fail", "error"]
    assert content["programs"][0]["contour_um"] == 1.234
    assert content["programs"][2]["exit_code"] == 3
    assert content["programs"][2]["findings"][0]["column"] == 5
