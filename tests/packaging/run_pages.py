#!/usr/bin/env python3
"""Runs the decks that stand in the pages of the manual and compares the results named there.

    run_pages.py WHIRL DOCS

A page of docs/elements and docs/analyses holds at least one whole deck (a ```toml block with `format`) and, after each, a line
    Result: `TABLE.csv`, `COLUMN`[, last row] = NUMBER.
which holds to half a unit of the last digit written. A block that begins with "# command:" says by which subcommand it runs.
Every kind of bearing and of step is named by a page, and every page by the index of its folder.
"""
import csv
import pathlib
import re
import subprocess
import sys
import tempfile

whirl, docs = sys.argv[1], pathlib.Path(sys.argv[2])
wrong = []
RESULT = re.compile(r"^Result: `([^`]+)`, `([^`]+)`(, last row)? = ([-0-9.]+?)\.?$", re.M)


def half_a_unit(number):
    return 0.5 * 10.0 ** -len(number.partition(".")[2])


def check(page, deck, claims):
    command = "sweep" if deck.startswith("# command: sweep") else "run"
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        (folder / "deck.toml").write_text(deck)
        done = subprocess.run([whirl, command, "deck.toml", "-o", "results"], cwd=folder, capture_output=True, text=True)
        if done.returncode != 0:
            wrong.append(f"{page}: exit code {done.returncode}\n{done.stdout}{done.stderr}")
            return
        for table, column, last, number in claims:
            found = list((folder / "results").rglob(table))
            if not found:
                wrong.append(f"{page}: no {table}; there are {[p.name for p in (folder / 'results').rglob('*.csv')]}")
                continue
            rows = list(csv.DictReader(found[0].open()))
            row = rows[-1 if last else 0] if rows else {}
            if column not in row:
                wrong.append(f"{page}: {table} has no {column} (or no row): {list(row)}")
                continue
            if not abs(float(row[column]) - float(number)) <= half_a_unit(number) * 1.0000001:
                wrong.append(f"{page}: {table}, {column} is {row[column]}, not {number}")


count = 0
for folder in ("elements", "analyses"):
    index = (docs / folder / "README.md").read_text()
    for page in sorted((docs / folder).glob("*.md")):
        if page.name == "README.md":
            continue
        name, text = f"{folder}/{page.name}", page.read_text()
        if f"({page.name})" not in index:
            wrong.append(f"{name} is not in the index of its folder")
        parts = re.split(r"```toml\n(.*?)```", text, flags=re.S)
        decks = 0
        for deck, after in zip(parts[1::2], parts[2::2]):
            if "format = 1" not in deck:
                continue
            claims = RESULT.findall(after)
            if not claims:
                wrong.append(f"{name}: a deck without a result")
            check(name, deck, claims)
            decks += 1
        if decks == 0:
            wrong.append(f"{name}: no whole deck")
        count += decks
for folder, kind in (("elements", "bearing"), ("analyses", "step")):
    pages = "".join(p.read_text() for p in (docs / folder).glob("*.md"))
    for page in sorted((docs / "deck").glob(f"{kind}_*.md")):
        if f"../deck/{page.name}" not in pages:
            wrong.append(f"no page of {folder} names deck/{page.name}")
print("\n".join(wrong) if wrong else f"{count} decks of the manual run and give what it says")
sys.exit(bool(wrong))
