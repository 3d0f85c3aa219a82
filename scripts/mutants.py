"""Files that nobody should write: problems, linkages and lists of designs, mutated; for `fuzz.py`.

A mutant comes from a file that is right, its seed: keys are dropped, added and renamed, values
exchanged for hostile ones, lists made too long or too deep; then, now and then, the bytes are damaged.
"""

from __future__ import annotations

import copy
import json
import math
import random
import sys
import tempfile
import tomllib
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from datetime import date, datetime, time
from pathlib import Path
from typing import Any, Literal, get_args

from grashof import load, synthesize
from grashof.output.run_files import write_run
from grashof.problems import Problem, catalogue, linkage_catalogue, linkage_text, problem_text

Kind = Literal["problem", "linkage", "list"]
KINDS: tuple[Kind, ...] = get_args(Kind)


@dataclass(frozen=True, slots=True)
class Seed:
    """A file that is right.

    Parameters
    ----------
    kind : {"problem", "linkage", "list"}
    document : dict
        As parsed.
    """

    kind: Kind
    document: dict[str, Any]


@dataclass(frozen=True, slots=True)
class Mutant:
    """A file that may be wrong.

    Parameters
    ----------
    kind : {"problem", "linkage", "list"}
    content : bytes
    made_by : tuple of str
        What was done to the seed.
    """

    kind: Kind
    content: bytes
    made_by: tuple[str, ...]

    @property
    def suffix(self) -> str:
        """Of the file's name."""
        return ".json" if self.kind == "list" else ".toml"


