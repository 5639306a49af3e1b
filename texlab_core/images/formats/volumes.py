"""Volumes as files: TIFF stacks that ImageJ opens with their axes, and NumPy arrays."""

from __future__ import annotations

import io
import math
import os
from pathlib import Path
from typing import TYPE_CHECKING, Any, BinaryIO

import numpy as np

from texlab_core.engine.sizes import MAX_PIXELS
from texlab_core.errors import ImageError
from texlab_core.files.regular import open_regular
from texlab_core.images.formats.decoded import Decoded
from texlab_core.images.formats.writing import Bits, quantize

if TYPE_CHECKING:
    from numpy.typing import NDArray

VOLUME_SUFFIXES = (".tif", ".tiff", ".npy")
_MAX_BYTES = 3 * 4 * MAX_PIXELS


def check_volume_format(path: str | os.PathLike[str], bits: Bits | None = None) -> str:
    """Return the suffix in lower case.

    Raises
    ------
    ImageError
        When no volume can be written under this name, or not with these bits.
    """
    suffix = Path(path).suffix.lower()
    if not os.fspath(path):
        raise ImageError("The name of the file to write is empty.")
    if suffix not in VOLUME_SUFFIXES:
        raise ImageError(f"{os.fspath(path)}: solids are written as {', '.join(VOLUME_SUFFIXES)}, got {suffix!r}.")
    if suffix == ".npy" and bits not in (None, "float"):
        raise ImageError(f"{os.fspath(path)}: the bits of a .npy file must be float, got {bits!r}.")
    return suffix


def default_volume_bits(path: str | os.PathLike[str], bits: Bits) -> Bits:
    """Return the depth of a volume's samples unless something else is asked for: floats in .npy, else ``bits``."""
    return "float" if check_volume_format(path) == ".npy" else bits


def encode_volume(
    path: str | os.PathLike[str],
    volume: NDArray[np.floating[Any]],
    *,
    bits: Bits | None = None,
    info: str | None = None,
) -> bytes:
    """Return the bytes of a file that holds a volume.

    Parameters
    ----------
    path
        Ends in .tif, .tiff or .npy, which chooses the format.
    volume
        (D, H, W, 1 | 3) floats in [0, 1]. A TIFF has a page for each slice; ImageJ takes them as the z axis, and
        colour as RGB (8 bits) or as three channels (16 bits and floats, which its RGB cannot hold). A .npy file
        holds float32 of this shape.
    bits
        8, 16 or "float" for each sample of a TIFF; None is 8.
    info
        A text that goes with a TIFF (in ImageJ: Image > Show Info).

    Raises
    ------
    ImageError
        When the format is unknown or cannot hold what is asked, or the values are not finite.
    """
    suffix = check_volume_format(path, bits)
    values = np.asarray(volume)
    if values.dtype.kind != "f" or values.ndim != 4 or values.size == 0 or values.shape[3] not in (1, 3):
        raise ImageError(f"{os.fspath(path)}: a solid to write is (D, H, W, 1 or 3) floats, got {values.shape}.")
    if not np.isfinite(values).all():
        raise ImageError(f"{os.fspath(path)}: the solid has values that are not finite, and cannot be written.")
    out = io.BytesIO()
    if suffix == ".npy":
        np.save(out, values.astype(np.float32), allow_pickle=False)
        return out.getvalue()
    _write_stack(out, values, 8 if bits is None else bits, info)
    return out.getvalue()


def _write_stack(out: BinaryIO, values: NDArray[Any], bits: Bits, info: str | None) -> None:
    import tifffile

    pages = values.astype(np.float32) if bits == "float" else quantize(values, 2**bits - 1)
    metadata: dict[str, Any] = {"axes": "ZYX", "spacing": 1.0, "unit": "voxel"}
    if values.shape[3] == 1:
        pages = pages[..., 0]
    elif bits == 8:
        metadata["axes"] = "ZYXS"
    else:
        pages = np.ascontiguousarray(np.moveaxis(pages, 3, 1))
        metadata |= {"axes": "ZCYX", "mode": "composite"}
    if bits == "float" or metadata["axes"] == "ZCYX":
        # Black and white as in the integers, whatever the range of the values.
        metadata |= {"min": 0.0, "max": 1.0 if bits == "float" else float(2**bits - 1)}
    if info is not None:
        metadata["Info"] = info
    tifffile.imwrite(
        out,
        pages,
        imagej=True,
        photometric="rgb" if metadata["axes"] == "ZYXS" else "minisblack",
        metadata=metadata,
    )


def read_volume(path: str | os.PathLike[str]) -> Decoded:
    """Read a volume that :func:`encode_volume` wrote.

    Returns
    -------
    Decoded
        ``values`` is (D, H, W, 1 | 3), ``peak`` what stands for 1.

    Raises
    ------
    ImageError
        When the file is no such volume.
    """
    name = os.fspath(path)
    try:
        with open_regular(path) as file:
            values = _read_npy(file) if Path(path).suffix.lower() == ".npy" else _read_stack(file)
    except OSError as error:
        raise ImageError(f"{name}: cannot be opened ({error.strerror}).") from error
    except Exception as error:
        # tifffile raises all kinds of errors on damaged files.
        raise ImageError(f"{name}: is no solid that TexLab saved.") from error
    return Decoded(values, {"uint8": 255, "uint16": 65535}.get(values.dtype.name))


def volume_of(decoded: Decoded) -> NDArray[np.float32]:
    """Return a volume that was read as float32 in [0, 1]; raises ``ImageError`` for other values."""
    values: NDArray[np.float32] = np.divide(decoded.values, np.float32(decoded.peak or 1), dtype=np.float32)
    if not ((values >= 0) & (values <= 1)).all():
        raise ImageError("A solid has values from 0 to 1; this one has others.")
    return values


def _read_npy(file: BinaryIO) -> NDArray[Any]:
    version = np.lib.format.read_magic(file)
    read = np.lib.format.read_array_header_1_0 if version == (1, 0) else np.lib.format.read_array_header_2_0
    shape, _, dtype = read(file)
    _check_shape(shape, dtype)
    file.seek(0)
    values: NDArray[Any] = np.load(file, allow_pickle=False)
    return values


def _read_stack(file: BinaryIO) -> NDArray[Any]:
    import tifffile

    with tifffile.TiffFile(file, name="solid.tif") as tiff:
        series = tiff.series[0]
        axes = series.axes.replace("I", "Z")
        shape = dict(zip(axes, series.shape, strict=True))
        colour = "S" if "S" in shape else "C"
        wanted = (*(shape.get(axis, 1) for axis in "ZYX"), shape.get(colour, 1))
        if not set(axes) <= set("ZCYXS") or not {"Y", "X"} <= set(axes) or {"C", "S"} <= set(axes):
            raise ValueError(axes)
        _check_shape(wanted, series.dtype)
        values: NDArray[Any] = series.asarray()
    order = [axis for axis in ("Z", "Y", "X", colour) if axis in axes]
    return np.ascontiguousarray(values.transpose([axes.index(axis) for axis in order])).reshape(wanted)


def _check_shape(shape: tuple[int, ...], dtype: np.dtype[Any]) -> None:
    if len(shape) != 4 or shape[3] not in (1, 3) or dtype.name not in ("uint8", "uint16", "float32"):
        raise ValueError(f"{shape} {dtype}")
    if math.prod(shape) * dtype.itemsize > _MAX_BYTES or not math.prod(shape):
        raise ValueError("too large")
