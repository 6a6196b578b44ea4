"""The examples that are beside those of other programs: they run, and have no more lines than theirs."""

import ast
import io
import os
import pathlib
import re
import runpy
import textwrap
import tokenize

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
EXAMPLES = ROOT / "python" / "examples"
PAIRS = {"first_steps": "rebound_first_steps", "test_particles": "rebound_test_particles", "archive": "rebound_archive",
         "argon": "openmm_argon"}
RESULTS = {"first_steps": ["eccentricity.png", "orbits.png"], "test_particles": ["resonance.png"],
           "archive": ["archive.h5", "archive.png"], "argon": ["argon.h5", "argon.xyz"]}


def code_lines(path):
    """Lines with code: not blank, not a comment, not the document of the file."""
    text = path.read_text()
    first = ast.parse(text).body[0]
    empty = (tokenize.COMMENT, tokenize.NL, tokenize.NEWLINE, tokenize.INDENT, tokenize.DEDENT, tokenize.ENDMARKER)
    rows = set()
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        if token.type not in empty:
            rows.update(range(token.start[0], token.end[0] + 1))
    return len(rows - set(range(first.lineno, first.end_lineno + 1)))


@pytest.mark.parametrize("ours", PAIRS)
def test_ours_has_no_more_lines_than_theirs_and_the_page_tells_both(ours):
    lines = code_lines(EXAMPLES / f"{ours}.py"), code_lines(EXAMPLES / "peers" / f"{PAIRS[ours]}.py")
    assert 0 < lines[0] <= lines[1]
    page = (ROOT / "docs" / "from_rebound.md").read_text()
    row = re.search(rf"\| \[{ours}.py\]\([^)]*\) \| (\d+) \| \[{PAIRS[ours]}.py\]\([^)]*\) \| (\d+) \|", page)
    assert row and tuple(map(int, row.groups())) == lines


@pytest.mark.parametrize("ours", PAIRS)
def test_the_page_shows_the_examples_as_they_are(ours):
    page = (ROOT / "docs" / "from_rebound.md").read_text()
    for path in (EXAMPLES / f"{ours}.py", EXAMPLES / "peers" / f"{PAIRS[ours]}.py"):
        text = path.read_text()
        code = "\n".join(text.split("\n")[ast.parse(text).body[0].end_lineno:]).strip("\n")
        assert textwrap.indent(code, "    ") in page, path.name


@pytest.mark.parametrize("name", PAIRS)
def test_an_example_runs_and_writes_its_files(name, tmp_path, monkeypatch, capsys):
    if name != "argon":
        pytest.importorskip("matplotlib").use("agg")
    if name == "first_steps":
        pytest.importorskip("noether.plots")
    if name == "archive":
        pytest.importorskip("h5py")
    monkeypatch.chdir(tmp_path)
    made = runpy.run_path(str(EXAMPLES / f"{name}.py"))
    assert capsys.readouterr().out.strip()
    for file in RESULTS[name]:
        assert (tmp_path / file).stat().st_size > 1000, file
    if name == "test_particles":
        period_ratio = made["a"] ** 1.5
        locked = made["locked"]
        assert (locked > 0.6).any() and abs(period_ratio[locked > 0.6] - 2).max() < 0.15
        assert locked[abs(period_ratio - 2) > 0.15].max() < 0.5


@pytest.mark.skipif(not os.environ.get("NOETHER_NIGHTLY"), reason="nightly: set NOETHER_NIGHTLY=1")
@pytest.mark.parametrize("theirs", [one for one in PAIRS.values() if one.startswith("rebound")])
def test_theirs_tells_the_same_as_ours(theirs, tmp_path, monkeypatch, capsys):
    pytest.importorskip("rebound")
    pytest.importorskip("matplotlib").use("agg")
    monkeypatch.chdir(tmp_path)
    if theirs == "rebound_first_steps":
        pytest.importorskip("noether.plots")
    told = []
    for path in (EXAMPLES / f"{theirs[8:]}.py", EXAMPLES / "peers" / f"{theirs}.py"):
        runpy.run_path(str(path))
        numbers = [float(one) for one in re.findall(r"-?\d+\.\d+", capsys.readouterr().out)]
        told.append(sorted(one for one in numbers if one != 0))
    assert len(told[0]) > 0 and told[0] == pytest.approx(told[1], rel=1e-6)