_HEAD = 'title = "Étage 2"\nsource = "made up"\nlength_unit = "mm"\n'
_POSES = "poses = [[0, 0, 0], [30, 10, 10], [60, 15, 25], [90, 10, 40], [120, -5, 60], [130, -30, 80]]\n"
_POINTS = "points = [[100, 0], [80, 30], [40, 45], [0, 30], [-20, 0], [0, -25], [50, -30]]\n"
_LIMITS = """
[requirements]
tolerance = 1e-6
rotatability = "any"
rotatability_margin = 0.001
order = true
same_branch = true
transmission_min_deg = 5
transmission_over = "task"
link_length = [1, 4000]
r1 = [1, 4000]
r2 = [1, 4000]
r3 = [1, 4000]
r4 = [1, 4000]
coupler_arms = [0, 4000]
link_ratio_max = 20
o2 = { x = [-1000, 1000], y = [-1000, 1000] }
o4 = { x = [-1000, 1000] }
a = { x = [-1000, 1000], y = [-1000, 1000] }
b = { y = [-1000, 1000] }
size = [1, 9000]
omega4_max = [0, 100]
point_speed_max = [0, 1e6]
point_acceleration_max = [0, 1e8]
coupler_fit_r2 = [-10, 1]
driver_rotation_deg = [1, 360]
driver_sense = "either"
output_swing_deg = [1, 360]
time_ratio = [1, 9]
mechanical_advantage_min = 0.01
keep_out = [[[500, 500], [600, 500], [600, 600]], [[500, 700], [600, 700], [600, 800], [500, 800]]]
keep_out_for = ["o2", "o4", "a", "b", "p", "links"]
"""
_MASSES = """
[dynamics]
speed_rpm = 20
gravity = [0, -9.81]
masses = [0.5, 1.2, 0.8]
inertias = [0.1, 0.6, 0.3]
payload = 2
"""
_MAKING = "[manufacturing]\nlength_tolerance = 0.02\nband = 0.5\n"
_SEARCH = "[search]\nstarts = 20\nenough = 5\nseed = 3\neffort = 0.2\n"
# Together with the catalogue these state every key that there is.
# Everything that a file can say about what acts.
_ACTING = """
[dynamics]
density = 7850
speed_rpm = 20
gravity = [0, -9.81]
payload = 2
[[loads]]
link = 4
at = [4.5, 0]
force = [0, -1000]
[[loads]]
link = 3
moment = 12
[[loads]]
link = 3
over = "theta4"
frame = "link"
values = [[0, 1, 2], [180, 3, 4], [360, 1, 2]]
[[loads]]
link = 2
over = "time"
values = [[0, 5], [10, 6]]
[[springs]]
between = [{ link = 1, at = [0, 2] }, { link = 4, at = [1, 0] }]
stiffness = 500
free_length = 1.2
[[dampers]]
between = [{ link = 2 }, { link = 4, at = [1, 0] }]
damping = 5
[[torsion_springs]]
between = [4, 3]
stiffness = 7
free_angle_deg = 30
[[counterweights]]
link = 2
mass = 900
at = [-1.0, 0]
[friction]
coulomb = 0.1
pin_radius = [0.05, 0.05, 0.05, 0.1]
viscous = 2
[motor]
profile = "trapezoid"
ramp = 0.25
gear_ratio = 30
gear_efficiency = 0.9
inertia = 0.02
[section]
width = 0.2
height = 0.1
[strength]
yield_stress = 235e6
elastic_modulus = 2.1e11
pin_diameter = [0.1, 0.1, 0.1, 0.2]
"""
# The same in other words.
_OTHERWISE = """
[dynamics]
masses = [1, 2, 3]
inertias = [1, 2, 3]
centres = [[0.5, 0], [2, 0.1], [1, 0]]
[section]
area = 0.01
inertia = [1e-5, 1e-5, 2e-5]
extreme_fibre = 0.1
inertia_across = 1e-5
shear_factor = 2
[strength]
yield_stress = 235e6
pin_diameter = 0.1
pin_shear_strength = 1e8
bearing_strength = 2e8
pin_thickness = 0.05
double_shear = true
[friction]
moment = 2
[motor]
values = [[0, 0], [1, 20], [2, 40]]
"""
_SLIDING = """
[dynamics]
mass_per_length = 2
speed_rpm = -30
[[loads]]
link = 4
over = "travel"
values = [[-9, 1, 2], [0, 3, 4], [9, 1, 2]]
[friction]
slide_mu = 0.1
slide_length = 0.4
slide_viscous = 2
slide_force = 3
"""
_PROBLEMS = (
    f'kind = "motion"\nlength_unit = "m"\n[motion]\nposes = [[5, 4, 0], [2, 3, -5]]\n{_OTHERWISE}',
    f'kind = "motion"\nlength_unit = "m"\n[motion]\nposes = [[5, 4, 0], [3.5, 4, -5], [2, 3, -5]]\n'
    "[requirements]\nlink_length = [0.3, 8]\n"
    f"[objective]\nmaximise = {{ transmission = 1, torque = 0.2 }}\n{_ACTING}",
    f'kind = "motion"\n{_HEAD}[motion]\n{_POSES}weights = [1, 1, 2, 1, 1, 1]\nangle_length = 100\n'
    "body = [[0, 0], [20, 0], [20, 10]]\nwithin = 5\nangle_within_deg = [3, 3, 3, 3, 3, 3]\n"
    "[scene]\noutlines = [[[0, 0], [50, 0]], [[0, 0], [0, 50], [50, 50]]]\n"
    f"{_LIMITS}ground_angle_deg = [-20, 40]\ntorque_peak = [0, 1e6]\n"
    "torque_rms = [0, 1e6]\njoint_force_peak = [0, 1e6]\n"
    "a_on_body = { x = [-500, 500], y = [-500, 500] }\nb_on_body = { x = [-500, 500] }\n"
    "worst_move = [0, 100]\nshare_within_made = [0, 1]\n"
    "[objective]\nmaximise = { transmission = 1, compactness = 0.1, torque = 0.2, joint_force_peak = 0.1 }\n"
    f"{_MASSES}{_MAKING}{_SEARCH}",
    f'kind = "motion"\n{_HEAD}[motion]\n{_POSES}timing_deg = [0, 30, 60, 90, 120, 150]\nclosed = false\n'
    f'[requirements]\nexact = false\nerror_factor = 1.5\n[objective]\nmaximise = "compactness"\n{_SEARCH}',
    'kind = "motion"\n[motion]\nposes = [[0, 0, 0], { x = 30, y = 10 }, { angle = 20 }, [60, 15, 25]]\n'
    "[requirements]\no2 = [0, -100]\n",
    f'kind = "path"\n{_HEAD}[path]\n{_POINTS}closed = true\n{_LIMITS}exact = false\nhausdorff = [0, 500]\n'
    f"frechet = [0, 500]\n[objective]\n{_SEARCH}".replace("[objective]\n", ""),
    f'kind = "path"\n{_HEAD}[path]\n{_POINTS}timing_deg = [0, 40, 90, 130, 180, 230, 300]\nwithin = 4\n'
    f"[requirements]\ntheta2_start_deg = 20\n{_MASSES.replace('masses', '# ').replace('inertias', '# ')}"
    f"mass_per_length = 0.01\n{_SEARCH}",
    f'kind = "stroke"\n{_HEAD}[stroke]\nswing_deg = 60\ntime_ratio = 1.2\n{_SEARCH}',
    f'kind = "stroke"\nmechanism = "slider-crank"\n{_HEAD}[stroke]\nstroke = 60\ntime_ratio = 1.2\n{_SEARCH}',
    'kind = "function"\n[function]\nlaw = "power"\nexponent = 1.5\nx = [1, 4]\ninput_range_deg = 90\n'
    "output_range_deg = 90\npairs = 4\n[requirements]\nstructural_error_max_deg = [0, 5]\n"
    f"structural_error_rms_deg = [0, 4]\n{_SEARCH}",
    'kind = "function"\n[function]\nlaw = "sampled"\nsampled = [0, 1, 3, 4, 4.5]\nx = [0, 1]\n'
    f'input_range_deg = 60\noutput_range_deg = 40\nnorm = "max"\nsense = "either"\n{_SEARCH}',
    f'kind = "function"\nmechanism = "slider-crank"\n{_HEAD}[function]\ninput_deg = [0, 30, 60, 100]\n'
    "output = [0, 9, 21, 40]\n[requirements]\nstructural_error_max = [0, 5]\nstructural_error_rms = [0, 4]\n"
    f"{_SEARCH}",
    f'kind = "function"\nmechanism = "slider-crank"\n[function]\nlaw = "exp"\nx = [0, 1]\n'
    f"input_range_deg = 60\noutput_range = 40\n{_SEARCH}",
    f'kind = "path"\n{_HEAD}[path]\npoints = [[0, 0], [30, 10], [60, 0]]\n{_SEARCH}',
    f'kind = "path"\nmechanism = ["slider-crank", "four-bar"]\n{_HEAD}[path]\n{_POINTS}'
    f"[requirements]\noffset = [-90, 90]\nslide_angle_deg = [-20, 40]\nstroke = [1, 900]\n{_SEARCH}",
    f'kind = "path"\nmechanism = "inverted-slider-crank"\n{_HEAD}[path]\npoints = [[0, 0], [3, 1], [6, 0]]\n'
    f"{_SEARCH}{_SLIDING.replace('-30', '30')}",
    f'kind = "path"\nmechanism = ["slider-crank", "inverted-slider-crank"]\n{_HEAD}[path]\n'
    "points = [[0, 0], [30, 10], [60, 0]]\n[requirements]\ncylinder_angle_min_deg = 20\n[driver]\n"
    'cylinder = { closed = [20, 90], ratio_max = 1.7, on = ["driver", "output"], base = { x = [-90, 90] } }\n'
    f"{_SEARCH}",
    f'kind = "motion"\n{_HEAD}[motion]\nposes = [[0, 0, 10], [30, 10, 10], [60, 5, 10]]\n{_SEARCH}',
)


