"""MSG with radial and angular bandwidths: by the definition over the whole plane, and round trips."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import pytest
from spectral_tools import ANY, FLAT, analyzed, texture, white

from texlab_core.api import synthesize
from texlab_core.engine.streams import Streams
from texlab_core.errors import ParamError
from texlab_core.methods.spectral.analysis import analyze_plane
from texlab_core.methods.spectral.codefile import code_from_json, code_input, code_to_json
from texlab_core.methods.spectral.radial import DIAGONALS
from texlab_core.methods.spectral.synthesis import design_radial, synthesize_plane
from texlab_core.transforms.gabor_bank import CENTRES_U, CENTRES_V, CHANNELS, WHITE_BANDWIDTHS, WIDTHS
from texlab_core.work.tasks import finish

if TYPE_CHECKING:
    from texlab_core.methods.spectral.code import MsgCode

SIZE = (256, 256)


def radial_code(plane: np.ndarray, measure: str = "participation") -> MsgCode:
    return finish(analyze_plane(plane.astype(np.float32), FLAT, measure, ANY, "a", "b", "radial"))


def made(code: MsgCode, size: tuple[int, int], phase: str = "one", seed: int = 0) -> np.ndarray:
    plan = finish(design_radial(code, size))
    return finish(synthesize_plane(code, plan, size, Streams(seed), phase, ANY, ("a", "b", "c")))


def test_upright_channels_have_the_bandwidths_along_the_axes():
    plane = texture((200, 256))
    code, printed = radial_code(plane), analyzed(plane)
    assert code.axes == "radial"
    assert code.energies == printed.energies
    for channel in range(CHANNELS):
        along_u, along_v = printed.bandwidths_u[channel], printed.bandwidths_v[channel]
        if channel % 4 == 0:
            assert (code.bandwidths_u[channel], code.bandwidths_v[channel]) == (along_u, along_v)
        elif channel % 4 == 2:
            assert (code.bandwidths_u[channel], code.bandwidths_v[channel]) == (along_v, along_u)


@pytest.mark.parametrize("measure", ["participation", "paper"])
def test_diagonal_channels_are_measured_along_and_across_their_waves(measure):
    """By the definition: the power of each sample goes to the line through it."""
    plane = texture((128, 128), seed=4)
    code = radial_code(plane, measure)
    power = np.abs(np.fft.fft2(plane - plane.mean(dtype=np.float64))) ** 2
    index = np.fft.fftfreq(128) * 128
    v, u = index[:, None] / 128, index[None, :] / 128
    for channel in DIAGONALS:
        du, dv = u - CENTRES_U[channel], v - CENTRES_V[channel]
        passed = power * np.exp(-2 * np.pi * (du**2 + dv**2) / WIDTHS[channel] ** 2)
        sign = np.sign(CENTRES_U[channel] * CENTRES_V[channel])
        for place, found in (
            (index[None, :] + sign * index[:, None], code.bandwidths_u),
            (index[None, :] - sign * index[:, None], code.bandwidths_v),
        ):
            single = np.bincount((place + 128).astype(int).ravel(), passed.ravel(), 259)
            # Two neighbours are taken together, and the width that this adds to a Gaussian is taken off again.
            lines = single[:-1] + single[1:]
            if measure == "paper":
                width = lines.sum() / lines.max()
            else:
                width = lines.sum() ** 2 / (np.sqrt(2) * (lines**2).sum())
            # The program leaves out what the filter has beyond u = 0, less than 1e-4 of its peak.
            step = 1 / (128 * np.sqrt(2))
            expected = np.sqrt((width * step) ** 2 - np.pi / 2 * step**2)
            assert found[channel] == pytest.approx(expected, rel=2e-3), channel


@pytest.mark.parametrize("size", [SIZE, (256, 320)])
def test_white_noise_has_the_filters_own_bandwidths(size):
    code = radial_code(white(size, 20))
    np.testing.assert_allclose(code.bandwidths_u, WHITE_BANDWIDTHS, rtol=0.03)
    np.testing.assert_allclose(code.bandwidths_v, WHITE_BANDWIDTHS, rtol=0.03)


@pytest.mark.parametrize("phase", ["one", "sixteen"])
def test_a_code_comes_back_from_what_was_made_of_it(phase):
    """Narrow along the waves and wide across them, which bandwidths along u and v cannot tell on a diagonal."""
    wide = radial_code(white(SIZE, 20))
    channel = 9
    energies = [0.0] * CHANNELS
    energies[channel] = 100.0
    narrow, broad = np.array(WHITE_BANDWIDTHS) * 0.25, np.array(WHITE_BANDWIDTHS) * 0.75
    quiet = replace(wide.residual, u_axis=0.0, v_axis=0.0, falling=0.0, rising=0.0)
    code = replace(
        wide, energies=tuple(energies), bandwidths_u=tuple(narrow), bandwidths_v=tuple(broad), residual=quiet
    )
    back = radial_code(made(code, SIZE, phase))
    reached = finish(design_radial(code, SIZE)).achieved[channel]
    assert back.energies[channel] == pytest.approx(reached, rel=0.02 if phase == "one" else 0.1)
    assert back.bandwidths_u[channel] == pytest.approx(narrow[channel], rel=0.1)
    assert back.bandwidths_v[channel] == pytest.approx(broad[channel], rel=0.1)
    uv = analyzed(made(code, SIZE, phase))
    assert uv.bandwidths_u[channel] == pytest.approx(uv.bandwidths_v[channel], rel=0.1)


def test_energies_are_met_and_the_same_noise_gives_the_same_bits():
    code = radial_code(texture(SIZE))
    plan = finish(design_radial(code, SIZE))
    plane = made(code, SIZE)
    np.testing.assert_allclose(radial_code(plane).energies, plan.achieved, rtol=0.02, atol=1e-3)
    np.testing.assert_array_equal(plane, made(code, SIZE))
    assert not np.array_equal(plane, made(code, SIZE, seed=1))


def test_a_large_output_is_designed_on_a_grid_that_is_fine_enough():
    code = radial_code(white(SIZE, 20))
    small, large = (finish(design_radial(code, (side, side))) for side in (512, 1024))
    np.testing.assert_allclose(small.energies, large.energies, rtol=0.05)


def test_the_method_takes_it_as_an_option_and_codes_carry_it():
    exemplar = "gallery:oriented-sandripples"
    one, other = (synthesize(exemplar, "msg", size=(96, 96), bandwidth_axes=axes) for axes in ("uv", "radial"))
    assert one.model.code.axes == "uv"
    assert "bandwidth_axes" not in code_to_json(one.model.code)
    data = code_to_json(other.model.code)
    assert data["bandwidth_axes"] == "radial"
    assert code_from_json(data).code == other.model.code
    again = synthesize(exemplar, "msg", size=(96, 96), inputs={"code": code_input(other.model.code)})
    np.testing.assert_array_equal(again.image, other.image)
    assert not np.array_equal(one.image, other.image)


@pytest.mark.parametrize("given", ["parameter", "code"])
def test_printed_equations_need_the_printed_axes(given):
    exemplar = np.random.default_rng(0).random((48, 48)).astype(np.float32)
    if given == "parameter":
        values = {"bandwidth_axes": "radial"}
    else:
        values = {"inputs": {"code": code_input(synthesize(exemplar, "msg", bandwidth_axes="radial").model.code)}}
    with pytest.raises(ParamError, match="equations: must be corrected where bandwidths are radial"):
        synthesize(exemplar, "msg", equations="printed", **values)
