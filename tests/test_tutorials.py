"""The tutorials, followed step by step: every command is run, and prints what the page shows."""

from __future__ import annotations

import re
import shlex
from pathlib import Path

import pytest
from typer.testing import CliRunner

from grashof.cli import app

PAGES = Path(__file__).parents[1] / "docs" / "tutorials"
BLOCK = re.compile(r"^```(\w+)\n(.*?)^```", re.MULTILINE | re.DOTALL)
# Where lines without a file name of their own go: below this heading of the file at hand.
PLACES = {
    "first-linkage": ("mine.toml", "[requirements]\n"),
    "sketch-to-plates": ("gripper.toml", "[motion]\n"),
}


def run(line: str) -> str:
    """The output of a command of the page, both streams; its output file is written where it names one."""
    words = shlex.split(line)
    into = words.pop() if ">" in words else None
    words = [word for word in words if word != ">"]
    assert words[0] == "grashof"
    done = CliRunner().invoke(app, words[1:])
    assert done.exit_code in (0, 1), done.output
    if into is not None:
        Path(into).write_text(done.stdout, encoding="utf-8")
    return done.output


@pytest.mark.slow
@pytest.mark.parametrize("name", ["first-linkage", "sketch-to-plates"])
def test_each_step_gives_what_is_shown(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    said, shown = "", 0
    for language, text in BLOCK.findall((PAGES / f"{name}.md").read_text(encoding="utf-8")):
        if language == "sh" and text.startswith("grashof"):
            said = "".join(map(run, text.splitlines()))
        elif language == "text":
            missing = [line for line in text.splitlines() if line.strip() not in said]
            assert missing == []
            shown += 1
        elif language == "toml":
            file, heading = PLACES[name]
            if text.startswith(f"# {file}"):
                Path(file).write_text(text, encoding="utf-8")
            else:
                before = Path(file).read_text(encoding="utf-8")
                assert before.count(heading) == 1
                without = _without_keys_of(before, text)
                Path(file).write_text(without.replace(heading, heading + text), encoding="utf-8")
        elif language == "python":
            exec(compile(text, name, "exec"), {})  # noqa: S102
    assert shown >= 3


@pytest.mark.slow
def test_the_first_list_of_the_readme_is_what_is_printed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    said = " ".join(run("grashof solve luggage").split())
    for page in ("README.md", "docs/howto/results.md"):
        text = (PAGES.parents[1] / page).read_text(encoding="utf-8")
        (shown,) = [
            block for block in re.findall(r"^```\w*\n(.*?)^```", text, re.M | re.S) if "distinct" in block
        ]
        lines = [
            re.sub(r"largest position error \S+", "", " ".join(line.split())) for line in shown.splitlines()
        ]
        printed = re.sub(r"largest position error \S+", "", said)
        assert [line for line in lines if line != "…" and line not in printed] == []


def _without_keys_of(text: str, added: str) -> str:
    """A file without the keys that are about to be added."""
    keys = [line.partition("=")[0].strip() for line in added.splitlines()]
    lines = [line for line in text.splitlines() if line.partition("=")[0].strip() not in keys]
    return "\n".join(lines) + "\n"
