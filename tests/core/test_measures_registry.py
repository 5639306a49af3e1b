"""The registry: every file declares, plug-ins are found and isolated, numbers are written in one way."""

from __future__ import annotations

import importlib.metadata
import math
import pkgutil
import re
from pathlib import Path

import numpy as np
import pytest
from test_measures_looks import pebbles

from tests.core.toy import stock
from texlab_core import measures as package
from texlab_core.engine.plugins import Source
from texlab_core.errors import Cancelled, ParamError
from texlab_core.measures import registry
from texlab_core.measures.registry import Measure, failures, find_measure, measure_all, measures
from texlab_core.measures.subject import Subject

# What the measures are made of; every other file declares some.
GROUND = {"registry", "subject", "limits", "calibrate"}


def declared(**changes: object) -> Measure:
    fields = {
        "id": "test-only",
        "title": "test",
        "summary": "Only here.",
        "low": 0.0,
        "high": 1.0,
        "better": "neither",
        "needs": (),
        "function": lambda subject: 0.5,
    }
    return Measure(**(fields | changes))  # type: ignore[arg-type]


def test_every_file_declares_measures() -> None:
    files = {each.name for each in pkgutil.iter_modules(package.__path__) if not each.name.startswith("_")}
    for name in sorted(files - GROUND):
        text = (Path(package.__path__[0]) / f"{name}.py").read_text(encoding="utf-8")
        assert re.search(r"^register\(", text, re.MULTILINE), f"measures/{name}.py declares no measure"
    broken = [each.sentence for each in failures()]
    assert not broken, " ".join(broken)


@pytest.mark.parametrize("measure", measures().values(), ids=lambda measure: measure.id)
def test_a_declaration_is_whole(measure: Measure) -> None:
    assert re.fullmatch(r"[a-z0-9]+(-[a-z0-9]+)*", measure.id)
    assert 0 < len(measure.title) <= 24
    assert measure.summary.endswith(".")
    assert measure.part_of == "" or find_measure(measure.part_of).part_of == ""
    assert measure.package == "texlab"
    for value in (measure.low, measure.high, 0.0, 1 / 3):
        assert re.search(r"\d", measure.text(value))
        assert measure.text(value).endswith(measure.unit)


def test_titles_are_not_used_twice() -> None:
    titles = [each.title for each in measures().values()]
    assert len(set(titles)) == len(titles)


def test_every_number_lies_in_its_range_and_nothing_is_infinite() -> None:
    flat = np.full((64, 64, 3), 0.25, np.float32)
    for pair in (
        (pebbles(64, 64), pebbles(80, 72, seed=1)),
        (flat, flat),
        (flat, pebbles(64, 64)),
        (flat[:3, :3], flat),
    ):
        for name, value in measure_all(Subject.of_images(*pair)).items():
            assert math.isfinite(value)
            assert find_measure(name).low <= value <= find_measure(name).high


def test_an_image_alone_can_be_asked() -> None:
    found = measure_all(Subject(image=pebbles(64, 64)))
    assert set(found) <= {each.id for each in measures().values() if not each.needs}
    with pytest.raises(LookupError, match="no exemplar"):
        _ = Subject(image=pebbles(8, 8)).pixels


def test_chosen_measures_come_in_the_registrys_order() -> None:
    subject = Subject.of_images(pebbles(64, 64), pebbles(64, 64, seed=1))
    found = measure_all(subject, ["cuts", "visual-difference"])
    assert list(found) == ["visual-difference", "cuts"]
    with pytest.raises(ParamError, match="did you mean cuts"):
        measure_all(subject, ["cut"])
    with pytest.raises(ParamError, match="one of parameters, discriminability"):
        find_measure(3)  # type: ignore[arg-type]


def test_measuring_can_be_stopped_between_the_pieces() -> None:
    asked = 0

    def stop() -> bool:
        nonlocal asked
        asked += 1
        return asked > 5

    with pytest.raises(Cancelled):
        measure_all(Subject.of_images(pebbles(64, 64), pebbles(64, 64, seed=1), should_stop=stop))
    assert asked == 6


def test_a_value_outside_of_the_range_is_brought_in_and_nan_is_none() -> None:
    subject = Subject(image=pebbles(8, 8))
    assert declared(function=lambda subject: 1.0000001).of(subject) == 1
    assert declared(function=lambda subject: math.nan).of(subject) is None
    assert declared(function=lambda subject: None).of(subject) is None


def test_numbers_are_written_with_their_unit_and_without_minus_zero() -> None:
    assert declared(form=".0%").text(0.876) == "88%"
    assert declared(form=".1f", unit="dB").text(3.14159) == "3.1 dB"
    assert declared(form=".1f").text(-0.01) == "0.0"
    assert declared(form=".1f").text(-0.2) == "-0.2"


def test_a_declaration_needs_a_function_or_a_method_that_says_it() -> None:
    with pytest.raises(ValueError, match="either a function or the need 'method'"):
        declared(function=None)
    with pytest.raises(ValueError, match="range must not be empty"):
        declared(low=1.0)
    said = declared(function=None, needs=("method",))
    assert said.of(Subject(image=pebbles(8, 8), given={"test-only": 0.25})) == 0.25
    assert said.of(Subject(image=pebbles(8, 8))) is None


def test_the_same_id_twice_is_refused() -> None:
    with pytest.raises(RuntimeError, match="registered already"):
        registry.register(find_measure("cuts"))


class Installed:
    """An entry point of a package."""

    def __init__(self, module: str, package: str) -> None:
        self.module = module
        self.dist = type("Dist", (), {"name": package})()


def test_measures_of_other_packages_are_found_named_and_isolated(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    declare = (
        "from texlab_core.measures.registry import Measure, register\n"
        "register(Measure(id='{0}', title='{0}', summary='It.', low=0.0, high=1.0, better='neither', needs=(),"
        " function=lambda subject: 0.5))\n"
    )
    (tmp_path / "measures_of_others.py").write_text(declare.format("other-measure"), encoding="utf-8")
    broken = declare.format("half-done") + "raise OSError('no\\nlicence')\n"
    (tmp_path / "measures_that_fail.py").write_text(broken, encoding="utf-8")
    points = [Installed("measures_that_fail", "bad-luck"), Installed("measures_of_others", "good-luck")]
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.setattr(
        importlib.metadata, "entry_points", lambda group: points if group == "texlab_core.measures" else []
    )
    before = measures()
    stock(monkeypatch, registry._MEASURES)
    found = measures()
    assert found["other-measure"].package == "good-luck"
    assert "half-done" not in found
    (failure,) = (each for each in failures() if each.source.package == "bad-luck")
    assert failure.source == Source("bad-luck", "measures_that_fail")
    assert failure.reason == "OSError: no licence"
    assert caplog.messages == [failure.sentence]
    assert set(before) < set(found)
    with pytest.raises(ParamError, match=r"what bad-luck adds could not be loaded\), got 'half-done'"):
        find_measure("half-done")
