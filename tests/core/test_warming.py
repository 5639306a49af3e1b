"""Loading beforehand."""

from __future__ import annotations

from texlab_core import warming
from texlab_core.registry import methods
from texlab_core.run import run


def test_every_method_is_run_in_gray_and_in_colour(monkeypatch):
    seen = []

    def watched(job, **more):
        seen.append((job.method, job.inputs["exemplar"].channels))
        return run(job, **more)

    monkeypatch.setattr(warming, "run", watched)
    assert warming.warm_up() == tuple(methods())
    assert seen == [(name, channels) for name in methods() for channels in (1, 3)]


def test_it_stops_at_once():
    assert warming.warm_up(lambda: True) == ()
