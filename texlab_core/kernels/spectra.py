"""Half spectra of many slices, filtered with a real response: cropped, and added up again.

A crop keeps the lowest frequencies: the first rows of either sign, and the first columns. ``quarters`` is how
often the filtered spectrum is multiplied by i besides.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from texlab_core.kernels.jit import njit

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


@njit
def crop(
    spectra: NDArray[np.complex64], response: NDArray[np.float32], quarters: int, out: NDArray[np.complex64]
) -> None:
    """Set ``out``, (N, h, w), to the filtered lowest frequencies of ``spectra``, (N, H, W)."""
    many, rows, columns = out.shape
    above, shift = (rows + 1) // 2, spectra.shape[1] - rows
    odd = quarters % 2
    # i is (0, 1), -1 is (-1, 0), -i is (0, -1).
    real = response.dtype.type(1 if quarters % 4 in (0, 3) else -1)
    imag = response.dtype.type(1 if quarters % 4 in (0, 1) else -1)
    for number in range(many):
        for row in range(rows):
            there = spectra[number, row if row < above else row + shift]
            here, weights = out[number, row], response[row]
            if odd:
                for column in range(columns):
                    value, weight = there[column], weights[column]
                    here[column] = complex(real * (value.imag * weight), imag * (value.real * weight))
            else:
                for column in range(columns):
                    value, weight = there[column], weights[column]
                    here[column] = complex(real * (value.real * weight), imag * (value.imag * weight))


@njit
def add(
    parts: NDArray[np.complex64], response: NDArray[np.float32], quarters: int, total: NDArray[np.complex64]
) -> None:
    """Add the filtered ``parts``, (N, h, w), to the lowest frequencies of ``total``, (N, H, W)."""
    many, rows, columns = parts.shape
    above, shift = (rows + 1) // 2, total.shape[1] - rows
    odd = quarters % 2
    real = response.dtype.type(1 if quarters % 4 in (0, 3) else -1)
    imag = response.dtype.type(1 if quarters % 4 in (0, 1) else -1)
    for number in range(many):
        for row in range(rows):
            there = total[number, row if row < above else row + shift]
            here, weights = parts[number, row], response[row]
            if odd:
                for column in range(columns):
                    value, weight = here[column], weights[column]
                    there[column] += complex(real * (value.imag * weight), imag * (value.real * weight))
            else:
                for column in range(columns):
                    value, weight = here[column], weights[column]
                    there[column] += complex(real * (value.real * weight), imag * (value.imag * weight))
