#!/usr/bin/env python3
"""The pages of the manual that are worked through: what stands in them happens.

    run_guide.py WHIRL PAGE     writes its blocks "```toml file=NAME", runs the commands of its blocks "```console" ("$ whirl ..."), and
                                finds every other line of those in the output ("..." at the end of a line: whatever follows); then
                                the lines  Result: `TABLE.csv`, `COLUMN`[, last row] = NUMBER.
    run_guide.py --quotes PAGE SOURCE    its blocks "```LANGUAGE file=NAME" stand word for word in the file NAME of the folder SOURCE
"""
import csv
import pathlib
import re
import subprocess
import sys
import tempfile

wrong = []


def squeezed(text):
    return re.sub(r"\s+", " ", text).strip()


def run_console(whirl, block, folder):
    said = ""
    for line in block.splitlines():
        if line.startswith("$ whirl "):
            done = subprocess.run([whirl, *line[8:].split()], cwd=folder, capture_output=True, text=True)
            said = [squeezed(l) for l in (done.stdout + done.stderr).splitlines()]
            if done.returncode != 0:
                wrong.append(f"{line}: exit code {done.returncode}\n" + "\n".join(said))
        elif line.strip():
            wanted = squeezed(line)
            begins = wanted.endswith("...")
            if not any(l.startswith(wanted[:-3]) if begins else l == wanted for l in said):
                wrong.append(f"the program does not say: {line}\nit says:\n  " + "\n  ".join(said))


def work_through(whirl, page):
    text = page.read_text()
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        results = None
        for match in re.finditer(r"```toml file=(\S+)\n(.*?)```|```console\n(.*?)```|^Result: `([^`]+)`, `([^`]+)`(, last row)? = ([-0-9.]+?)\.?$",
                                 text, flags=re.S | re.M):
            name, deck, console, table, column, last, number = match.groups()
            if deck:
                (folder / name).write_text(deck)
            elif console:
                run_console(whirl, console, folder)
                results = folder / re.findall(r"-o (\S+)", console)[-1] if "-o " in console else results
            else:
                rows = list(csv.DictReader((results / table).open()))
                value = float(rows[-1 if last else 0][column])
                if not abs(value - float(number)) <= 0.5000001 * 10.0 ** -len(number.partition(".")[2]):
                    wrong.append(f"{table}, {column} is {value}, not {number}")


def compare_quotes(page, source):
    quotes = re.findall(r"```\w+ file=(\S+)\n(.*?)```", page.read_text(), flags=re.S)
    if not quotes:
        wrong.append(f"{page} quotes nothing")
    for name, quote in quotes:
        if quote not in (source / name).read_text():
            wrong.append(f"{page}: this does not stand in {name}:\n{quote}")


if sys.argv[1] == "--quotes":
    compare_quotes(pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3]))
else:
    work_through(sys.argv[1], pathlib.Path(sys.argv[2]))
print("\n".join(wrong) if wrong else "the page holds")
sys.exit(bool(wrong))