def _acting(changes: dict[str, str]) -> str:
    """`_ACTING` on a linkage with a slide: bars of a density, loads over the travel, no pin in the slide."""
    text = _ACTING
    for old, new in changes.items():
        text = text.replace(old, new)
    return text


_ON_SLIDE = {'"theta4"': '"travel"', "[180, 3": "[9, 3", "[[0, 1, 2]": "[[-9, 1, 2]", "05, 0.1]": "05, 0]"}
_SLIDER_CRANK = (
    f'mechanism = "slider-crank"\n{_HEAD}o2 = [1, 2]\nr2 = 1\nr3 = 3\noffset = -0.5\nslide_angle_deg = 30\n'
    "coupler_point = [1, 1]\nassembly = -1\nbody_angle_deg = 30\n"
)
_INVERTED = f'mechanism = "inverted-slider-crank"\n{_HEAD}o2 = [1, 2]\nr2 = 1\noffset = -0.5\n'
_FOUR_BAR = 'length_unit = "m"\no4 = [4, 0]\nr2 = 1\nr3 = 4\nr4 = 3\n'
_SIX_BAR = (
    f'mechanism = "watt-2"\n{_HEAD}o2 = [1, 2]\nr1 = 4\nground_angle_deg = 20\nr2 = 1\nr3 = 4\nr4 = 3\n'
    "coupler_point = [1, 1]\nassembly = -1\nbody_angle_deg = 30\npoint_link = 6\n"
)
_DYAD = '[dyad]\nkind = "RRR"\nhosts = [4, 1]\nc = [4, 1]\nd = [9, 0]\nr5 = 4\nr6 = 3\nassembly = -1\n'
_PRESS = '[dyad]\nkind = "RRP"\nhosts = [4, 1]\nc = [4, 1]\nr5 = 7\noffset = -2\nslide_angle_deg = 30\n'
_ON_SIX = """
[dynamics]
masses = [1, 2, 3, 4, 5]
inertias = [1, 2, 3, 4, 5]
centres = [[0.5, 0], [2, 0.1], [1, 0], [1, 0], [1, 0]]
[[loads]]
link = 6
over = "theta6"
values = [[0, 1, 2], [180, 3, 4], [360, 1, 2]]
[[torsion_springs]]
between = [6, 5]
stiffness = 7
[friction]
viscous = [1, 2, 3, 4, 5, 6, 7]
"""
_LINKAGES = (
    *(_SLIDER_CRANK + acting for acting in (_SLIDING, _OTHERWISE, _acting(_ON_SLIDE))),
    f"{_INVERTED}r1 = 4\nground_angle_deg = 200\n"
    "coupler_point = [1, 1]\nassembly = -1\nbody_angle_deg = 30\noutput_arm = 2\n",
    *(
        f"{_INVERTED}o4 = [5, 2]\n{acting}"
        for acting in (_SLIDING, _OTHERWISE, _acting({"[4, 3]": "[2, 3]", "0.05, 0.1]": "0, 0.1]"}))
    ),
    *(_FOUR_BAR + acting for acting in (_OTHERWISE, _ACTING)),
    f"{_HEAD}r1 = 4\nground_angle_deg = 20\nr2 = 1\nr3 = 4\nr4 = 3\ncoupler_point = [2, 1]\nassembly = -1\n"
    "body_angle_deg = 30\noutput_arm = 5\n[dynamics]\nspeed_rpm = -20\ngravity = [0, -9.81]\n"
    "mass_per_length = 3\npayload = 2\n"
    '[pumping_unit]\nwell = "left"\ncrank = "counter-clockwise"\nstructural_unbalance = -900\nrating = 9e4\n'
    'counterbalance = 3e4\ncounterbalance_phase_deg = 5\nover = "position"\n'
    "values = [[0, 2, 1], [1, 2, 2]]\n",
    "length_unit = 'm'\no4 = [5, 3]\nr2 = 1.2\nr3 = 3.8\nr4 = 3\noutput_arm = 4\n"
    "[pumping_unit]\nrod_load = 2e4\n",
    "o2 = [1, 1]\no4 = [5, 1]\nr2 = 3\nr3 = 3\nr4 = 4\n",  # its driver does not turn fully
    f"{_SIX_BAR}{_DYAD}{_ON_SIX}",
    f"{_SIX_BAR.replace('r1 = 4', 'o4 = [5, 3]').replace('ground_angle_deg = 20', '')}{_PRESS}{_SLIDING}",
)


