#!/usr/bin/env python3
"""A Campbell diagram by the Python module and Matplotlib: damped whirl frequencies over the speed.

    PYTHONPATH=build/release/python python3 examples/campbell.py [DECK] [PICTURE] [TOP SPEED in rpm]

The module is built by `cmake --preset release -DWHIRL_PYTHON=ON && cmake --build --preset release` (docs/python.md).
"""
import pathlib
import sys
import tomllib

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from scipy.optimize import linear_sum_assignment

import whirl

here = pathlib.Path(__file__).resolve().parent
deck_file = sys.argv[1] if len(sys.argv) > 1 else here / "05_campbell_nelson_mcvaugh" / "deck.toml"
picture = sys.argv[2] if len(sys.argv) > 2 else "campbell.png"
top = float(sys.argv[3]) if len(sys.argv) > 3 else 100_000.0

deck = whirl.load(deck_file)
rotor = deck.rotor()
speeds = np.linspace(top / 1000, top, 41)  # rpm; at rest pairs of modes are any mixture of forward and backward
found = [rotor.modes(f"{rpm} rpm", count=8, motion="lateral") for rpm in speeds]

# Lines: modes of neighbouring speeds are paired by the likeness of their shapes, |x^H M y|^2/(x^H M x y^H M y).
M = rotor.linearise(f"{speeds[0]} rpm").M
lines = [[k] for k in range(len(found[0].frequency))]
for before, now in zip(found, found[1:]):
    a, b = before.shapes, now.shapes
    energy = lambda x: np.real(np.sum(x.conj() * (M @ x.T).T, axis=1))
    like = abs(a.conj() @ (M @ b.T)) ** 2 / np.outer(energy(a), energy(b))
    partner = dict(zip(*linear_sum_assignment(-like)))
    for line in lines:
        last = line[-1]
        alike = last is not None and last in partner and like[last, partner[last]] > 0.5
        line.append(partner[last] if alike else None)

colours = {"forward": "tab:red", "backward": "tab:blue", "mixed": "tab:purple", "planar": "tab:green", "none": "grey"}
figure, axes = plt.subplots(figsize=(7.2, 4.8))
for line in lines:
    at = [(rpm, modes.frequency[k], modes.direction[k]) for rpm, modes, k in zip(speeds, found, line) if k is not None]
    rpm, hertz, direction = zip(*at)
    axes.plot(rpm, hertz, color=colours[direction[len(direction) // 2]], linewidth=1.4)
for name in ("forward", "backward"):
    axes.plot([], [], color=colours[name], label=name)
axes.plot(speeds, speeds / 60.0, "--", color="black", linewidth=0.9, label="1x")
axes.set(xlabel="speed [rpm]", ylabel="whirl frequency [Hz]", xlim=(0, top), ylim=(0, None),
         title=f"Campbell diagram: {tomllib.loads(deck.resolved)['title']}")
axes.legend(loc="upper left")
figure.tight_layout()
figure.savefig(picture, dpi=110)
print(f"{picture}: {len(lines)} modes at {len(speeds)} speeds, every list counted: {all(m.complete for m in found)}")
