"""The MSG code as a file: exactly 69 numbers, bit for bit, and hostile files refused in one sentence."""

from __future__ import annotations

import copy
import json
import math
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from texlab_core.contract.cases import check_sentence
from texlab_core.images.exemplar import as_exemplar
from texlab_core.methods.spectral.codefile import CodeError, code_from_json, code_to_json, read_code, write_code
from texlab_core.methods.spectral.encoding import encode
from texlab_core.methods.spectral.marginal import Histogram16, encode_histogram, gray_level_distance, quantiles
from texlab_core.work.tasks import finish

if TYPE_CHECKING:
    from pathlib import Path

GRAY = finish(encode(as_exemplar("gallery:stochastic-gravel").pixels))[0]
COLOUR = finish(encode(as_exemplar("gallery:stochastic-bark").pixels))[0]


def numbers(data: Any) -> int:
    if isinstance(data, dict):
        return sum(numbers(value) for key, value in data.items() if key != "version")
    if isinstance(data, list):
        return sum(map(numbers, data))
    return int(isinstance(data, int | float))


def test_there_are_exactly_69_numbers_and_44_for_colours() -> None:
    assert numbers(code_to_json(GRAY)) == GRAY.parameters == 69
    assert numbers(code_to_json(COLOUR)) == COLOUR.parameters == 69 + 32 + 12


@pytest.mark.parametrize("code", [GRAY, COLOUR], ids=["gray", "colour"])
def test_a_file_gives_back_the_same_code(tmp_path: Path, code: Any) -> None:
    path = tmp_path / "x.msg.json"
    write_code(code, path, "gallery:x")
    found = read_code(path)
    assert found.code == code
    assert found.exemplar == "gallery:x"
    assert path.stat().st_size < 2000
    assert read_code(path.read_bytes()).code == code
    assert code_from_json(json.loads(json.dumps(code_to_json(code)))).code == code


def changed(path: str, value: Any) -> dict[str, Any]:
    data = copy.deepcopy(code_to_json(COLOUR))
    *parents, last = path.split(".")
    place: Any = data
    for key in parents:
        place = place[int(key) if key.isdigit() else key]
    if value is KeyError:
        del place[last]
    else:
        place[int(last) if last.isdigit() else last] = value
    return data


@pytest.mark.parametrize(
    ("path", "value", "says"),
    [
        ("format", "texlab-preset", "no MSG code"),
        ("version", 2, "newer"),
        ("version", True, "version"),
        ("version", 0, "version"),
        ("surprise", 1, "surprise"),
        ("energies", KeyError, "energies: is missing"),
        ("energies.0.0", -1, "energies"),
        ("energies.0.0", "1", "energies"),
        ("energies.0.0", True, "energies"),
        ("energies.0.0", 10**400, "energies"),
        ("energies.0.0", math.nan, "energies"),
        ("energies.0", [1, 2, 3], "a list of 4"),
        ("energies", [[1] * 4] * 5, "a list of 4"),
        ("bandwidths_u.3.3", 0, "bandwidths_u"),
        ("bandwidths_v.1.2", 1.5, "bandwidths_v"),
        ("bandwidth_measure", "mine", "participation, paper"),
        ("residual.mean", 300, "residual.mean"),
        ("residual.tilt", 1, "residual key"),
        ("residual.rising", KeyError, "residual key rising"),
        ("residual", [1], "residual"),
        ("histogram.kind", "full", "histogram.kind"),
        ("histogram.values", [0] * 16, "above 0"),
        ("histogram.values", [1] * 15, "a list of 16"),
        ("colours.mean.0", -3, "colours.mean"),
        ("colours.axes.0", [1, 1, 0], "colours.axes"),
        ("colours.axes.0", [1, 0, 0], "orthogonal"),
        ("colours.curves", [[0] * 16], "a list of 2"),
        ("colours.curves.0.0", 1e9, "colours.curves"),
        ("exemplar", "x" * 1000, "exemplar"),
        ("exemplar", "a\nb", "exemplar"),
    ],
)
def test_what_does_not_fit_is_refused_in_one_sentence(path: str, value: Any, says: str) -> None:
    with pytest.raises(CodeError) as caught:
        code_from_json(changed(path, value), what="the code x.msg.json")
    assert says in str(caught.value)
    assert str(caught.value).startswith("The code x.msg.json")
    check_sentence(str(caught.value), "the refusal")
    assert len(str(caught.value)) < 400


@pytest.mark.parametrize(
    "text", [b"", b"[]", b"null", b"{", b"[" * 500, b'{"a": NaN}', b"\xff\xfe", b'{"a":1,"a":2}', b" " * 2**21]
)
def test_what_is_no_code_at_all_is_refused(tmp_path: Path, text: bytes) -> None:
    path = tmp_path / "bad.msg.json"
    path.write_bytes(text)
    with pytest.raises(CodeError) as caught:
        read_code(path)
    check_sentence(str(caught.value), "the refusal")
    with pytest.raises(CodeError):
        read_code(tmp_path / "missing.msg.json")


def test_the_low_passed_histogram_keeps_its_end_samples_and_its_mass() -> None:
    levels = np.arange(256)
    masses = np.exp(-(((levels - 120) / 40) ** 2))
    masses[0], masses[255] = 0.2, 0.1
    masses /= masses.sum()
    coded = encode_histogram(masses)
    if coded.kind == "samples":
        assert coded.values[0] == pytest.approx(masses[0], rel=1e-6)
        assert coded.values[15] == pytest.approx(masses[255], rel=1e-6)
    smooth = np.exp(-(((levels - 120) / 40) ** 2))
    smooth /= smooth.sum()
    coded = encode_histogram(smooth)
    assert coded.kind == "samples"
    assert gray_level_distance(coded.masses(), smooth) < 1.5
    assert sum(coded.values) * 17 == pytest.approx(1, abs=0.01)


def test_spikes_at_the_ends_fall_back_to_block_masses() -> None:
    masses = np.full(256, 0.4 / 254)
    masses[0] = masses[255] = 0.3
    coded = encode_histogram(masses)
    assert coded.kind == "blocks"
    assert sum(coded.values) == pytest.approx(1)
    assert coded.values[0] == pytest.approx(0.3 + 15 * 0.4 / 254)


def test_quantiles_are_gray_levels_with_half_a_level_to_each_side() -> None:
    masses = np.zeros(256)
    masses[100], masses[200] = 0.25, 0.75
    np.testing.assert_allclose(quantiles(masses, np.array([0.125, 0.625])), [100, 200])
    np.testing.assert_allclose(quantiles(masses, np.array([0.2499999, 0.2500001])), [100.5, 199.5], atol=1e-4)
    assert Histogram16("blocks", (1.0,) + (0.0,) * 15).masses()[:16].sum() == pytest.approx(1)