def problem_seeds() -> list[Seed]:
    """The problems of the catalogue, and others that use every key."""
    texts = [*map(problem_text, catalogue()), *_PROBLEMS]
    return [Seed("problem", tomllib.loads(text)) for text in texts]


def linkage_seeds() -> list[Seed]:
    """The linkages of the catalogue, and others that use every key."""
    texts = [*map(linkage_text, linkage_catalogue()), *_LINKAGES]
    return [Seed("linkage", tomllib.loads(text)) for text in texts]


def list_seeds() -> list[Seed]:
    """A list of designs for a problem with masses and for a path, as a search writes them."""
    return [Seed("list", _list_of(load(name))) for name in ("luggage", "path-vertical-line")]


def _list_of(problem: Problem) -> dict[str, Any]:
    with tempfile.TemporaryDirectory() as folder:
        write_run(Path(folder), synthesize(problem, starts=4, enough=2), {}, drawings=0)
        document: dict[str, Any] = json.loads((Path(folder) / "candidates.json").read_bytes())
    return document | {"designs": document["designs"][:3]}


_NUMBERS: tuple[Any, ...] = (
    math.nan, math.inf, -math.inf, 1e308, -1e308, 1e-308, 5e-324, -0.0, 0, 1, -1, 0.5, 2, 3, 90, 180, 360,
    1e20, 1.0000001e20, -1e20, 1e-20, 1e-21, 1e15, 1e-12, 10**18, 10**30, 10**400, -(10**400), 2**63, 2**64,
    16**5000,
)  # fmt: skip
_WORDS: tuple[Any, ...] = (
    "", "x" * 100_000, "motion", "path", "transmission", "torque", "any", "mm", "furlong", "1", "nan",
    "\x00", "\x1b[31m", "two\nlines", "\u202e", "\u2028", "\ufeff", "\uffff", "é", "漢字", "😀", "../../x",
    "=1+1", "</script>", "{{ 7 * 7 }}", "%s%n", "$x^$",
)  # fmt: skip
_OTHERS: tuple[Any, ...] = (
    True, False, [], {}, [[]], [{}], [[[[]]]], [1], [1, 2], [2, 1], [0, 0], [1, 2, 3], [1, "2"],
    [True, False],
    [math.nan, 0], [0, math.inf], [0, 0, 0, 0], {"x": 1}, {"x": [0, 1]}, {"x": [1, 0], "y": [0]}, {"": 1},
    {"x": {"y": {"z": 0}}}, date(2024, 1, 1), time(1, 2), datetime(1, 1, 1), [date(2024, 1, 1)] * 3,
    [[0, 0], [0, 0]], [[0, 0], [1, 1], [0, 1], [1, 0]], [[0, 0], [1, 0]], [[0, 0, 0]] * 3, [["a"]] * 3,
)  # fmt: skip
_FACTORS = (-1, 0, 0.5, 0.9, 1.01, 2, 10, 1e3, 1e-3, 1e6, 1e-6, 1e15, 1e-15)


