"""The four-bar linkage as a value."""

import numpy as np
import pytest

from grashof.problems import FourBar, ProblemError


def crank_rocker() -> FourBar:
    return FourBar(
        o2=(1, 2), o4=(4, 6), r2=1, r3=4, r4=3, coupler_point=(0.5, -2), assembly=-1, body_angle=0.3
    )


def batch_of(count: int) -> FourBar:
    lengths = 1.0 + np.arange(count)
    o4 = np.stack([lengths, 2 * lengths], axis=-1)
    return FourBar(
        o2=(0, 0), o4=o4, r2=lengths, r3=4.0, r4=lengths + 1, assembly=[(-1) ** n for n in range(count)]
    )


def test_ground_link_from_the_pivots() -> None:
    linkage = crank_rocker()
    assert linkage.r1 == 5.0
    assert linkage.theta1 == pytest.approx(np.arctan2(4, 3), abs=1e-15)
    assert linkage.lengths.tolist() == [5.0, 1.0, 4.0, 3.0]


def test_fields_of_a_batch_share_their_leading_axes() -> None:
    batch = batch_of(3)
    assert batch.shape == (3,)
    assert batch.o2.shape == batch.o4.shape == batch.coupler_point.shape == (3, 2)
    assert batch.r3.tolist() == [4.0, 4.0, 4.0]
    assert batch.lengths.shape == (3, 4)
    np.testing.assert_allclose(batch.r1, np.sqrt(5) * np.array([1, 2, 3]), rtol=1e-15)


def test_indexing_takes_linkages_out() -> None:
    batch = batch_of(4)
    one = batch[2]
    assert one == FourBar(o2=(0, 0), o4=(3, 6), r2=3, r3=4, r4=4, assembly=1)
    assert batch[1:3].r2.tolist() == [2.0, 3.0]
    assert batch[[3, 0]].r2.tolist() == [4.0, 1.0]
    assert batch[np.array([False, True, False, True])].assembly.tolist() == [-1.0, -1.0]
    none = batch[np.zeros(4, dtype=bool)]
    assert (none.shape, none.o4.shape) == ((0,), (0, 2))


def test_indexing_adds_axes() -> None:
    batch = batch_of(3)
    assert batch[:, None].shape == (3, 1)
    assert batch[:, None].o4.shape == (3, 1, 2)
    assert crank_rocker()[None].shape == (1,)
    assert crank_rocker()[None][0] == crank_rocker()
    assert batch[..., 0] == batch[0]


def test_a_batch_of_any_shape_is_a_row_of_linkages() -> None:
    batch = batch_of(6)[np.arange(6).reshape(2, 3)]
    assert batch.flat.r2.tolist() == batch_of(6).r2.tolist()
    assert batch.flat.o4.shape == (6, 2)
    assert crank_rocker().flat[0] == crank_rocker()


def test_a_single_linkage_has_nothing_to_index() -> None:
    with pytest.raises(IndexError):
        crank_rocker()[0]
    with pytest.raises(IndexError):
        batch_of(2)[2]


def test_equality_and_hash_go_by_value() -> None:
    assert crank_rocker() == crank_rocker()
    assert len({crank_rocker(), crank_rocker()}) == 1
    assert crank_rocker() != crank_rocker()[None]
    assert batch_of(3) == batch_of(3)
    assert batch_of(3) != batch_of(4)
    assert crank_rocker() != "crank-rocker"
    for row in FourBar.mechanism.parameters:
        value = getattr(crank_rocker(), row.name)
        other = crank_rocker().changed(**{row.name: -value if row.kind == "sign" else value + 1})
        assert other != crank_rocker(), row.name


def test_equal_linkages_have_equal_hashes_whatever_the_sign_of_zero() -> None:
    positive = FourBar(o2=(0.0, 0), o4=(4, 0), r2=1, r3=4, r4=3, body_angle=0.0)
    negative = FourBar(o2=(-0.0, 0), o4=(4, 0), r2=1, r3=4, r4=3, body_angle=-0.0)
    assert positive == negative
    assert hash(positive) == hash(negative)


def test_a_linkage_stays_as_it_was_made() -> None:
    o2 = np.array([0.0, 0.0])
    linkage = FourBar(o2=o2, o4=(4, 0), r2=1, r3=4, r4=3)
    o2[0] = 99
    assert linkage.o2.tolist() == [0.0, 0.0]
    with pytest.raises(AttributeError):
        linkage.r2 = 5.0  # type: ignore[misc, assignment]


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"r2": 0}, "r2 is 0; it must be greater than zero"),
        ({"r4": [1, -2]}, r"r4 is \[1, -2\]; it must be greater than zero"),
        ({"body_angle": -629}, "body_angle is -629; it must be at most 100 turns"),
        ({"o2": (0, np.inf)}, r"o2 is \(0, inf\); all numbers must be finite"),
        ({"o4": (1, 2, 3)}, r"o4 has shape \(3,\); it must be \(..., 2\)"),
        ({"r2": "long"}, "r2 is 'long'; it must be a number"),
        ({"assembly": 0}, r"assembly is 0; it must be \+1 or -1"),
        ({"r2": [1, 2], "r3": [1, 2, 3]}, "the fields of a batch have shapes .* that do not fit together"),
    ],
)
def test_bad_input_is_refused_by_name(change: dict[str, object], message: str) -> None:
    good: dict[str, object] = {"o2": (0, 0), "o4": (4, 0), "r2": 1, "r3": 4, "r4": 3}
    with pytest.raises(ProblemError, match=rf"^{message}$"):
        FourBar(**(good | change))  # type: ignore[arg-type]


def test_the_text_of_a_linkage_names_its_arguments() -> None:
    assert eval(str(batch_of(3)[1])) == batch_of(3)[1]  # noqa: S307
    assert repr(crank_rocker()).startswith("FourBar(o2=(1.0, 2.0), o4=(4.0, 6.0), r2=1.0, r3=")
    assert "assembly=-1," in repr(crank_rocker())
    assert repr(batch_of(3)) == "<FourBar: batch of shape (3,)>"
