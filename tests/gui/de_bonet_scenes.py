"""Finished De Bonet columns for tests of the docks that look into them."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import numpy as np
from dock_scenes import image_input

from texlab.state.scene import ColumnScene, Probe, Scene
from texlab.style.pictures import to_picture
from texlab_core.engine.job import Job
from texlab_core.engine.run import run
from texlab_core.methods.de_bonet.params import DeBonetParams


def exemplar(channels: int = 3) -> Any:
    """Return a 96 x 80 texture: waves and noise."""
    rows, columns = np.mgrid[:96, :80]
    waves = 0.5 + 0.25 * np.sin(rows / 2.0) + 0.2 * np.cos(columns / 3.0)
    pixels = np.stack([waves, waves[::-1], waves[:, ::-1]][:channels], 2)
    noise = np.random.default_rng(3).normal(0, 0.05, pixels.shape)
    return image_input(np.clip(pixels + noise, 0, 1))


@lru_cache(maxsize=8)
def finished(channels: int = 3, column_id: int = 1, **changes: Any) -> ColumnScene:
    """Return a finished column of 96 x 104 pixels."""
    params = DeBonetParams(**changes)
    inputs = {"exemplar": exemplar(channels)}
    result = run(Job(method="de-bonet", inputs=inputs, params=params, size=(96, 104), seed=4))
    return ColumnScene(
        column_id,
        "de-bonet",
        "De Bonet",
        params,
        status="finished",
        picture=to_picture(result.image),
        image=result.image,
        result=result,
    )


def scene(*columns: ColumnScene, probe: Probe | None = None) -> Scene:
    return Scene(exemplar(), columns, columns[0].id if columns else 0, probe)
