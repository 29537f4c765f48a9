#!/usr/bin/env python3
"""The gallery of the manual: docs/gallery.md and docs/gallery/*.svg, one picture and one number of every example.

    gallery.py --write WHIRL SOURCE [EXAMPLE...]   runs the examples (those named; all: some minutes) and writes it anew
    gallery.py --check SOURCE                      every example is in it, and what it names is there
"""
import csv
import json
import pathlib
import re
import subprocess
import sys
import tempfile

largest = 45_000  # bytes of a picture
# example: figure (of the folder plots), table, column, row (number or "last"), what the number is
SHOWN = {
    "01_paper_rotor": ("precession_disk_synchronous", "precession_peaks", "amplitude 0-peak [m]", 0, "largest displacement"),
    "02_run_up": ("run_up_and_down_stage2_spectrogram_rising_speed", "run_up_and_down_peaks", "amplitude 0-peak [m]", 0, "largest amplitude"),
    "03_rotating_shaft_benchmark": ("passage_disk_amplitude", "passage_peaks", "amplitude 0-peak [m]", 0, "largest amplitude, exact 0.269760"),
    "04_torque_run_up": ("run_up_disk_amplitude", "run_up_peaks", "amplitude 0-peak [m]", 0, "largest amplitude, exact 1.6911e-3"),
    "05_campbell_nelson_mcvaugh": ("campbell_campbell", "critical_speeds_undamped", "speed [rpm]", 0, "first critical speed"),
    "06_unbalance_response": ("unbalance_disk_2_bode", "unbalance_peaks", "speed [rpm]", 0, "first peak"),
    "07_internal_damping": ("stability_log_decrement", "stability_onset", "speed [rpm]", 0, "onset of instability"),
    "08_asymmetric_shaft": ("stability_growth", "stability_bands", "from [rpm]", 0, "the unstable band begins"),
    "09_jeffcott_run_up": ("run_up_disk_amplitude", "run_up_peaks", "amplitude 0-peak [m]", 0, "peak, exact 2.35842911e-3"),
    "10_sommerfeld": ("up_and_down_speed", "up_and_down_peaks", "amplitude 0-peak [m]", 0, "largest amplitude"),
    "11_internal_damping_run_down": ("run_down_disk_envelope", "run_down_peaks", "speed [rpm]", 0, "largest whirl at"),
    "12_blade_loss": ("loss_speed", "loss_peaks", "amplitude 0-peak [m]", 0, "largest amplitude"),
    "13_manoeuvre": ("manoeuvre_wheel_synchronous", "manoeuvre_peaks", "amplitude 0-peak [m]", 0, "largest displacement"),
    "14_torsional_train": ("modes_interference", "modes_torsional", "frequency [Hz]", 0, "first torsional frequency"),
    "15_twice_per_turn": ("run_mass_history", "run_peaks", "amplitude 0-peak [m]", 0, "largest amplitude"),
    "20_oil_whirl": ("run_up_disk1_spectrogram", "onset_onset", "speed [rpm]", 0, "onset of whirl"),
    "21_rub": ("run_up_disk_amplitude", "run_up_peaks", "amplitude 0-peak [m]", 0, "largest amplitude"),
    "22_varying_compliance": ("run_inner_ring_orbit", "run_peaks", "amplitude 0-peak [m]", 0, "largest displacement"),
    "23_dual_spool": ("run_up_fan_bode", "run_up_peaks", "amplitude 0-peak [m]", 0, "largest amplitude of the fan"),
    "24_geared_pair": ("start_up_speed", "start_up_peaks", "amplitude 0-peak [m]", 0, "largest displacement of the pinion"),
    "25_casing_on_foundation": ("unbalance_impeller_bode", "modes_modes", "frequency [Hz]", 0, "first mode"),
    "26_pad_dynamics": ("campbell_campbell", "modes_modes", "frequency [Hz]", 0, "first mode"),
    "27_misaligned_coupling": ("run_motor_DE_full_spectrum", "run_peaks", "amplitude 0-peak [m]", 0, "largest displacement"),
    "28_tilting_pads": ("rated_pads_1", "modes_modes", "frequency [Hz]", 0, "first mode"),
    "30_static_sag": ("sag_deflection", "sag_supports", "F_y [N]", 0, "force of the left bearing, exact 494.45 (cold)"),
    "31_column_beyond_buckling": ("path_path", "path_deflection", "u_y [m]", "last", "the end stands aside, exact 0.79703"),
    "32_bend": ("pull_path", "pull_deflection", "u_z [m]", "last", "the end rises, exact 53.474859"),
    "33_double_pendulum": ("fall_tip_yz", "fall_peaks", "amplitude 0-peak [m]", 0, "largest displacement of the tip, rigid bars 0.999755"),
    "34_tolerances": ("unbalance_disk_2_bode", "criticals_undamped", "speed [rpm]", 0, "first critical speed as drawn"),
    "35_magnetic_bearings": ("margins_curves", "margins_sensitivity", "largest sensitivity [-]", 0, "largest sensitivity"),
    "36_api_lateral": ("lateral_minimum_clearance_map_critical_map", "lateral_minimum_clearance_modes_unbalance", "critical speed [rpm]", 0, "first critical speed, least clearance"),
    "37_turbocharger_floating_rings": ("run_compressor_spectrogram_rising_speed", "onset_onset", "whirl frequency [Hz]", 0, "frequency of the whirl at its onset"),
    "38_cracked_rotor": ("steady_wheel_multiples", "steady_peaks", "speed [rpm]", 0, "first peak of the response"),
    "39_hot_tilting_pads": ("measured_films_1", "measured_films", "hottest face [degC]", 1, "hottest pad, 76.5 measured"),
    "41_synchronous_start": ("start_torques", "torsional_compliance", "value [-]", "last", "share of the life that 5000 starts and ten short circuits use up"),
}


