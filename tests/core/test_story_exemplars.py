"""The exemplars of the stories: stored as they are drawn, and what the stories need of them holds."""

from __future__ import annotations

import numpy as np
import pytest

from texlab_core.figures import _exemplars
from texlab_core.images.exemplar import as_exemplar
from texlab_core.images.gallery import find_entry
from texlab_core.stats.local_frequency import local_frequency
from texlab_core.transforms.luma import luma


@pytest.mark.parametrize("name", _exemplars.EXEMPLARS)
def test_they_are_stored_as_they_are_drawn(name):
    drawn = _exemplars.EXEMPLARS[name]()
    assert drawn.shape[:2] == (256, 256)
    stored = as_exemplar(f"gallery:{name}").pixels
    # Another version of the drawing library may round edges otherwise.
    assert np.abs(drawn.astype(np.float32) / 255 - stored).mean() < 0.01
    entry = find_entry(name)
    assert (entry.licence, entry.author) == ("CC0-1.0", "generated for this project")
    assert entry.keywords


def test_a_page_has_fourteen_lines():
    page = luma(as_exemplar("gallery:letters-page").pixels)
    spectrum = np.abs(np.fft.rfft(page.mean(axis=1) - page.mean()))
    assert int(spectrum[2:40].argmax()) + 2 == _exemplars.LINES


def test_the_pair_differs_in_homogeneity_alone():
    even, uneven = (
        luma(as_exemplar(f"gallery:{name}").pixels) for name in ("structured-seeds", "inhomogeneous-seedgradient")
    )
    sizes = []
    for plane in (even, uneven):
        found = local_frequency(plane).wavelength
        sizes.append([float(np.median(part)) for part in (found[:96, :96], found[-96:, -96:])])
    assert sizes[0][1] == pytest.approx(sizes[0][0], rel=0.25)
    assert sizes[1][1] > 1.4 * sizes[1][0]
    assert abs(even.mean() - uneven.mean()) < 0.06


def test_the_command_draws_into_a_folder(tmp_path, capsys):
    assert _exemplars.main([]) == 2
    assert "usage" in capsys.readouterr().err
