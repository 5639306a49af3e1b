"""The code that the Code tab shows: measured on the exemplar, or given to the column."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from texlab.state.intentions import EditInputs
from texlab_core.engine.inputs import DataInput

if TYPE_CHECKING:
    from texlab.state.scene import ColumnScene
    from texlab_core.engine.steps import FloatImage
    from texlab_core.methods.spectral.choices import BandwidthAxes, BandwidthMeasure
    from texlab_core.methods.spectral.code import MsgCode


@dataclass(frozen=True, eq=False)
class CodeAnswer:
    """What the dock shows.

    Parameters
    ----------
    column_id
        The column.
    code
        What it synthesizes from.
    measured
        What was measured on the exemplar.
    key
        Hash of the code that was given, "" when the exemplar's is used.
    name
        Name of the given code.
    reached
        (16,) rms of the result's channels in per cent of its mean; None while there is no result.
    """

    column_id: int
    code: MsgCode
    measured: MsgCode
    key: str
    name: str
    reached: Any


def encoded(image: FloatImage, measure: BandwidthMeasure, axes: BandwidthAxes = "uv") -> MsgCode:
    """Return the code of an image, (H, W, C) float32."""
    from texlab_core.methods.spectral.encoding import encode
    from texlab_core.work.tasks import finish
    from texlab_core.work.threads import use_workers

    with use_workers(1):
        code, _ = finish(encode(image, measure, axes))
        return code


def given_code(column: ColumnScene) -> DataInput | None:
    """Return the code that a column was given, None when it measures the exemplar's."""
    code = dict(column.inputs).get("code")
    return code if isinstance(code, DataInput) else None


def edit_code(column_id: int, code: DataInput, *, final: bool) -> EditInputs:
    """Return the intention that a column works from a code."""
    return EditInputs(column_id, (("code", code),), "code", final)
