"""One run of a column, without its worker: what it measures at its end, and that it can be stopped there."""

import numpy as np
import pytest

from texlab.runs.column_run import ColumnRun, spectral_distances
from texlab_core.engine.cache import AnalysisCache
from texlab_core.engine.job import Job
from texlab_core.engine.run import run
from texlab_core.errors import Cancelled
from texlab_core.images.exemplar import as_exemplar
from texlab_core.stats.spectrum import log_spectral_distance, power_spectrum, total_variation


def job():
    pixels = np.random.default_rng(1).random((24, 20, 3), np.float32)
    return Job(method="tiling", inputs={"exemplar": as_exemplar(pixels)}, size=(30, 32), seed=1)


class Task:
    """A worker that asks for a stop at its ``stop_at``-th question."""

    def __init__(self, stop_at=0):
        self.stop_at, self.asked = stop_at, 0

    def should_stop(self):
        self.asked += 1
        return self.asked == self.stop_at

    def due(self):
        return False

    def progress(self, value):
        raise AssertionError

    def give_way(self):
        return 0.0


def test_distances_are_those_of_the_spectra():
    result = run(job())
    spectra = [power_spectrum(each) for each in (result.job.inputs["exemplar"].pixels, result.image)]
    assert spectral_distances(result, lambda: False) == {
        "spectral-distance": log_spectral_distance(*spectra),
        "spectral-variation": total_variation(*spectra),
    }


def test_a_run_can_be_stopped_at_every_question_also_after_its_last_step():
    steps = Task()
    run(job(), should_stop=steps.should_stop)
    whole = Task()
    finished = ColumnRun(job, AnalysisCache())(whole)
    assert finished.metrics["spectral-distance"] > 0
    # Two spectra in several parts each, and two distances.
    assert whole.asked >= steps.asked + 2 * 3 + 2
    for stop_at in range(1, whole.asked + 1):
        task = Task(stop_at)
        with pytest.raises(Cancelled):
            ColumnRun(job, AnalysisCache())(task)
        assert task.asked == stop_at
