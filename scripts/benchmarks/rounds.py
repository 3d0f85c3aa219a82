"""The independent search once more for the random tasks of `limited.py`, whose file keeps what it finds."""

import json
from collections.abc import Iterator
from dataclasses import fields

from independent_search import STARTS, search
from limited import RANDOM, problem_of
from measuring import Case


def another_round(count: int, seed: int) -> Iterator[str]:
    """The best and all rounds of each task."""
    del seed
    document = json.loads(RANDOM.read_text(encoding="utf-8"))
    for task in document["tasks"][:count]:
        problem = problem_of(task["toml"], task["name"])
        found = search(problem, STARTS, seed=len(task["rounds"]))
        task["rounds"].append(found.error if found else None)
        if found and (task["best"] is None or found.error < task["best"]):
            linkage = found.linkage
            values = {each.name: getattr(linkage, each.name).tolist() for each in fields(linkage)}
            task.update(best=found.error, linkage=values)
        RANDOM.write_text(json.dumps(document, indent=1) + "\n", encoding="utf-8")
        yield "{name}: best {best}, rounds {rounds}".format(**task)


CASES = [Case("another round", 60, another_round)]
