#!/usr/bin/env python3
"""Instructions a dozen decks take, against those stored in instructions.json.

    instructions.py WHIRL                     compare; exit code 1 when a deck takes over 3 % more than stored
    instructions.py WHIRL --write "reason"    store what is counted, with the reason for the change
    instructions.py WHIRL --only NAME ...     some decks; with --write the others stay as stored

Counted by valgrind (cachegrind without caches), in one thread, with the baseline kernels and the C library's baseline
functions, so that the numbers hang on the compiler and the libraries but hardly on the machine.
"""

import argparse
import json
import os
import re
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

HERE = Path(__file__).resolve().parent
EXAMPLES = HERE.parents[1] / "examples"
STORED = HERE / "instructions.json"
ALLOWED = 0.03  # relative growth

# A shaft of steel with a disk at its middle, in two linear bearings: {half} elements on either side.
ROTOR = """
format = 1
[model]
gravity = "9.81 m/s^2"
gravity_direction = "-y"
[[material]]
name = "steel of the deck"
E = "210 GPa"
nu = 0.3
density = "7850 kg/m^3"
[shaft]
material = "steel of the deck"
columns = ["name", "length[mm]", "od[mm]", "min_elements"]
rows = [["left", 500, 20, {half}], ["right", 500, 20, {half}]]
[[disk]]
name = "disk"
at = "left:end"
mass = "3 kg"
Ip = "0.015 kg.m^2"
Id = "0.0075 kg.m^2"
[[unbalance]]
at = "disk"
amount = "300 g.mm"
[[bearing]]
name = "driven"
at = "left:start"
type = "linear"
kxx = "1e6 N/m"
cxx = "10 N.s/m"
kyy = "1e6 N/m"
kzz = "8e5 N/m"
cyy = "50 N.s/m"
czz = "50 N.s/m"
[[bearing]]
name = "free"
at = "right:end"
type = "linear"
kyy = "1e6 N/m"
kzz = "8e5 N/m"
cyy = "50 N.s/m"
czz = "50 N.s/m"
[[probe]]
name = "disk"
at = "disk"
[[step]]
name = "step"
"""
MOTOR = """
[[drive]]
name = "motor"
at = "left:start"
type = "torque"
torque = "4.6 N.m"
"""
STEADY = """
[[drive]]
name = "motor"
at = "left:start"
type = "speed"
speed = "3000 rpm"
"""
TWELVE_PROBES = "".join(f"""
[[probe]]
name = "probe {x}"
at = "{x} mm"
""" for x in (20, 100, 180, 260, 340, 420, 580, 660, 740, 820, 900, 980))


def rotor(elements, step, more=""):
    return ROTOR.format(half=elements // 2) + step + more


# name: (deck, overrides); a deck is a text, or a path of an example
DECKS = {
    "run_up_100": (rotor(100, 'type = "transient"\nstart = "rest"\nduration = "0.1 s"\n', MOTOR), []),
    # what looks at twelve places costs beside the motion: 1.2 times that without is aimed at
    "probes_12": (rotor(50, 'type = "transient"\nlinear = true\nduration = "1 s"\n',
                        STEADY + TWELVE_PROBES), []),
    "campbell_100": (rotor(100, 'type = "campbell"\nmodes = 6\nmotion = "lateral"\n'
                           'speed = { start = "0 rpm", stop = "9000 rpm", points = 30 }\n'), []),
    "modes_400": (rotor(400, 'type = "modal"\nspeed = "3000 rpm"\nmodes = 10\n'), []),
    "unbalance_100": (rotor(100, 'type = "unbalance_response"\n'
                            'speed = { start = "100 rpm", stop = "9000 rpm", points = 60 }\n'), []),
    "linear": (EXAMPLES / "12_blade_loss/deck.toml", ["step.loss.linear=true", "step.loss.duration=0.3 s"]),
    "static_5000": (rotor(5000, 'type = "static"\n'), []),
    "critical_100": (rotor(100, 'type = "critical_speeds"\nmax_speed = "9000 rpm"\nmotion = "lateral"\n'), []),
    "films": (EXAMPLES / "20_oil_whirl/deck.toml",
              ["step.films.speeds.points=5", "step.onset.speed.points=3", "step.run_up.duration=1 s"]),
    "rolling": (EXAMPLES / "22_varying_compliance/deck.toml", []),
    "rub": (EXAMPLES / "21_rub/deck.toml", ["step.run_up.duration=1 s"]),
    "jeffcott": (EXAMPLES / "09_jeffcott_run_up/deck.toml", ["step.run_up.duration=2 s"]),
    "static_sag": (EXAMPLES / "30_static_sag/deck.toml", []),
}


def count(whirl, name, folder):
    """Instructions of one run."""
    deck, overrides = DECKS[name]
    if isinstance(deck, Path):
        path = deck
    else:
        path = folder / f"{name}.toml"
        path.write_text(deck)
    command = ["valgrind", "--tool=cachegrind", "--cache-sim=no", "--cachegrind-out-file=/dev/null",
               whirl, "run", str(path), "--quiet", "--jobs", "1", "--output", str(folder / name)]
    for o in overrides + ["output.vtk=[]"]:
        command += ["--set", o]
    environment = {"PATH": os.environ["PATH"], "WHIRL_ISA": "baseline", "LC_ALL": "C",
                   # the C library's own choice of functions by processor
                   "GLIBC_TUNABLES": "glibc.cpu.hwcaps=-AVX2,-AVX,-FMA,-FMA4,-AVX512F,-AVX512VL,-BMI2,-ERMS,-LZCNT,-MOVBE"}
    done = subprocess.run(command, env=environment, capture_output=True, text=True)
    found = re.search(r"I +refs: +([\d,]+)", done.stderr)
    if done.returncode != 0 or not found:
        raise SystemExit(f"{name}: exit code {done.returncode}\n{done.stdout}{done.stderr}")
    return int(found[1].replace(",", ""))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("whirl")
    parser.add_argument("--only", nargs="+", choices=DECKS, default=list(DECKS))
    parser.add_argument("--write", metavar="REASON")
    a = parser.parse_args()
    stored = json.loads(STORED.read_text()) if STORED.exists() else {"decks": {}}
    with tempfile.TemporaryDirectory() as folder, ThreadPoolExecutor(os.cpu_count()) as pool:
        counted = dict(zip(a.only, pool.map(lambda name: count(a.whirl, name, Path(folder)), a.only)))
    grown = []
    for name, n in counted.items():
        before = stored["decks"].get(name)
        change = n / before - 1 if before else None
        print(f"{name:16} {n / 1e6:10.1f} M" + (f"  {100 * change:+6.2f} %" if before else "  not stored"))
        if before is None or change > ALLOWED:
            grown.append(name)
    if a.write is not None:
        decks = {name: counted.get(name, stored["decks"].get(name)) for name in DECKS}
        text = {"why": a.write, "decks": {k: v for k, v in decks.items() if v}}
        STORED.write_text(json.dumps(text, indent=2) + "\n")
    elif grown:
        print(f"over the stored count by more than {100 * ALLOWED:g} %, or not stored: {', '.join(grown)}")
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
