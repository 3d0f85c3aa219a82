"""The JSON Schema of files: what the program reads conforms to it, and mistakes of editors do not."""

from __future__ import annotations

import copy
import random
import re
import sys
import tomllib
from functools import cache
from itertools import chain
from pathlib import Path
from typing import Any

import pytest
from refusals import rows

from grashof.problems import ProblemError, catalogue, linkage_catalogue, linkage_text, problem_text
from grashof.problems.files.linkage_schema import FILES, linkage_from
from grashof.problems.files.problem_schema import problem_from
from grashof.problems.files.tables import tables_of
from grashof.problems.schema import FileKind
from grashof.problems.schema.json_schema import json_schema
from grashof.problems.schema.keys import described_keys, linkage_tables, problem_tables
from grashof.problems.values.dynamics.load_specs import OVER
from grashof.problems.values.dynamics.pumping_unit import CRANK, POSITION
from grashof.problems.values.tasks.function_law import LAWS, SAMPLED
from grashof.problems.values.tasks.function_task import NORMS, SENSES

ROOT = Path(__file__).parents[3]
sys.path.append(str(ROOT / "scripts"))
from mutants import Mutator, linkage_seeds, problem_seeds  # noqa: E402

jsonschema = pytest.importorskip("jsonschema")

BLOCK = re.compile(r"^```toml\n(.*?)^```", re.MULTILINE | re.DOTALL)
SEEDS = {FileKind.PROBLEM: problem_seeds, FileKind.LINKAGE: linkage_seeds}


@cache
def schema_of(kind: FileKind) -> dict[str, Any]:
    return json_schema(kind)


@cache
def validator(kind: FileKind) -> Any:
    jsonschema.Draft202012Validator.check_schema(schema_of(kind))
    return jsonschema.Draft202012Validator(schema_of(kind))


def errors(kind: FileKind, document: dict[str, Any]) -> list[str]:
    return [f"{each.json_path}: {each.message}" for each in validator(kind).iter_errors(document)]


@pytest.mark.parametrize("kind", FileKind)
def test_files_with_every_key_conform(kind: FileKind) -> None:
    texts = [problem_text(name) for name in catalogue()]
    if kind is FileKind.LINKAGE:
        texts = [linkage_text(name) for name in linkage_catalogue()]
    for document in (*map(tomllib.loads, texts), *(seed.document for seed in SEEDS[kind]())):
        assert errors(kind, document) == []


def test_examples_of_the_pages_conform() -> None:
    """Some show a few tables; these need not state a task."""
    whole = schema_of(FileKind.PROBLEM)
    part = {key: value for key, value in whole.items() if key not in ("required", "allOf")}
    checked = 0
    for page in sorted((ROOT / "docs" / "howto").glob("*.md")):
        for text in BLOCK.findall(page.read_text(encoding="utf-8")):
            document = tomllib.loads(text)
            if "vary" in document:  # a study
                continue
            linkage = "r2" in document
            wanted = validator(FileKind.LINKAGE) if linkage else jsonschema.Draft202012Validator(part)
            assert [str(each) for each in wanted.iter_errors(document)] == [], page.name
            checked += 1
    assert checked >= 12


@pytest.mark.parametrize("kind", FileKind)
def test_what_the_program_reads_conforms(kind: FileKind) -> None:
    """Of damaged files, those that are still right."""
    seeds = [seed for seed in SEEDS[kind]() if len(str(seed.document)) < 2000]
    mutator, read = Mutator(seeds, random.Random(5)), 0  # noqa: S311
    for _ in range(120):
        try:
            document = tomllib.loads(mutator.mutant().content.decode())
            (problem_from if kind is FileKind.PROBLEM else linkage_from)(copy.deepcopy(document), "mutant")
        except (ValueError, RecursionError):
            continue
        assert errors(kind, document) == []
        read += 1
    assert read > 20


