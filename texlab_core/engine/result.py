"""A result: an output together with the job that made it."""

from __future__ import annotations

import base64
from dataclasses import dataclass
from html import escape
from typing import TYPE_CHECKING, Any

import numpy as np

from texlab_core.engine.inputs import shorten
from texlab_core.engine.steps import Output

if TYPE_CHECKING:
    from collections.abc import Mapping

    from texlab_core.engine.job import Job


@dataclass(frozen=True, eq=False, kw_only=True, repr=False)
class Result(Output):
    """An output together with the job that made it; a notebook shows it as a picture with its numbers.

    Parameters
    ----------
    job
        Everything that is needed to make the same bits again.
    model
        The analysis that was synthesized from.
    elapsed_s
        Wall time in seconds, analysis (unless cached) and synthesis.
    versions
        Versions of the program and of the libraries that influence the bits.
    """

    job: Job
    model: Any
    elapsed_s: float
    versions: Mapping[str, str]

    def __repr__(self) -> str:
        """Return one short line, whatever the size of the arrays."""
        made = "a result" if self.job is None else self.job.brief
        return f"<Result: {made}, in {self.elapsed_s:.2f} s>"

    def _repr_png_(self) -> bytes | None:
        """Return the picture as a PNG of 8 bits; None for a volume."""
        import imagecodecs

        if self.image.ndim != 3:
            return None
        values = np.rint(self.image.clip(0, 1).astype(np.float64) * 255).astype(np.uint8)
        plane = values[..., 0] if values.shape[2] == 1 else values
        return bytes(imagecodecs.png_encode(np.ascontiguousarray(plane)))

    def _repr_html_(self) -> str:
        """Return the picture, the parameters and the measures; it needs nothing from elsewhere."""
        png = self._repr_png_()
        picture = ""
        if png is not None:
            height, width = self.image.shape[:2]
            data = base64.b64encode(png).decode()
            picture = f'<img width="{width}" height="{height}" alt="result" src="data:image/png;base64,{data}">'
        measures = {name: f"{value:.4g}" for name, value in self.measures.items()}
        parameters = {} if self.job is None else self.job.params.to_json()
        tables = _table("Parameters", parameters) + _table("Measures", measures)
        notes = "".join(f"<p>{escape(note)}</p>" for note in self.notes)
        style = "display: flex; gap: 1.5em; flex-wrap: wrap; align-items: flex-start"
        return (
            f'<figure><div style="{style}">{picture}{tables}</div>'
            f"<figcaption>{escape(repr(self)[9:-1])}</figcaption>{notes}</figure>"
        )


def _table(title: str, values: Mapping[str, Any]) -> str:
    if not values:
        return ""
    rows = "".join(
        f"<tr><th>{escape(name)}</th><td>{escape(shorten(str(value)))}</td></tr>" for name, value in values.items()
    )
    return f"<table><caption>{title}</caption>{rows}</table>"
