"""Animations of a growth, of the stages of a run, and of a drag of a knob."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Literal

import numpy as np

from texlab_core.documents.beside import write_with_recipe
from texlab_core.documents.reading import KEY
from texlab_core.documents.recipe import written_recipe
from texlab_core.engine.registry import find_method
from texlab_core.engine.run import run
from texlab_core.errors import Cancelled, InputError, ParamError
from texlab_core.files.whole import check_target, write_together, write_whole
from texlab_core.images.formats.movies import MOVIES, check_movie, encode_movie
from texlab_core.images.formats.writing import encode_png
from texlab_core.sheets.contact_sheet import picture_bytes
from texlab_core.sheets.sweep import Sweep, Vary
from texlab_core.sheets.sweep_running import run_sweep

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray

    from texlab_core.engine.job import Job
    from texlab_core.engine.result import Result
    from texlab_core.engine.steps import Step

MOST_FRAMES = 720
# Of all frames together, which are held until the last one is there.
_MOST_BYTES = 2**31
Frames = list["NDArray[np.uint8]"]


@dataclass(frozen=True)
class Animation:
    """What an animation shows, and how fast.

    Parameters
    ----------
    of
        ``growth``: a run from its start to its end, in frames that are even in its progress; ``iterations``: the
        stages that the method names, one frame each, and the result; or a knob (or the seed) as it is dragged over
        values, one frame each.
    frames
        Of a growth, 2 to 720; a run with fewer steps shows some of them longer.
    rate
        Frames a second, 0.2 to 50.
    there_and_back
        Whether a dragged knob goes back by the same values, so that the loop has no jump.

    Raises
    ------
    ParamError
        When the number of frames is out of range.
    """

    of: Literal["growth", "iterations"] | Vary = "growth"
    frames: int = 60
    rate: float = 12.0
    there_and_back: bool = False

    def __post_init__(self) -> None:
        if isinstance(self.frames, bool) or not 2 <= self.frames <= MOST_FRAMES:
            raise ParamError("frames", f"a whole number from 2 to {MOST_FRAMES}", self.frames)


def animation_of(text: str, job: Job, *, frames: int = 60, rate: float = 12.0, back: bool = False) -> Animation:
    """Read ``growth``, ``iterations`` or ``NAME=FROM:TO:COUNT``; raises ``ParamError`` for anything else."""
    if text in ("growth", "iterations"):
        return Animation(text, frames, rate, back)  # type: ignore[arg-type]  # one of the two
    if "=" not in text:
        raise ParamError("animate", "growth, iterations or NAME=FROM:TO:COUNT", text)
    return Animation(Vary.parse(text, find_method(job.method).params), frames, rate, back)


def is_sequence(path: str | os.PathLike[str]) -> bool:
    """Return whether a path asks for a folder of PNG files."""
    text = os.fspath(path)
    if text.endswith(("/", os.sep)) or not Path(path).suffix:
        return True
    return Path(path).suffix.lower() not in MOVIES and Path(path).is_dir()


def check_animation_target(path: str | os.PathLike[str], animation: Animation) -> Path:
    """Return where the animation goes.

    Raises
    ------
    InputError
        When its format is unknown, the rate cannot be kept, or the file or folder cannot be written.
    """
    if not is_sequence(path):
        check_movie(path, animation.rate)
        return check_target(path)
    folder = Path(path)
    if not os.fspath(path):
        raise InputError("The name of the file to write is empty.")
    if folder.exists() and not folder.is_dir():
        raise InputError(f"{folder} is a file, and a folder for the frames is wanted.")
    if not folder.parent.is_dir():
        raise InputError(f"The folder {folder.parent} does not exist.")
    return folder


def draw_frames(
    job: Job,
    animation: Animation,
    *,
    on_progress: Callable[[float], None] | None = None,
    should_stop: Callable[[], bool] | None = None,
) -> tuple[Frames, Result]:
    """Run what is needed and return the frames, (H, W, 3) uint8 of one size each, with the last result.

    Raises
    ------
    InputError
        When the job fails, a value of the knob does, or the frames are too large to be held together.
    Cancelled
        When ``should_stop`` said so.
    """
    if isinstance(animation.of, Vary):
        return _dragged(job, animation.of, animation.there_and_back, on_progress, should_stop)
    height, width = job.picture_size
    if animation.of == "growth":
        _check_room(animation.frames, height, width)
    watch = _Growth(animation.frames) if animation.of == "growth" else _Stages(height, width)

    def on_step(step: Step) -> None:
        watch.see(step)
        if on_progress is not None and step.phase == "synthesis":
            on_progress(0.9 * step.fraction)

    result = run(job, on_step, should_stop)
    last = _picture(result.image)
    frames = watch.finish(last)
    # Previews of coarse stages may be smaller than the result.
    return [_as_large(each, last.shape[:2]) for each in frames], result


class _Growth:
    """Takes a picture whenever the run has gone on by another part of its whole."""

    def __init__(self, count: int) -> None:
        self._count = count
        self._frames: Frames = []

    def see(self, step: Step) -> None:
        if step.phase != "synthesis" or step.preview is None:
            return
        # Frame k of n stands for the share k / (n - 1); the last is the result itself.
        due = min(int(step.fraction * (self._count - 1)) + 1, self._count - 1)
        if due > len(self._frames):
            shown = _picture(step.preview())
            self._frames += [shown] * (due - len(self._frames))

    def finish(self, last: NDArray[np.uint8]) -> Frames:
        shown = self._frames or [last]
        return [*self._frames, *[shown[-1]] * (self._count - 1 - len(self._frames)), last]


class _Stages:
    """Takes a picture of every stage that the method names."""

    def __init__(self, height: int, width: int) -> None:
        self._side = (height, width)
        self._frames: Frames = []

    def see(self, step: Step) -> None:
        if step.frame is not None and step.preview is not None:
            _check_room(len(self._frames) + 2, *self._side)
            self._frames.append(_picture(step.preview()))

    def finish(self, last: NDArray[np.uint8]) -> Frames:
        return [*self._frames, last]


def _dragged(
    job: Job,
    knob: Vary,
    back: bool,
    on_progress: Callable[[float], None] | None,
    should_stop: Callable[[], bool] | None,
) -> tuple[Frames, Result]:
    sweep = Sweep(job, (knob,))
    _check_room(len(sweep.jobs) * (2 if back else 1), *job.picture_size)
    cells = run_sweep(sweep, should_stop=should_stop, on_progress=on_progress)
    frames: Frames = []
    for cell in cells:
        if cell.result is None:
            raise InputError(f"{cell.setting}: {cell.error}")
        frames.append(_picture(cell.result.image))
    last = cells[-1].result
    assert last is not None
    return (frames + frames[-2:0:-1] if back else frames), last


def _check_room(count: int, height: int, width: int) -> None:
    if count > MOST_FRAMES:
        raise InputError(f"An animation has at most {MOST_FRAMES} frames, got {count}.")
    if 3 * count * height * width > _MOST_BYTES:
        raise InputError(
            f"{count} frames of {width} x {height} pixels would take more than {_MOST_BYTES // 2**30} GB; ask for "
            "fewer frames or a smaller size."
        )


def _picture(image: NDArray[np.float32]) -> NDArray[np.uint8]:
    shown = picture_bytes(image)
    return shown if shown.shape[2] == 3 else np.repeat(shown, 3, axis=2)


def _as_large(frame: NDArray[np.uint8], size: tuple[int, int]) -> NDArray[np.uint8]:
    if frame.shape[:2] == size:
        return frame
    rows = np.arange(size[0]) * frame.shape[0] // size[0]
    columns = np.arange(size[1]) * frame.shape[1] // size[1]
    enlarged: NDArray[np.uint8] = frame[rows[:, None], columns]
    return enlarged


def write_animation(
    path: str | os.PathLike[str],
    frames: Sequence[NDArray[np.uint8]],
    result: Result | None,
    *,
    rate: float = 12.0,
    should_stop: Callable[[], bool] | None = None,
) -> tuple[Path, ...]:
    """Write an animation, or a sequence of PNG files as one set.

    Parameters
    ----------
    path
        Ends in .webp, .gif, .apng, .png or .mp4; otherwise a folder, which is made if need be.
    frames
        (H, W, 3) uint8 of one size each.
    result
        Whose recipe goes with it: inside an APNG and the last file of a sequence, else beside; None for none.
    rate
        Frames a second, 0.2 to 50.
    should_stop
        Asked before each frame.

    Returns
    -------
    tuple of Path
        What was written.

    Raises
    ------
    InputError
        When it cannot be written.
    Cancelled
        When ``should_stop`` said so; nothing is written then.
    """

    def look() -> None:
        if should_stop is not None and should_stop():
            raise Cancelled

    recipe = None if result is None else written_recipe(result)
    text = None if recipe is None else {KEY: recipe}
    target = Path(path)
    if is_sequence(target):
        return _write_sequence(target, frames, text, look)
    if target.suffix.lower() in (".png", ".apng"):
        write_whole(target, encode_movie(target, frames, rate=rate, text=text, look=look))
        return (target,)
    data = encode_movie(target, frames, rate=rate, look=look)
    if recipe is None:
        write_whole(target, data)
    else:
        write_with_recipe(target, data, recipe)
    return (target,)


def _write_sequence(
    folder: Path, frames: Sequence[NDArray[np.uint8]], text: dict[str, str] | None, look: Callable[[], None]
) -> tuple[Path, ...]:
    digits = max(4, len(str(len(frames))))
    files: dict[Path, bytes] = {}
    for number, frame in enumerate(frames, 1):
        look()
        last = number == len(frames)
        files[folder / f"frame-{number:0{digits}}.png"] = encode_png(frame, text if last else None)
    made = not folder.exists()
    try:
        folder.mkdir(exist_ok=True)
        write_together(files)
    except OSError as error:
        raise InputError(f"The folder {folder} cannot be made ({error.strerror}).") from error
    except InputError:
        if made:
            folder.rmdir()
        raise
    return tuple(files)
