#!/usr/bin/env python3
"""The fastest settings of a study as the table of an example's README.

    whirl study examples/NAME/deck.toml && examples/study_table.py results/NAME/study.csv
    examples/study_table.py results/NAME/study_mesh.csv
"""
import csv
import sys

NAMES = {"radau5": "Radau 5", "gauss4": "Gauss 4", "gauss6": "Gauss 6", "generalized_alpha": "generalized-alpha", "ida": "IDA (BDF 2)", "momentum_rk": "momentum form, explicit RK 8"}


def column(titles, start):
    return next(i for i, t in enumerate(titles) if t.startswith(start))


def main():
    with open(sys.argv[1], encoding="utf-8") as f:
        rows = [r for r in csv.reader(f) if r and not r[0].startswith("#")]
    titles, rows = rows[0], rows[1:]
    tolerance, dt, mesh, cpu, steps, front, error = (column(titles, x) for x in ("tolerance", "dt", "mesh factor", "CPU", "steps", "Pareto", "largest error"))
    front_rows = sorted((r for r in rows if float(r[front]) > 0 and float(r[error]) < 0.5), key=lambda r: float(r[cpu]))
    if not rows[0][0]:   # meshes alone
        print("| mesh | elements | CPU s | largest error |\n|---|---|---|---|")
        for r in rows:
            factor = int(float(r[mesh]))
            name = "the deck's" if factor == 1 else f"{factor} times as fine"
            print(f"| {name} | {int(float(r[steps]))} | {float(r[cpu]):.2g} | {float(r[error]):.1e} |".replace("e-0", "e-"))
        return
    # one row a decade of error is enough
    chosen, last = [], None
    for r in front_rows:
        if last is None or float(r[error]) < 0.3 * last:
            chosen.append(r)
            last = float(r[error])
    default = [r for r in rows if r[0] == "radau5" and float(r[tolerance]) == 1e-4 and float(r[mesh]) == 1]
    chosen += [r for r in default if r not in chosen]
    print("| setting | CPU s | steps | largest error |\n|---|---|---|---|")
    for r in sorted(chosen, key=lambda r: float(r[cpu])):
        how = f"tolerance {float(r[tolerance]):.0e}".replace("e-0", "e-") if float(r[tolerance]) > 0 else f"equal steps of {float(r[dt]):.3g} s"
        finer = f", {int(float(r[mesh]))} times the elements" if float(r[mesh]) > 1 else ""
        note = " (default)" if r in default else ""
        print(f"| {NAMES.get(r[0], r[0])}, {how}{finer}{note} | {float(r[cpu]):.2g} | {int(float(r[steps]))} | {float(r[error]):.1e} |".replace("e-0", "e-"))


if __name__ == "__main__":
    main()
