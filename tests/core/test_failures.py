"""The failure gallery: every example can be made, and shows what it says."""

from __future__ import annotations

import re

import pytest

from texlab_core.engine.registry import methods
from texlab_core.engine.run import run
from texlab_core.errors import ParamError
from texlab_core.findings.diagnosis import findings_of
from texlab_core.findings.failures import Failure, examples, find_example
from texlab_core.findings.registry import find_detector
from texlab_core.images.gallery import gallery

SMALL = (128, 128)
# What sections of the papers name, by method: every one of them has an example.
NAMED = {
    "heeger-bergen": ("wood", "coral", "dots", "hay", "fur", "marble", "inhomogeneous", "even"),
    "de-bonet": ("mirror", "rotational", "size", "colour", "letters", "symbols", "small", "large"),
    "msg": ("structure", "peaks", "letters"),
    "efros-leung": ("garbage", "verbatim", "window"),
}


@pytest.mark.parametrize("example", examples().values(), ids=lambda example: example.name)
def test_an_example_shows_what_it_says(example: Failure) -> None:
    found = {each.id for each in findings_of(run(example.job(SMALL)))}
    assert (example.finding in found) == example.shows, found


@pytest.mark.parametrize("example", examples().values(), ids=lambda example: example.name)
def test_an_example_is_whole(example: Failure) -> None:
    assert re.fullmatch(r"[a-z]+(-[a-z]+)*", example.name)
    assert example.exemplar in {each.name for each in gallery()}
    assert example.method in methods()
    find_detector(example.finding)
    assert example.look.endswith(".")
    assert re.search(r"(19\d\d|Ponce).*\)\.$", example.why)
    assert example.to_json()["exemplar"] == example.source
    defaults = methods()[example.method].params()
    assert all(getattr(defaults, name) != value for name, value in example.params.items())


def test_everything_that_the_papers_name_is_there() -> None:
    for method, words in NAMED.items():
        names = [each.name for each in examples().values() if each.method == method]
        for word in words:
            assert any(word in name for name in names), (method, word)


def test_a_name_that_is_not_there_gets_a_hint() -> None:
    with pytest.raises(ParamError, match="did you mean marble"):
        find_example("marbel")