def title(deck):
    return re.search(r'^title\s*=\s*"(.*)"', deck.read_text(), flags=re.M)[1]


def number_of(results, table, column, row):
    rows = list(csv.DictReader((results / f"{table}.csv").open()))
    return float(rows[-1 if row == "last" else row][column])


def write(whirl, source, names):
    numbers_file = source / "docs/gallery/numbers.json"
    numbers = json.loads(numbers_file.read_text()) if numbers_file.exists() else {}
    for name in names or SHOWN:
        figure, table, column, row, _ = SHOWN[name]
        with tempfile.TemporaryDirectory() as folder:
            results = pathlib.Path(folder) / "results"
            subprocess.run([whirl, "run", source / "examples" / name / "deck.toml", "--quiet", "-o", results], cwd=folder, check=True)
            (source / f"docs/gallery/{name}.svg").write_text((results / f"plots/{figure}.svg").read_text())
            numbers[name] = float(f"{number_of(results, table, column, row):.6g}")
    numbers_file.write_text(json.dumps(numbers, indent=1, sort_keys=True) + "\n")
    page = ("# Gallery\n\nOne picture and one number of every example; each folder holds the deck and says what to expect. "
            "Written by `tests/packaging/gallery.py` from runs of the program.\n")
    for name in SHOWN:
        figure, table, column, row, what = SHOWN[name]
        unit = re.search(r"\[(.*)\]$", column)[1].replace("-", "")
        page += (f"\n## {name[:2]} {title(source / 'examples' / name / 'deck.toml')}\n\n![{figure}](gallery/{name}.svg)\n\n"
                 f"[`examples/{name}`](../examples/{name}/README.md): {what}: **{numbers[name]:.6g} {unit}**".rstrip(" *") + "**\n")
    (source / "docs/gallery.md").write_text(page)


def check(source):
    page = (source / "docs/gallery.md").read_text()
    wrong = []
    examples = [p.parent.name for p in sorted((source / "examples").glob("*/deck.toml"))]
    for name in examples:
        if f"(../examples/{name}/README.md)" not in page or f"(gallery/{name}.svg)" not in page:
            wrong.append(f"example {name} is not in docs/gallery.md: give it a line in tests/packaging/gallery.py and run that")
            continue
        picture = source / f"docs/gallery/{name}.svg"
        if not picture.exists() or "<svg" not in picture.read_text()[:300]:
            wrong.append(f"{picture} is no picture")
        elif picture.stat().st_size > largest:
            wrong.append(f"{picture} has {picture.stat().st_size} bytes, {largest} at most")
        if f"{title(source / 'examples' / name / 'deck.toml')}\n" not in page:
            wrong.append(f"{name}: the title in the gallery is not that of the deck")
    for picture in (source / "docs/gallery").glob("*.svg"):
        if picture.stem not in examples:
            wrong.append(f"{picture} belongs to no example")
    print("\n".join(wrong) if wrong else f"{len(examples)} examples in the gallery")
    return bool(wrong)


if sys.argv[1] == "--check":
    sys.exit(check(pathlib.Path(sys.argv[2])))
write(sys.argv[2], pathlib.Path(sys.argv[3]).resolve(), sys.argv[4:])
