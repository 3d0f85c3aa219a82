"""Count the size of the tree at one or more commits, and the turns of phrase that its prose should avoid.

`python scripts/count_size.py 41848f6 HEAD` prints a column for each commit. Comments, docstrings and blank
lines count as lines; a line of code has at least one token that is not a comment or a docstring.
"""

import argparse
import io
import re
import subprocess
import sys
import tarfile
import tokenize
from collections import Counter
from collections.abc import Iterator, Sequence
from pathlib import Path

ROOT = Path(__file__).parents[1]
AREAS = {
    "proofs": r"synth/proof/.*\.py",
    "source": r"(problems|analysis|synth|src)/.*\.py",
    "scripts": r"scripts/.*\.py",
    "tests of proofs": r"tests/.*proof.*\.py",
    "tests": r"tests/.*\.py",
    "pages": r"(docs/.*|README|CONTRIBUTING|src/.*)\.(md|rst|html|js)",
}
PHRASES = {
    "docstrings that begin with What": r'"""What\b',
    "so many": r"\bso many\b",
    "is no, are no": r"\b(is|are) no\b",
    "told, tells": r"\b(told|tells?)\b",
    "glance": r"\bglance",
    "what is": r"\bwhat is\b",
}
LONGEST, FULLEST = 400, 20  # lines of a file, files of a folder
IDLE = {tokenize.NL, tokenize.NEWLINE, tokenize.COMMENT, tokenize.INDENT, tokenize.DEDENT, tokenize.ENDMARKER}


def texts(commit: str) -> Iterator[tuple[str, str]]:
    """Path and text of each file that is counted."""
    command = ["git", "archive", commit]
    packed = subprocess.run(command, cwd=ROOT, capture_output=True, check=True).stdout  # noqa: S603
    with tarfile.open(fileobj=io.BytesIO(packed)) as files:
        for each in files:
            if each.isfile() and area_of(each.name):
                yield each.name, files.extractfile(each).read().decode("utf-8")  # type: ignore[union-attr]


def area_of(path: str) -> str:
    """The first area whose pattern fits the path; empty where none does."""
    return next((area for area, pattern in AREAS.items() if re.fullmatch(pattern, path)), "")


def code(text: str) -> tuple[int, int]:
    """Lines of code of a Python file, and their tokens."""
    lines, tokens, fresh = set[int](), 0, True
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        if token.type not in IDLE and not (fresh and token.type == tokenize.STRING):
            lines.update(range(token.start[0], token.end[0] + 1))
            tokens += 1
        if token.type != tokenize.COMMENT:
            fresh = token.type in IDLE
    return len(lines), tokens


def counted(commit: str) -> dict[str, float]:
    """All counts of a commit, by name."""
    found, rooms = Counter[str](), Counter[str]()
    for path, text in texts(commit):
        area, lines = area_of(path), text.count("\n")
        found[f"{area}: files"] += 1
        found[f"{area}: lines"] += lines
        if path.endswith(".py"):
            of_code, tokens = code(text)
            found[f"{area}: lines of code"] += of_code
            found[f"{area}: tokens"] += tokens
            found[f"files of more than {LONGEST} lines"] += lines > LONGEST
            rooms[str(Path(path).parent)] += 1
        for phrase, pattern in PHRASES.items():
            found[f'"{phrase}"'] += len(re.findall(pattern, text, re.IGNORECASE))
    found[f"rooms of more than {FULLEST} files"] = sum(number > FULLEST for number in rooms.values())
    ratios = {
        f"{area}: tokens a line of code": round(
            found.pop(f"{area}: tokens") / found[f"{area}: lines of code"], 3
        )
        for area in AREAS
        if f"{area}: tokens" in found
    }
    return {**found, **ratios}


def main(argv: Sequence[str] | None = None) -> int:
    """Print the counts of the commits side by side."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("commits", nargs="*", default=["HEAD"])
    columns = [counted(commit) for commit in parser.parse_args(argv).commits]
    for name in sorted({name for column in columns for name in column}):
        print(f"{name:42}", *(f"{column.get(name, 0):>10}" for column in columns))
    return 0


if __name__ == "__main__":
    sys.exit(main())
