#!/usr/bin/env python3
"""What `whirl check` says of wrong keys, held against what was approved before.

    messages.py WHIRL EXAMPLES APPROVED            compares; exit code 1 with any difference
    messages.py WHIRL EXAMPLES APPROVED --write

Every key of every example deck is wrong once: misspelt, of another type, of another sign, in a unit that
does not exist, or left out. A line holds the deck, the line, what was done and a checksum of all that the
program said.
"""
import re
import shutil
import subprocess
import sys
import tempfile
import zlib
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

KEY = re.compile(r"^(\s*)([A-Za-z_][\w.-]*)(\s*=\s*)(.+?)(\s*(?:#.*)?)$")


def other_sign(value):
    return re.sub(r"(?<![\w.])(\d)", r"-\g<1>", value, count=1)


def other_unit(value):
    return re.sub(r" [A-Za-z/.^0-9]+\"", ' furlong"', value, count=1)


FAULTS = {
    "misspelt": lambda key, value: (key[:-1] + "x", value),
    "type": lambda key, value: (key, "[]" if value.startswith('"') else '"word"'),
    "sign": lambda key, value: (key, other_sign(value)),
    "unit": lambda key, value: (key, other_unit(value)),
    "gone": lambda key, value: None,
}


def faults_of(deck):
    lines = deck.read_text().split("\n")
    for n, line in enumerate(lines):
        found = KEY.match(line)
        if not found:
            continue
        space, key, equal, value, rest = found.groups()
        kinds = sorted(FAULTS)
        kind = kinds[zlib.crc32(f"{key} {n}".encode()) % len(kinds)]
        new = FAULTS[kind](key, value)
        if new == (key, value):
            continue
        text = list(lines)
        text[n] = "" if new is None else f"{space}{new[0]}{equal}{new[1]}{rest}"
        yield f"{deck.parent.name} {n + 1} {key} {kind}", "\n".join(text)


def said_of(whirl, folder, text):
    """folder: a copy of the deck's."""
    with tempfile.NamedTemporaryFile("w", suffix=".toml", dir=folder, prefix="wrong_") as file:
        file.write(text)
        file.flush()
        name = Path(file.name).name
        run = subprocess.run([whirl, "check", name], cwd=folder, capture_output=True, text=True)
    said = (run.stdout + run.stderr).replace(name, "deck.toml")
    return f"{run.returncode} {zlib.crc32(said.encode()):08x}", said


def main():
    whirl, examples, approved = Path(sys.argv[1]).resolve(), *sys.argv[2:4]
    work = [(name, deck, text) for deck in sorted(Path(examples).glob("*/deck.toml")) for name, text in faults_of(deck)]
    with tempfile.TemporaryDirectory() as copies, ThreadPoolExecutor() as pool:
        folder_of = {}
        for deck in {w[1] for w in work}:
            folder_of[deck] = Path(copies) / deck.parent.name
            shutil.copytree(deck.parent, folder_of[deck], ignore=shutil.ignore_patterns("results*", "*.svg", "*.png"))
        said = list(pool.map(lambda w: said_of(whirl, folder_of[w[1]], w[2]), work))
    if "--write" in sys.argv:
        lines = [f"{name}\t{what}" for (name, _, _), (what, _) in zip(work, said)]
        Path(approved).write_text("# What `whirl check` says of wrong keys: see messages.py\n" + "\n".join(lines) + "\n")
        return 0
    want = dict(line.rsplit("\t", 1) for line in Path(approved).read_text().splitlines() if not line.startswith("#"))
    faults = 0
    for (name, _, _), (what, text) in zip(work, said):
        if want.get(name) == what:
            continue
        faults += 1
        if faults <= 5:
            print(f"{name}: {'is new' if name not in want else f'says {what}, was {want[name]}'}\n{text}")
    gone = set(want) - {name for name, _, _ in work}
    for name in sorted(gone)[:5]:
        print(f"{name}: is gone")
    if faults or gone:
        print(f"{faults} messages differ, {len(gone)} are gone; where it is meant, tests/approved/update.sh writes them anew")
    return 1 if faults or gone else 0


sys.exit(main())
