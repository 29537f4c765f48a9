#!/usr/bin/env python3
"""The starters of `whirl new --machine`: each is checked with every limit of its questions, and run as it is and with every word. What the run as it is
writes is held against what was approved (tests/approved).

    check_starters.py WHIRL
"""
import csv
import json
import pathlib
import re
import subprocess
import sys
import tempfile
import tomllib

program = sys.argv[1]
approved = pathlib.Path(__file__).resolve().parents[1] / "approved"
machines = {"compressor", "fan", "flywheel", "gas_turbine", "geared", "motor", "pump", "spindle", "train", "turbocharger", "vertical_pump"}
steps = {  # what each must have run, and a number of its results within limits that hold for such a machine
    "compressor": ("lateral_compliance.csv", "lateral_minimum_clearance_modes_unbalance.csv", "critical speed [rpm]", 2000, 9000),
    "fan": ("unbalance_response.csv", "critical_speeds_undamped.csv", "speed [rpm]", 1480, 2500),
    "flywheel": ("margins_sensitivity.csv", "margins_sensitivity.csv", "largest sensitivity [-]", 1, 3),
    "gas_turbine": ("unbalance_response_1_5x.csv", "critical_speeds_undamped.csv", "speed [rpm]", 4000, 7000),
    "geared": ("torsional_torsional.csv", "torsional_torsional.csv", "frequency [Hz]", 50, 300),
    "motor": ("stability_verdicts.csv", "critical_speeds_undamped.csv", "speed [rpm]", 5000, 8000),
    "pump": ("unbalance_response.csv", "critical_speeds_undamped.csv", "speed [rpm]", 2980, 11920),
    "spindle": ("compliance_response.csv", "critical_speeds_undamped.csv", "speed [rpm]", 18000, 72000),
    "train": ("torsional_compliance.csv", "torsional_modes.csv", "frequency [Hz]", 20, 100),
    "turbocharger": ("unbalance_response.csv", "modes_modes.csv", "frequency [Hz]", 1, 2000),
    "vertical_pump": ("unbalance_response.csv", "hanging_supports.csv", "F_x [N]", -30000, -20000),
}


def whirl(*arguments, cwd=None):
    return subprocess.run([program, *arguments], cwd=cwd, capture_output=True, text=True)


def number(table, column):
    return float(next(csv.DictReader(table.open()))[column])


def questions(machine):
    """key: (default, words, least, most)"""
    out = {}
    for line in whirl("new", "--machine", machine, "--questions").stdout.splitlines():
        key, rest = line.split(None, 1)
        limits = re.match(r"(\d+) \((\d+) to (\d+)\)", rest)
        given = re.split(r"  +", rest)[0]
        out[key] = (limits[1], None, int(limits[2]), int(limits[3])) if limits else (given, given.split("|") if "|" in given else None, 0, 0)
    return out


listed = re.search(r"of the kinds (.*)", whirl("new").stderr)[1]
assert set(listed.split(", ")) == machines == set(steps), listed

