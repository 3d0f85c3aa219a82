"""The function task: output angles or travels for input angles, as a value."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, ClassVar, Literal

import numpy as np
import numpy.typing as npt

from grashof.problems.values import checks
from grashof.problems.values.arrays import FloatArray, IntArray, frozen_array
from grashof.problems.values.errors import ProblemError, listing, shown, wrong_value
from grashof.problems.values.linkages.mechanism import ONE_LOOP
from grashof.problems.values.linkages.one_loop import FourBar
from grashof.problems.values.tasks.function_law import FunctionLaw, chebyshev_spacing, lobatto_with_weights
from grashof.problems.values.tasks.function_pairs import (
    FEWEST,
    INPUT,
    INPUT_DEG,
    MOST,
    OUTPUT,
    OUTPUT_DEG,
    checked_mirror,
    checked_pairs,
    checked_rates,
    either,
    finite_numbers,
    rates_inside,
    refuse_beside,
    refuse_missing,
)
from grashof.problems.values.tasks.task import Task
from grashof.problems.values.value_bases import set_fields

SENSES = ("given", "either")
NORMS = ("rms", "max")
LINKS = ("output", "coupler")
# Kinds whose link 3 is searched for: those of one loop whose link 4 turns, with which it can be exchanged.
_OF_COUPLERS = tuple(word for word, row in ONE_LOOP.items() if row.loops[0].pinned)
_MIRRORED = FourBar.mechanism.word
LAW_PAIRS = 41  # of a law fitted over its full range
MOST_EXACT, MOST_OF_SIX_BARS = 5, 9
OF_TRIANGLE = 3  # free lengths of a cylinder on the driver: base and arm from O2, and its first length
_SLIDING, _FOUR_BAR = 8, 9  # freedoms of slider kinds, and of a four-bar


@dataclass(frozen=True, slots=True, init=False, eq=False)
class FunctionTask(Task):
    """Function generation: link 4 turns, or slides, with the driver as wanted; or the coupler turns.

    The driver is link 2, or a cylinder that turns it.

    Angles are relative: both start angles are free, and where pairs need not be met exactly the output's
    zero is, too, so that the first pair may have an error like the others.

    Parameters
    ----------
    inputs : array_like, shape (N,), rad or length
        Driver rotation from the first pair, zero there, then growing over at most one turn. Designs may
        turn the driver either way. Or the lengthening of the driving cylinder from its shortest
        length.
    outputs : array_like, shape (N,), rad or length
        Rotation of the link from the first pair, positive where it turns as the driver does; or the travel
        of a slide from there, positive along its direction.
    sense : {"given", "either"}
        Either: the opposite output will do, too.
    norm : {"rms", "max"}
        The error to minimise where pairs are not met exactly: the root mean square of the errors at the pairs
        (of a law over its range), or the structural error, greatest over the range.
    length : float, length
        Usual length of the ground, for comparison; a problem takes it from its requirements.
    law : FunctionLaw, optional
        The law of the pairs; without one the wanted output is the cubic spline through them.
    travels : bool
        The output is the travel of a slide.
    link : {"output", "coupler"}
        The link whose rotation the outputs are: the last one, or link 3, the coupler. Of slider-cranks and
        six-bars the coupler is not searched for.
    lengthens : bool
        The inputs are lengthenings of the cylinder that drives link 2; not for six-bars.
    rates : array_like, shape (R, 3), optional
        Limits of the leverage ratio d(output)/d(input): rows of input, least and greatest value, with the
        signs of the outputs.
    mirror : float, rad, optional
        Driver rotation from the first pair, or the beginning of a law, at which the linkage is its own mirror
        image about the perpendicular bisector of the ground link: r4 = r2 and the coupler parallel to the
        ground link, such as the steering of a car straight ahead. The output has no error there. Only for
        four-bars whose pairs need not be met exactly.

    Raises
    ------
    ProblemError
        Fewer than three pairs, angles that are not finite, inputs that do not grow from zero, more than a
        turn, outputs that do not move, or travels of a coupler.

    Examples
    --------
    >>> task = FunctionTask.from_degrees([0, 20, 45, 90], [0, 12, 31, 80])
    >>> len(task), task.exact_by_default, task.outputs.round(6).tolist()
    (4, True, [0.0, 0.20944, 0.541052, 1.396263])
    """

    kind: ClassVar[Literal["function"]] = "function"
    target: ClassVar[Literal["pair"]] = "pair"
    usual_rotatability: ClassVar[str] = "any"
    without: ClassVar[tuple[str, ...]] = (
        "coupler_arms", "coupler_fit_r2", "point_speed_max", "point_acceleration_max", "p", "body",
    )  # fmt: skip

    closed = False  #: The task is a range, not a full turn.
    returns = False  #: A range is not a cycle.
    within = None  #: Pairs have no zones; `structural_error_max_deg` limits the error.
    angle_length = 1.0  #: Angles are not converted to lengths.
    error_unit = 1.0  #: Errors are angles, or shares of the travel.

    inputs: FloatArray
    outputs: FloatArray
    sense: str
    norm: str
    law: FunctionLaw | None
    length: float
    travels: bool
    link: str
    lengthens: bool
    rates: FloatArray | None
    mirror: float | None

    def __init__(
        self,
        inputs: npt.ArrayLike,
        outputs: npt.ArrayLike,
        *,
        sense: str = "given",
        norm: str = "rms",
        law: FunctionLaw | None = None,
        length: float = 1.0,
        travels: bool = False,
        link: str = "output",
        lengthens: bool = False,
        rates: npt.ArrayLike | None = None,
        mirror: float | None = None,
    ) -> None:
        checks.one_of(link, "function.link", LINKS)
        if travels and link != "output":
            raise ProblemError(
                f'function.link is "{link}", which turns; with a travel of a slide it must be "output"'
            )
        given, output = checked_pairs(inputs, outputs, travels=travels, lengthens=lengthens)
        if law is not None and not isinstance(law, FunctionLaw):
            raise wrong_value("function.law", law, "a FunctionLaw")
        set_fields(
            self,
            inputs=frozen_array(given),
            outputs=frozen_array(output),
            sense=checks.one_of(sense, "function.sense", SENSES),
            norm=checks.one_of(norm, "function.norm", NORMS),
            law=law,
            length=checks.positive_number(length, "function.length"),
            travels=bool(travels),
            link=link,
            lengthens=bool(lengthens),
            mirror=mirror,
        )
        if rates is not None:
            rates = frozen_array(checked_rates(rates, given, self.rate_unit, lengthens=self.lengthens))
        set_fields(self, rates=rates)
        if mirror is not None:
            set_fields(self, mirror=checked_mirror(self, mirror))

    @classmethod
    def of_law(
        cls, law: FunctionLaw, *, pairs: int | None = None, sense: str = "given", norm: str = "rms",
        link: str = "output", rates: npt.ArrayLike | None = None, mirror: float | None = None,
    ) -> FunctionTask:  # fmt: skip
        """The task of a law over its full range.

        Parameters
        ----------
        law : FunctionLaw
        pairs : int, optional
            Number of pairs, at Chebyshev spacing; by default as many as fit the full range.
        sense, norm, link : str
        rates : array_like, shape (R, 3), optional
            Their inputs count from the first pair.
        mirror : float, rad, optional
            From the beginning of the range.
        """
        if pairs is None:
            places = lobatto_with_weights(LAW_PAIRS)[0]
        else:
            if checks.whole_number(pairs, FEWEST, "function.pairs") > MOST:
                raise ProblemError(f"function.pairs is {shown(pairs)}; it must be at most {MOST}")
            places = chebyshev_spacing(pairs)
        turned = law.input_range * places
        output = law.output(turned)
        turned, output = turned - turned[0], output - output[0]
        words = {"sense": sense, "norm": norm, "link": link, "mirror": mirror}
        return cls(turned, output, law=law, travels=law.travels, rates=rates, **words)  # type: ignore[arg-type]

    @classmethod
    def from_degrees(
        cls,
        input_deg: npt.ArrayLike | None = None,
        output_deg: npt.ArrayLike | None = None,
        *,
        input: npt.ArrayLike | None = None,  # noqa: A002  (the key of files)
        output: npt.ArrayLike | None = None,
        law: str | Callable[[FloatArray], FloatArray] | None = None,
        x: tuple[float, float] | None = None,
        exponent: float | None = None,
        input_range_deg: float | None = None,
        output_range_deg: float | None = None,
        output_range: float | None = None,
        pairs: int | None = None,
        sampled: npt.ArrayLike | None = None,
        sense: str = "given",
        norm: str = "rms",
        link: str = "output",
        rate: npt.ArrayLike | None = None,
        mirror_deg: float | None = None,
    ) -> FunctionTask:
        """Task with its angles in degrees, as problem files write it: pairs, or a law with its ranges.

        In Python `law` may be any function of x; it is sampled.

        Parameters
        ----------
        input_deg : array_like, deg, optional
            Driver rotation from the first pair: zero, then growing over at most one turn.
        output_deg : array_like, deg, optional
            Rotation of link 4, or the coupler, from the first pair, one for each input; positive as the
            driver turns.
        input : array_like, length, optional
            Instead of angles, the lengthening of the cylinder under `[driver]` from the first pair: zero,
            then growing. The cylinder acts on link 2.
        output : array_like, length, optional
            Instead, travel of a slide from the first pair.
        law : {"log10", "ln", "exp", "sin", "cos", "tan", "sqrt", "reciprocal", "power", "sampled"}, optional
            Instead of pairs, a function y(x); sin, cos and tan are of degrees.
        x : pair of float, optional
            Range of the law, from and to.
        exponent : float, optional
            Of a power.
        input_range_deg : float, deg, optional
            Driver rotation over the range of x.
        output_range_deg : float, deg, optional
            Rotation of link 4, or the coupler, over the range of y.
        output_range : float, length, optional
            Instead, travel of a slide over the range of y.
        pairs : int, optional
            Pairs that are met exactly, at Chebyshev's spacing; without them the law is fitted over its range.
        sampled : array_like, optional
            Of a sampled law, as Grashof saves one that was a function in Python: y at Chebyshev-Lobatto
            points of `x`.
        rate : array_like, optional
            Rows [input, lo, hi]: limits of the leverage ratio d(output)/d(input) at an input, in the units of
            both lists.

        Examples
        --------
        >>> ranges = {"input_range_deg": 60, "output_range_deg": 90}
        >>> task = FunctionTask.from_degrees(law="log10", x=(1, 2), **ranges, pairs=5)
        >>> np.degrees(task.inputs).round(3).tolist()
        [0.0, 10.898, 28.532, 46.165, 57.063]
        """
        table: dict[str, Any] = {INPUT_DEG: input_deg, INPUT: input, OUTPUT_DEG: output_deg, OUTPUT: output}
        stated: dict[str, Any] = {
            "x": x,
            "input_range_deg": input_range_deg,
            "output_range_deg": output_range_deg,
            "output_range": output_range,
        }
        lengthens = either(INPUT, input_deg, input, "an input is an angle or the length of a cylinder")
        slides = "an output turns or slides"
        travels = either(OUTPUT, output_deg, output, slides)
        travels = either("output_range", output_range_deg, output_range, slides) or travels
        mirror = None if mirror_deg is None else checks.finite_number(mirror_deg, "function.mirror_deg")
        mirror = None if mirror is None else float(np.radians(mirror))
        words: dict[str, Any] = {"sense": sense, "norm": norm, "link": link, "mirror": mirror}
        if law is None:
            others = {"exponent": exponent, "pairs": pairs, "sampled": sampled}
            refuse_beside(stated | others, "goes with function.law only")
            keys = INPUT if lengthens else INPUT_DEG, OUTPUT if travels else OUTPUT_DEG
            refuse_missing(table, *({INPUT_DEG, INPUT, OUTPUT_DEG, OUTPUT} - {*keys}))
            given, outputs = (
                np.radians(values) if key.endswith("_deg") else values
                for key in keys
                for values in [finite_numbers(table[key], key)]
            )
            rates = None if rate is None else rates_inside(rate, travels=travels, lengthens=lengthens)
            return cls(given, outputs, travels=travels, lengthens=lengthens, rates=rates, **words)
        refuse_beside(table, "does not go with function.law; give pairs or a law")
        key = "output_range" if travels else "output_range_deg"
        refuse_missing(stated, *({"output_range", "output_range_deg"} - {key}))
        ranges = [checks.finite_number(stated[name], f"function.{name}") for name in ("input_range_deg", key)]
        over = float(np.radians(ranges[0])), ranges[1] if travels else float(np.radians(ranges[1]))
        if callable(law):
            made = FunctionLaw.of_callable(law, stated["x"], *over, travels=travels)
        else:
            known = None if sampled is None else np.asarray(sampled, dtype=np.float64)
            made = FunctionLaw(law, stated["x"], *over, exponent=exponent, samples=known, travels=travels)
        rates = None if rate is None else rates_inside(rate, travels=travels, lengthens=False)
        return cls.of_law(made, pairs=pairs, rates=rates, **words)

    def __len__(self) -> int:
        return len(self.inputs)

    @property
    def timing(self) -> FloatArray | None:  # type: ignore[override]
        """Driver rotation from the first pair, shape (N,), rad; None where a cylinder's length is stated."""
        return None if self.lengthens else self.inputs

    @property
    def positions(self) -> FloatArray:
        """Free, shape (N, 2)."""
        return np.full((len(self), 2), np.nan)

    @property
    def weights(self) -> FloatArray:
        """Of the squared errors, shape (N,); of a law's own pairs those of the integral over its range."""
        if self.law is None or not self.fits_range:
            return np.ones(len(self))
        return lobatto_with_weights(len(self))[1]

    @property
    def size(self) -> float:
        """The full travel of a slide; of a rotation, whose scale is free, the usual length of the ground."""
        if not self.travels:
            return self.length
        return float(np.ptp(self.outputs) if self.law is None else self.law.output_range)

    @property
    def states_length(self) -> bool:
        """Whether inputs or outputs are lengths."""
        return self.travels or self.lengthens

    @property
    def output_unit(self) -> float:
        """The unit of output errors: 1 rad, or the full travel."""
        return self.size if self.travels else 1.0

    def with_ground(self, length: float) -> FunctionTask:
        """The task with a usual length of the ground; a travel has a size of its own."""
        return self if self.travels or length == self.length else replace(self, length=length)

    def by_turns(self, turned: FloatArray) -> FunctionTask:
        """The same with driver rotations (N,), rad, as inputs, without limits of rates."""
        return replace(self, inputs=turned, lengthens=False, rates=None)

    def exact_for(self, freedoms: int) -> bool:
        """Whether every pair can be met: up to five, since the starts and three lengths are free.

        An inverted slider-crank, whose output is also a rotation, has one free length less. Of six-bars up to
        nine. A cylinder adds three lengths, and so three pairs.
        """
        if self.mirror is not None:
            return False
        if freedoms > _FOUR_BAR:
            return len(self) <= MOST_OF_SIX_BARS
        most = MOST_EXACT if self.travels or freedoms > _SLIDING else MOST_EXACT - 1
        return len(self) <= most + OF_TRIANGLE * self.lengthens

    def impossible(self, word: str) -> str:
        """Why a kind of linkage cannot perform it, in one line; empty if it may.

        Examples
        --------
        >>> FunctionTask([0, 1, 2], [0, 1, 3], link="coupler").impossible("slider-crank")
        'function.link is "coupler"; mechanism must be four-bar or inverted-slider-crank'
        """
        if self.lengthens and word not in ONE_LOOP:
            return (
                f"mechanism is {word}; with function.{INPUT}, a cylinder's length, "
                f"it must be {listing(list(ONE_LOOP))}"
            )
        if self.mirror is not None and word != _MIRRORED:
            return f"function.mirror_deg is stated; mechanism must be {_MIRRORED}"
        if self.link == "output" or word in _OF_COUPLERS:
            return Task.impossible(self, word)
        return f'function.link is "{self.link}"; mechanism must be {listing(_OF_COUPLERS)}'

    def some(self, index: IntArray, positions: FloatArray, angles: FloatArray) -> FunctionTask:  # noqa: ARG002
        """Some of the pairs, from the first of them on."""
        given, output = self.inputs[index], self.outputs[index]
        rates = None
        if self.rates is not None:
            shifted = self.rates - [given[0], 0.0, 0.0]
            within = (shifted[:, 0] >= 0) & (shifted[:, 0] <= given[-1] - given[0])
            rates = shifted[within] if within.any() else None
        mirror = None if self.mirror is None else self.mirror_turn - given[0]
        parts = {"inputs": given - given[0], "outputs": output - output[0], "law": None}
        return replace(self, **parts, rates=rates, mirror=mirror)