POSES = "[motion]\nposes = [[0, 0, 0], [3, 1, 40], [5, 4, 70]]"
MOTION = f'kind = "motion"\n{POSES}'
BAR = "r2 = 1\nr3 = 3\nr4 = 3\no4 = [3, 0]"
WRONG_PROBLEMS = rows("""
knd = "motion" | 'knd' was unexpected
kind = "motoin" | 'motoin' is not one of
kind = "path" | 'path' is a required property
kind = "motion"\\nmechanism = "five-bar" | is not valid under any of the given schemas
kind = "motion"\\nmechanism = ["four-bar", "four-bar"] | is not valid under any of the given schemas
kind = "motion"\\ntitle = 3 | 3 is not of type 'string'
kind = "motion"\\nrequirements.transmision_min_deg = 30 | 'transmision_min_deg' was unexpected
kind = "motion"\\nrequirements.transmission_min_deg = "30" | '30' is not of type 'number'
kind = "motion"\\nrequirements.transmission_min_deg = 91 | 91 is greater than the maximum of 90
kind = "motion"\\nrequirements.link_length = [1] | [1] is too short
kind = "motion"\\nrequirements.rotatability = "full" | 'full' is not one of
kind = "motion"\\nrequirements.exact = 1 | 1 is not of type 'boolean'
kind = "motion"\\nrequirements.keep_out = "zone.png" | is not valid under any of the given schemas
kind = "motion"\\nrequirements.keep_out_for = ["q"] | 'q' is not one of
kind = "motion"\\nrequirements.link_ratios = { "r4-r2" = 1 } | 'r4-r2' does not match
kind = "motion"\\nrequirements.link_ratios = { "r4/r2" = "1" } | is not valid under any of the given schemas
kind = "motion"\\nrequirements.distances = { "a-o2" = 1 } | 'a-o2' does not match
kind = "motion"\\nobjective.maximise = "speed" | is not valid under any of the given schemas
kind = "motion"\\nsearch.starts = 2.5 | 2.5 is not of type 'integer'
kind = "motion"\\nmotion.poses = [[1, 2]] | is not valid under any of the given schemas
kind = "motion"\\nmotion.poses = [{ x = 1 }] | is not valid under any of the given schemas
kind = "motion"\\nmotion.poses = "poses.txt" | is not valid under any of the given schemas
kind = "motion"\\nmotion.poses = [[1, 2, 3]]\\npath.points = [] | False schema does not allow
kind = "motion"\\nloads = [{ link = 2, at = [0, 0], force = [1] }] | [1] is too short
kind = "motion"\\nloads = [{ link = 2, over = "theta9" }] | 'theta9' is not one of
""")
WRONG_LINKAGES = rows("""
r5 = 1 | 'r5' was unexpected
mechanism = "five-bar" | 'five-bar' is not one of
mechanism = "slider-crank" | ('o4', 'r4' were unexpected)
r1 = 3 | is valid under each of
coupler_point = [1] | [1] is too short
assembly = 2 | 2 is not one of [1, -1]
mechanism = "watt-1" | 'dyad' is a required property
mechanism = "watt-1"\\ndyad = { c = [1, 0], d = [1, 0], r5 = 1, kind = "RPR" } | 'RPR' is not one of
pumping_unit.well = "up" | 'up' is not one of
""")


def deepest(kind: FileKind, document: dict[str, Any]) -> str:
    """All messages, of alternatives those inside, too."""
    found, rest = "", list(validator(kind).iter_errors(document))
    while rest:
        error = rest.pop()
        found += f"{error.message}\n"
        rest += error.context
    return found


@pytest.mark.parametrize(("text", "said"), WRONG_PROBLEMS)
def test_mistakes_in_problems_are_found(text: str, said: str) -> None:
    document = tomllib.loads(text.replace("\\n", "\n"))
    assert said in deepest(FileKind.PROBLEM, {**tomllib.loads(POSES), **document})
    with pytest.raises(ProblemError):
        problem_from({**tomllib.loads(POSES), **document}, "wrong", Path())


@pytest.mark.parametrize(("text", "said"), WRONG_LINKAGES)
def test_mistakes_in_linkages_are_found(text: str, said: str) -> None:
    assert errors(FileKind.LINKAGE, tomllib.loads(BAR)) == []
    document = {**tomllib.loads(BAR), **tomllib.loads(text.replace("\\n", "\n"))}
    assert said in deepest(FileKind.LINKAGE, document)
    with pytest.raises(ProblemError):
        linkage_from(document, "wrong")


def test_every_table_refuses_a_key_that_it_does_not_have() -> None:
    for kind in FileKind:
        tables = [schema_of(kind), *schema_of(kind)["$defs"].values()]
        assert all(each["additionalProperties"] is False for each in tables if "properties" in each)


def test_descriptions_and_words_are_those_of_the_reference() -> None:
    made = {kind: schema_of(kind)["$defs"] for kind in FileKind}
    for kind, tables in ((FileKind.PROBLEM, problem_tables()), (FileKind.LINKAGE, linkage_tables())):
        for table in (each for path, each in tables.items() if path and each.__name__ in made[kind]):
            stated = made[kind][table.__name__]["properties"]
            for key in described_keys(table):
                assert stated[key.name]["description"].startswith(key.text)
    assert "$ref" in made[FileKind.PROBLEM]["ObjectiveTable"]["properties"]["maximise"]["anyOf"][1]


def test_words_are_those_that_the_value_types_accept() -> None:
    problems, linkages = (schema_of(kind)["$defs"] for kind in FileKind)
    functions, loads = (problems[name]["properties"] for name in ("FunctionTable", "LoadTable"))
    assert functions["law"]["enum"] == [*LAWS, SAMPLED]
    assert (functions["sense"]["enum"], functions["norm"]["enum"]) == ([*SENSES], [*NORMS])
    assert loads["over"]["enum"] == [*OVER]
    assert linkages["PumpingUnitTable"]["properties"]["over"]["enum"] == [CRANK, POSITION]


def test_each_kind_of_linkage_has_one_definition() -> None:
    schema = schema_of(FileKind.LINKAGE)
    words = [
        schema["$defs"][each["$ref"].rpartition("/")[2]]["properties"]["mechanism"]["enum"]
        for each in schema["oneOf"]
    ]
    assert [*chain(*words)] == [*FILES]
    names = {table.__name__ for _, table in tables_of(FILES["watt-1"])}
    assert names <= schema["$defs"].keys()