with tempfile.TemporaryDirectory() as folder:
    folder = pathlib.Path(folder)
    for machine in sorted(machines):
        asked = questions(machine)
        assert len(asked) >= 4, (machine, asked)
        file = folder / f"{machine}.toml"
        made = whirl("new", "--machine", machine, str(file))
        assert made.returncode == 0 and "whirl check" in made.stderr, made
        deck = file.read_text()
        assert deck == whirl("new", "--machine", machine).stdout
        for mark in ("#?", "#if", "#each", "#end", "{k}"):
            assert mark not in deck, (machine, mark)
        parameters = tomllib.loads(deck)["parameters"]
        # every question stands in the deck: as a parameter that is used, or as what was chosen
        variants = []
        for key, (default, words, least, most) in asked.items():
            if words:
                variants += [(key, word) for word in words]
            elif most:
                variants += [(key, str(least)), (key, str(most))]
            else:
                assert parameters[key] == default, (machine, key)
                assert deck.count("${" + key + "}") >= 1, (machine, key)
                changed = whirl("new", "--machine", machine, "--answer", f"{key}=1.5 * {default}")
                assert changed.returncode == 0, (machine, key, changed.stderr)
                assert tomllib.loads(changed.stdout)["parameters"][key] == f"1.5 * {default}"
        seen = {deck}
        for key, answer in variants:
            made = whirl("new", "--machine", machine, "--answer", f"{key}={answer}", "--force", str(folder / "variant.toml"))
            assert made.returncode == 0, (machine, key, answer, made.stderr)
            checked = whirl("check", "variant.toml", cwd=folder)
            assert checked.returncode == 0, (machine, key, answer, checked.stderr)
            text = (folder / "variant.toml").read_text()
            if text not in seen and asked[key][1]:  # another word may be another machine
                ran = whirl("run", "variant.toml", "--quiet", "-o", f"results_{machine}_{key}_{answer}", cwd=folder)
                assert ran.returncode == 0, (machine, key, answer, ran.stdout, ran.stderr)
            seen.add(text)
        assert len(seen) >= 1 + sum(len(words) - 1 for _, words, _, _ in asked.values() if words), machine
        results = folder / machine
        log = folder / f"{machine}.log"
        with log.open("w") as said:
            code = subprocess.run([program, "run", file.name, "-o", machine], cwd=folder, stdout=said, stderr=subprocess.STDOUT).returncode
        assert code == 0, (machine, log.read_text())
        subprocess.run([sys.executable, approved / "approved.py", machine, log.name, approved / f"starter_{machine}.txt"], cwd=folder, check=True)
        needed, table, column, low, high = steps[machine]
        assert (results / needed).exists(), (machine, sorted(p.name for p in results.glob("*.csv")))
        value = number(results / table, column)
        assert low < value < high, (machine, column, value)
        steps_run = json.loads((results / "summary.json").read_text())["steps"]
        print(f"{machine}: {len(asked)} questions, {len(variants)} variants checked, {len(steps_run)} steps run, {column} {value:.6g}")

    # a choice changes what runs
    linear = whirl("new", "--machine", "pump", "--answer", "bearings=linear", "--answer", "wear_ring=no").stdout
    kinds = [b["type"] for b in tomllib.loads(linear)["bearing"]]
    assert kinds == ["linear", "linear"], kinds
    three = tomllib.loads(whirl("new", "--machine", "compressor", "--answer", "stages=3").stdout)
    assert [d["name"] for d in three["disk"]] == ["coupling", "impeller 1", "impeller 2", "impeller 3", "thrust collar"]

    # what cannot be answered so is said, and nothing is written
    for arguments, code, words in (
            (("--machine", "pmp"), 2, "did you mean 'pump'?"),
            (("--machine", "pump", "--answer", "sped=1 rpm"), 2, "did you mean 'speed'?"),
            (("--machine", "pump", "--answer", "bearings=foil"), 2, "one of: ball, linear"),
            (("--machine", "compressor", "--answer", "stages=12"), 2, "from 1 to 9"),
            (("--machine", "compressor", "--answer", "stages=two"), 2, "from 1 to 9"),
            (("--machine", "pump", "--answer", "speed"), 2, "KEY=VALUE"),
            (("--machine", "pump", "--answer", 'speed=1 rpm"'), 2, "a number with its unit"),
            (("--machine", "pump", "--answer", "speed=12 kg"), 3, "rpm"),
            (("--machine", "pump", "--answer", "span=0 mm"), 3, "length"),
            (("--answer", "speed=1 rpm"), 2, "--machine"),
            (("--machine", "pump", "--example", "run_up"), 2, "--example")):
        said = whirl("new", *arguments, "nothing.toml", cwd=folder)
        assert said.returncode == code and words in said.stderr, (arguments, said)
        assert not (folder / "nothing.toml").exists(), arguments
    again = whirl("new", "--machine", "pump", "pump.toml", cwd=folder)
    assert again.returncode == 5 and "--force" in again.stderr, again