class Mutator:
    """Makes mutants of seeds.

    Parameters
    ----------
    seeds : list of Seed
    rng : random.Random
    """

    def __init__(self, seeds: list[Seed], rng: random.Random) -> None:
        self.seeds, self.rng = seeds, rng
        self._known = sorted({key for seed in seeds for key in _keys(seed.document)})
        self._tables: dict[tuple[str, str], list[tuple[str, Any]]] = {}
        for seed in seeds:
            for path, table in tables_of(seed.document):
                self._tables.setdefault((seed.kind, path), []).extend(table.items())
        self._ways: tuple[tuple[int, Callable[[dict[str, Any]], None]], ...] = (
            (6, self._scale),
            (4, self._hostile),
            (2, self._add),
            (2, self._drop),
            (1, self._rename),
            (1, self._exchange),
            (2, self._length),
            (1, self._nest),
        )

    def mutant(self) -> Mutant:
        """A mutant of one of the seeds."""
        seed = self.rng.choice(self.seeds)
        document, done = copy.deepcopy(seed.document), []
        for _ in range(self.rng.choice((1, 1, 1, 2, 2, 3, 5))):
            way = self.rng.choices([way for _, way in self._ways], [weight for weight, _ in self._ways])[0]
            way(document)
            done.append(way.__name__.lstrip("_"))
        text = _json_text(document) if seed.kind == "list" else toml_text(document)
        content = text.encode("utf-8", "surrogatepass")
        if self.rng.random() < 0.15:
            content = self._damaged(content)
            done.append("damaged")
        return Mutant(seed.kind, content, tuple(done))

    def _place(self, document: dict[str, Any], *, deep: float = 0.75) -> tuple[Any, Any] | None:
        """A container somewhere in the document, and the key or index of one of its entries."""
        holder: Any = document
        if not holder:
            return None
        while True:
            keys = list(holder) if isinstance(holder, dict) else range(len(holder))
            key = self.rng.choice(keys)
            below = holder[key]
            if not (isinstance(below, (dict, list)) and below and self.rng.random() < deep):
                return holder, key
            holder = below

    def _scale(self, document: dict[str, Any]) -> None:
        """Another number in place of one: most likely to be accepted."""
        place = self._place(document, deep=1.0)
        if place is not None and type(place[0][place[1]]) in (int, float):
            holder, key = place
            factor = self.rng.choice((*_FACTORS, self.rng.uniform(0.5, 2)))
            holder[key] = holder[key] * factor if abs(holder[key]) < 1e300 else factor

    def _hostile(self, document: dict[str, Any]) -> None:
        place = self._place(document)
        if place is not None:
            place[0][place[1]] = copy.deepcopy(self.rng.choice(self.rng.choice((_NUMBERS, _WORDS, _OTHERS))))

    def _add(self, document: dict[str, Any]) -> None:
        """A key of another file into the same table: most likely a conflict."""
        kind = "problem" if "kind" in document else "list" if "designs" in document else "linkage"
        tables = list(tables_of(document))
        path, table = self.rng.choice(tables)
        entries = self._tables.get((kind, path))
        if entries:
            key, value = self.rng.choice(entries)
            table[key] = copy.deepcopy(value)

    def _drop(self, document: dict[str, Any]) -> None:
        place = self._place(document, deep=0.6)
        if place is not None:
            del place[0][place[1]]

    def _rename(self, document: dict[str, Any]) -> None:
        _, table = self.rng.choice(list(tables_of(document)))
        if table:
            old = self.rng.choice(list(table))
            ways = (old + "s", old[:-1], old.upper(), old + "_deg", "", "a.b", "é", "x" * 5000, "\x00", "\n")
            table[self.rng.choice((*ways, self.rng.choice(self._known)))] = table.pop(old)

    def _exchange(self, document: dict[str, Any]) -> None:
        one, other = self._place(document), self._place(document)
        if one is not None and other is not None:
            value = copy.deepcopy(other[0][other[1]])
            one[0][one[1]] = value

    def _length(self, document: dict[str, Any]) -> None:
        """A list that is too long, too short, or says the same twice."""
        place = self._place(document, deep=0.5)
        entry = None if place is None else place[0][place[1]]
        if isinstance(entry, list) and entry:
            at = self.rng.randrange(len(entry))
            way = self.rng.random()
            if way < 0.3:
                entry.insert(at, copy.deepcopy(entry[at]))
            elif way < 0.6:
                del entry[at]
            elif way < 0.75:
                entry.reverse()
            elif way < 0.9:
                del entry[at:]
            else:
                entry[:] = (entry * (self.rng.choice((100, 4000)) // len(entry) + 1))[:4000]

    def _nest(self, document: dict[str, Any]) -> None:
        place = self._place(document)
        if place is not None:
            holder, key = place
            for _ in range(self.rng.choice((1, 1, 2, 50, 150))):
                holder[key] = [holder[key]]

    def _damaged(self, content: bytes) -> bytes:
        """The bytes cut short, in another encoding, with other line ends, with something in between."""
        text, lines = content.decode("utf-8", "replace"), content.split(b"\n")
        at = self.rng.randrange(len(content) + 1)
        line = self.rng.randrange(len(lines))
        junk = (b"\x00", b"\xff\xfe", b"\xc3", b"\xed\xa0\x80", b"\x1b", b"=", b"[", b'"', b"[" * 3000, b"\r")
        return self.rng.choice(
            (
                lambda: content[:at],
                lambda: b"\xef\xbb\xbf" + content,
                lambda: text.encode("utf-16"),
                lambda: text.encode("latin-1", "replace"),
                lambda: content.replace(b"\n", b"\r\n"),
                lambda: content.replace(b"\n", b"\r"),
                lambda: b"\n".join([*lines[:line], lines[line], *lines[line:]]),
                lambda: b"\n".join([*lines[:line], *lines[line + 1 :]]),
                lambda: content[:at] + self.rng.choice(junk) + content[at:],
                lambda: content[:at] + bytes([self.rng.randrange(256)]) + content[at + 1 :],
                lambda: content + content,
            )
        )()


def _json_text(document: dict[str, Any]) -> str:
    """The same as JSON; Python writes no number of thousands of digits unless it is told to."""
    before = sys.get_int_max_str_digits()
    sys.set_int_max_str_digits(0)
    try:
        return json.dumps(document, default=str)
    finally:
        sys.set_int_max_str_digits(before)


def toml_text(document: dict[str, Any]) -> str:
    """A document as TOML, whatever it holds: a line for each key, then the tables."""
    plain = {key: value for key, value in document.items() if not isinstance(value, dict)}
    lines = [f"{_word(key)} = {_value(value)}" for key, value in plain.items()]
    for name, table in document.items():
        if isinstance(table, dict):
            lines += [
                f"[{_word(name)}]",
                *(f"{_word(key)} = {_value(value)}" for key, value in table.items()),
            ]
    return "\n".join(lines) + "\n"


def _word(text: str) -> str:
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")


def _value(value: Any) -> str:
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{_word(key)} = {_value(each)}" for key, each in value.items()) + " }"
    if isinstance(value, list):
        return f"[{', '.join(map(_value, value))}]"
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        return _word(value)
    if isinstance(value, int):  # Python writes no number of thousands of digits in decimals
        return hex(value) if value > 10**1000 else repr(value)
    return value.isoformat() if isinstance(value, (date, time)) else repr(value)


def tables_of(table: dict[str, Any], path: str = "") -> Iterator[tuple[str, dict[str, Any]]]:
    """A document and all tables in it, with their key paths."""
    yield path, table
    for key, value in table.items():
        for each in value if isinstance(value, list) else [value]:
            if isinstance(each, dict):
                yield from tables_of(each, f"{path}.{key}".lstrip("."))


def _keys(document: dict[str, Any]) -> Iterator[str]:
    for _, table in tables_of(document):
        yield from table
