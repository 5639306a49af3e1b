"""The public names, and synthesis in one line."""

from __future__ import annotations

import subprocess
import sys
from itertools import count
from typing import TYPE_CHECKING

import numpy as np
import pytest

import texlab_core
from tests.core.toy import NoiseParams, noise_method, stock
from texlab_core.engine import registry
from texlab_core.engine.inputs import DataInput
from texlab_core.engine.job import Job
from texlab_core.engine.registry import EXEMPLAR, InputSpec
from texlab_core.engine.run import run
from texlab_core.errors import Cancelled, ImageError, InputError, ParamError

if TYPE_CHECKING:
    from pathlib import Path

    from texlab_core.engine.steps import Step

IMAGE = np.linspace(0, 1, 8 * 9, dtype=np.float32).reshape(8, 9)


@pytest.fixture(autouse=True)
def toy(monkeypatch: pytest.MonkeyPatch) -> None:
    code = InputSpec("code", "Some numbers.", kind="data", required=False)
    pair = noise_method(id="toy-pair", inputs=(EXEMPLAR, code))
    stock(monkeypatch, registry._METHODS, noise_method(), pair)


def test_one_line_equals_a_job() -> None:
    result = texlab_core.synthesize(IMAGE, "toy-noise", size=(5, 6), seed=3, rounds=2)
    job = Job(
        method="toy-noise",
        inputs={"exemplar": texlab_core.as_exemplar(IMAGE)},
        params=NoiseParams(rounds=2),
        size=(5, 6),
        seed=3,
    )
    np.testing.assert_array_equal(result.image, run(job).image)
    assert result.image.shape == (5, 6, 1)


def test_an_exemplar_a_name_and_an_array_are_the_same_image() -> None:
    exemplar = texlab_core.as_exemplar("gallery:structured-pebbles")
    one = texlab_core.synthesize(exemplar, "toy-noise", size=(4, 4))
    other = texlab_core.synthesize("gallery:structured-pebbles", "toy-noise", size=(4, 4))
    np.testing.assert_array_equal(one.image, other.image)
    assert texlab_core.synthesize(exemplar.pixels, "toy-noise").job.size == exemplar.size


def test_steps_and_cancel() -> None:
    steps: list[Step] = []
    texlab_core.synthesize(IMAGE, "toy-noise", on_step=steps.append)
    assert len(steps) == 5
    asked = count()
    with pytest.raises(Cancelled):
        texlab_core.synthesize(IMAGE, "toy-noise", should_stop=lambda: next(asked) == 3)


def test_further_inputs() -> None:
    code = DataInput([1], "code")
    assert texlab_core.synthesize(IMAGE, "toy-pair", inputs={"code": code}).job.inputs["code"] is code


def test_further_inputs_come_in_the_forms_that_exemplars_have(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    specs = (
        EXEMPLAR,
        InputSpec("other", "An image.", required=False),
        InputSpec("mask", "Where.", required=False, background=0.0),
        InputSpec("state", "Arrays.", kind="arrays", required=False),
        InputSpec("code", "Some numbers.", kind="data", required=False),
    )
    stock(monkeypatch, registry._METHODS, noise_method(), noise_method(id="toy-many", inputs=specs))
    clear = np.zeros((8, 9, 4), np.uint8)
    path = tmp_path / "code.json"
    path.write_text("[1, 2]")
    np.savez(tmp_path / "state.npz", a=np.arange(3))
    given = {"other": "gallery:stochastic-granite", "mask": clear, "state": {"a": np.arange(3)}, "code": [1, 2]}
    made = texlab_core.synthesize(IMAGE, "toy-many", inputs=given).job.inputs
    assert made["other"].sha256 == texlab_core.as_exemplar("gallery:stochastic-granite").sha256
    # What is transparent is outside of a mask.
    assert made["mask"].pixels.max() == 0  # type: ignore[union-attr]
    files = {"other": IMAGE, "mask": IMAGE, "state": tmp_path / "state.npz", "code": str(path)}
    (series, compared) = (
        texlab_core.sweep(IMAGE, "toy-many", vary={"seed": [1]}, inputs=files),
        texlab_core.compare(IMAGE, ["toy-noise", "toy-many"], inputs=files),
    )
    for job in (series[0].job, compared[1].job):
        assert job.inputs["state"].sha256 == made["state"].sha256
        assert job.inputs["code"].sha256 == made["code"].sha256
        assert job.inputs["other"].sha256 == texlab_core.as_exemplar(IMAGE).sha256
    assert set(compared[0].job.inputs) == {"exemplar"}
    with pytest.raises(ImageError, match=r"^gone\.png: there is no such file"):
        texlab_core.synthesize(IMAGE, "toy-many", inputs={"other": "gone.png"})
    with pytest.raises(InputError, match=r"^state: must be an input of kind arrays, got list\.$"):
        texlab_core.synthesize(IMAGE, "toy-many", inputs={"state": [1]})
    with pytest.raises(ParamError, match="input: must be one of exemplar, other, mask, state, code"):
        texlab_core.synthesize(IMAGE, "toy-many", inputs={"more": IMAGE})


def test_what_does_not_fit_is_refused() -> None:
    with pytest.raises(ParamError, match="did you mean rounds"):
        texlab_core.synthesize(IMAGE, "toy-noise", round=2)
    with pytest.raises(ParamError, match="did you mean toy-noise"):
        texlab_core.synthesize(IMAGE, "toy-nois")
    with pytest.raises(ImageError):
        texlab_core.synthesize(IMAGE[:0], "toy-noise")


def test_every_public_name_is_there() -> None:
    for name in texlab_core.__all__:
        assert getattr(texlab_core, name).__name__ == name
        assert getattr(texlab_core, name).__doc__
    assert set(texlab_core.__all__) <= set(dir(texlab_core))
    assert dict(texlab_core.available_methods()) == dict(registry.methods())
    with pytest.raises(AttributeError, match="no attribute 'nothing'"):
        _ = texlab_core.nothing


def test_the_package_imports_nothing_until_a_name_is_used() -> None:
    code = (
        "import sys, texlab_core\n"
        "assert 'numpy' not in sys.modules\n"
        "from texlab_core import Knob\n"
        "assert 'numpy' not in sys.modules\n"
        "from texlab_core import synthesize, as_exemplar, save_result\n"
        "heavy = [name for name in ('scipy', 'numba', 'cv2', 'PIL', 'PySide6', 'rich') if name in sys.modules]\n"
        "assert heavy == [], heavy"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.stderr == ""
