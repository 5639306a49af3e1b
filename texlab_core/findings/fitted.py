"""What ``python -m texlab_core.findings.calibrate LABELS --write`` found; not to be changed by hand."""

from __future__ import annotations

# By rule: weights, limit, precision, recall, labels, of which positive; real pieces, of which alarms.
NUMBERS: dict[str, tuple[tuple[float, ...], float, float, float, int, int, int, int]] = {
    "structure-lost.bands-alone": ((1.0,), -2.6799, 1.0, 0.881, 102, 101, 56, 13),
    "structure-lost": ((1.0,), -2.1574, 0.924, 0.476, 459, 254, 56, 9),
    "dependence-lost.bands-alone": ((1.0,), -2.49, 1.0, 0.703, 102, 101, 56, 11),
    "cuts.de-bonet": ((1.6238, 1.0321, 4.6986, 0.8343), 2.5659, 0.93, 0.811, 204, 148, 56, 27),
    "cuts": ((0.75753, 12.159, 0.77054, 1.6598, 9.3287), 4.4619, 0.916, 0.736, 459, 148, 56, 1),
    "repetition": ((6.7697, -2.1264), 3.8531, 0.798, 0.906, 459, 170, 56, 3),
    "verbatim.de-bonet": ((-1.0,), 0.81729, 0.908, 0.826, 204, 132, 56, 0),
    "verbatim.efros-leung": ((-1.0,), 1.0092, 0.556, 0.303, 153, 33, 56, 0),
    "verbatim": ((-4.2298, 1.9707), 5.7952, 0.912, 0.624, 459, 165, 56, 0),
    "noise.de-bonet": ((4.8629, 1.4647, 1.2077, 0.24264), -15.175, 0.909, 0.723, 204, 83, 56, 51),
    "noise": ((1.0,), -2.5181, 0.556, 0.054, 459, 93, 56, 0),
    "jagged": ((0.95731, 0.5526), -2.3397, 0.357, 0.172, 459, 29, 56, 0),
    "invented-colours.histograms": ((1.0,), -0.67398, 0.759, 0.957, 51, 23, 56, 16),
    "invented-colours": ((1.0,), 2.1929, 0.357, 0.167, 459, 30, 56, 0),
    "blotchy.histograms": ((1.4493, 7.504), -2.523, 0.824, 0.609, 51, 23, 56, 16),
    "garbage.efros-leung": ((2.1877, -2.0085), 4.5411, 0.8, 0.314, 153, 51, 56, 1),
    "smear": ((1.0918, 0.62493, 1.4365), -4.9186, 0.514, 0.224, 357, 85, 56, 7),
    "peaks-moved": ((1.0,), 0.49801, 0.462, 0.182, 459, 33, 56, 0),
    "symmetry": ((1.0,), 0.6055, 0.389, 0.28, 459, 25, 56, 2),
    "letters": ((1.0,), 0.92163, 1.0, 0.529, 459, 34, 56, 2),
    "gradient": ((1.0,), 0.51354, 0.667, 0.444, 459, 27, 56, 2),
}
