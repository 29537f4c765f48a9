#!/usr/bin/env python3
"""Puts the files that validation tests wrote together as docs/validation.md.

manual.py FOLDER            prints the manual
manual.py FOLDER FILE       compares it with FILE: texts and tolerances must be equal, references and computed values equal
                            but for one unit of the last digit printed (closed forms are evaluated in the run, too); exit code 1 and the differing rows otherwise
"""
import glob
import os
import sys

HEAD = """# Validation

Every number here was written by the test run itself (`tests/validation`, `WHIRL_VALIDATION_DIR`); a test fails when this file
differs from what the run produced. Computed values are printed with the digits their tolerance lets mean something; tolerances
are relative to the reference and stand in the tests with their reason. To make the file anew:

    ctest --test-dir build -L validation && tests/validation/manual.py build/validation > docs/validation.md
"""


def manual(folder):
    lines = HEAD.splitlines()
    cases = []
    for path in sorted(glob.glob(os.path.join(folder, "*.txt"))):
        with open(path, encoding="utf-8") as f:
            rows = f.read().splitlines()
        cases.append((rows[0][2:], rows[1][2:], os.path.basename(path)[:-4], [r.split("\t") for r in rows[2:]]))
    for name, source, test, rows in sorted(cases):
        lines += ["", "## " + name, "", source + " (test " + test + ")", "", "| quantity | unit | reference | computed | tolerance |", "|---|---|---|---|---|"]
        lines += ["| " + " | ".join(r) + " |" for r in rows]
    return lines


def same_number(a, b):
    try:
        x, y = float(a), float(b)
    except ValueError:
        return False
    digits = a.lower().split("e")[0].lstrip("-").replace(".", "").lstrip("0")
    unit = 10.0 ** (len(f"{abs(x):e}") and int(f"{abs(x):e}".split("e")[1]) - len(digits) + 1)
    return abs(x - y) <= 1.5 * unit


def main():
    lines = manual(sys.argv[1])
    if len(sys.argv) < 3:
        print("\n".join(lines))
        return 0
    with open(sys.argv[2], encoding="utf-8") as f:
        old = f.read().splitlines()
    bad = []
    if len(lines) != len(old):
        bad.append(f"{len(old)} lines in {sys.argv[2]}, {len(lines)} from the run")
    for a, b in zip(old, lines):
        if a == b:
            continue
        p, q = a.split(" | "), b.split(" | ")
        same = len(p) == 5 and len(q) == 5 and all(p[i] == q[i] for i in (0, 1, 4)) and all(p[i] == q[i] or same_number(p[i], q[i]) for i in (2, 3))
        if not same:
            bad += ["- " + a, "+ " + b]
    if bad:
        print("\n".join(bad))
        print("docs/validation.md is not what the tests computed: see its first lines")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
