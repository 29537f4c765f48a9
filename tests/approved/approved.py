#!/usr/bin/env python3
"""Holds what the program writes against what was approved before, of every kind of file.

    approved.py RESULTS LOG APPROVED        compares; a line for each difference, exit code 1 with any
    approved.py RESULTS LOG APPROVED --write [OTHER_RESULTS OTHER_LOG]

OTHER_RESULTS are of the same deck, without fused multiplications: what differs there is known to vary and
only has to be there. RESULTS is a folder of results, LOG what the run printed, APPROVED a file of this folder. Other tests say
whether a number is right; this one says which numbers, words and drawings a change has touched, so that
none changes unseen. Texts are compared by their checksum with every number left out, numbers by a few
sums over a column, a section or a figure: rounding and another instruction set stay below the
tolerances, a factor, a sign or a shifted curve does not.
"""
import argparse
import csv
import html.parser
import json
import math
import re
import sys
import xml.etree.ElementTree as ET
import zlib
from pathlib import Path

NUMBER = re.compile(r"(?<![\w.])[-−+]?\d+(?:\.\d+)?(?:[eE][-+]?\d+|×10[⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+)?")
SUPERSCRIPTS = str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "-0123456789")
# of these only the size is known: rounding, and how a solver went about it
SIZES = re.compile(r"integrator|defect|error|damping ratio|factorizations|evaluations|within|stored at end")
# what differs from run to run
TIMES = re.compile(r"\d[\d.e-]* s (?:CPU|wall)|run time|\[s\] (?:cpu|wall)|cpu|wall", re.I)


def crc(text):
    return f"{zlib.crc32(text.encode()):08x}"


def value_of(token):
    token = token.replace("−", "-")
    if "×10" in token:
        digits, power = token.split("×10")
        return float(digits) * 10.0 ** int(power.translate(SUPERSCRIPTS))
    return float(token)


def spread_weight(i):
    """Between 1 and 2, another for each place: numbers that change places are noticed."""
    return 1.0 + (0.6180339887 * i) % 1.0


def without_numbers(text):
    return NUMBER.sub("#", text)


# ---- features: name -> list; the first entry says how it is compared ----

def of_text(text):
    """Words by checksum, numbers by a weighted sum of logarithms; tiny ones are rounding or errors."""
    numbers = [value_of(t) for t in NUMBER.findall(text)]
    total = sum(spread_weight(i) * math.asinh(v * 1e3) for i, v in enumerate(numbers) if abs(v) > 1e-5)
    return ["text", crc(" ".join(without_numbers(text).split())), len(numbers), total]


def of_column(values, scale):
    """Mean, weighted mean and root mean square; scale: the largest of the columns of this unit."""
    n = len(values)
    mean = sum(values) / n
    weighted = sum(v * (2 * i / max(1, n - 1) - 1) for i, v in enumerate(values)) / n
    rms = math.sqrt(sum(v * v for v in values) / n)
    return ["column", n, scale, mean, weighted, rms]


def number_or_none(text):
    try:
        v = float(text)
    except ValueError:
        return None
    return v if math.isfinite(v) else None


def unit_of(title):
    found = re.findall(r"\[([^\]]*)\]", title)
    return found[-1] if found else title


def of_csv(path):
    with open(path, newline="", encoding="utf-8") as f:
        rows = list(csv.reader(f))
    out = {"header": ["words", crc("|".join(rows[0]))]}
    columns, scales = {}, {}
    for k, title in enumerate(rows[0]):
        cells = [row[k] for row in rows[1:] if k < len(row)]
        values = [number_or_none(c) for c in cells]
        numbers = [v for v in values if v is not None]
        words = [c for c, v in zip(cells, values) if v is None]
        if words:
            out[f"{title} (words)"] = of_text("|".join(words))
        if numbers:
            columns[title] = numbers
            unit = unit_of(title)
            scales[unit] = max(scales.get(unit, 0.0), max(map(abs, numbers)))
    for title, numbers in columns.items():
        out[title] = of_column(numbers, scales[unit_of(title)])
    return out


def leaves(node, path=""):
    if isinstance(node, dict):
        for key, child in node.items():
            yield from leaves(child, f"{path}/{key}")
    elif isinstance(node, list):
        for child in node:
            yield from leaves(child, f"{path}/*")
    else:
        yield path, node


def of_summary(path):
    """A line for each name; numbers of lists together."""
    found = {}
    for name, leaf in leaves(json.loads(Path(path).read_text())):
        if not TIMES.search(name):
            found.setdefault(name, []).append(leaf)
    out = {}
    for name, values in found.items():
        if all(isinstance(v, (int, float)) and not isinstance(v, bool) for v in values):
            largest = max(abs(v) for v in values)
            rough = SIZES.search(name) or largest < 1e-9
            out[name] = ["size", largest] if rough else of_column([float(v) for v in values], largest)
        else:
            out[name] = of_text("|".join(str(v) for v in values))
    return out


class Sections(html.parser.HTMLParser):
    """Text of a report, by its sections; drawings, scripts and styles are left out."""

    def __init__(self):
        super().__init__()
        self.texts, self.section, self.skipped = {"": []}, "", 0

    def handle_starttag(self, tag, attributes):
        if tag in ("script", "style", "svg"):
            self.skipped += 1
        given = dict(attributes)
        if tag == "section":
            self.section = given.get("id", "")
            self.texts[self.section] = []
        if not self.skipped:
            names = [f"{k}={given[k]}" for k in ("id", "class", "title", "href") if given.get(k)]
            self.texts[self.section].append(" ".join([tag, *names]))

    def handle_endtag(self, tag):
        if tag in ("script", "style", "svg"):
            self.skipped -= 1

    def handle_data(self, data):
        if not self.skipped:
            self.texts[self.section].append(data)


def of_report(path):
    parser = Sections()
    parser.feed(Path(path).read_text(encoding="utf-8"))
    out = {}
    for section, parts in parser.texts.items():
        kept, drop = [], 0
        for part in parts:
            drop = 2 if part.startswith("run time") else drop  # the value stands in the element after it
            if part.strip() and not TIMES.search(part) and not (drop and NUMBER.match(part)):
                kept.append(part)
            drop -= bool(drop) and bool(NUMBER.match(part))
        words = "\n".join(kept)
        timed = "run time by phase" in "\n".join(parts)  # the summary, which is read in its own file
        out[f"section {section}"] = ["words", crc(" ".join(without_numbers(words).split()))] if timed else of_text(words)
    return out


def of_points(points):
    n = max(1, len(points))
    means = [sum(p[k] for p in points) / n for k in (0, 1)]
    spreads = [math.sqrt(sum(p[k] ** 2 for p in points) / n) for k in (0, 1)]
    order = sum((p[0] + p[1]) * spread_weight(i) for i, p in enumerate(points)) / n
    return [*means, *spreads, order]


def corners(d):
    x = y = 0.0
    for command, numbers in re.findall(r"([A-Za-z])([^A-Za-z]*)", d):
        values = [float(v) for v in re.findall(r"-?\d*\.?\d+", numbers)]
        if command in "ML":
            for x, y in zip(values[::2], values[1::2]):
                yield x, y
        elif command == "h" and values:
            x += values[0]
            yield x, y
        elif command == "V" and values:
            y = values[0]
            yield x, y


def of_figure(path):
    """Its words, how many parts of each kind and class, and where they stand, px."""
    words, kinds, paths, texts, shapes = [], {}, [], [], []
    for e in ET.parse(path).iter():
        tag = e.tag.split("}")[-1]
        kind = f"{tag}.{e.get('class', '')}.{e.get('stroke', '')}.{e.get('fill', '')}.{e.get('stroke-dasharray', '')}"
        kinds[kind] = kinds.get(kind, 0) + 1
        if e.text and e.text.strip():
            words.append(e.text.strip())
        words += [e.get(k) for k in ("data-xl", "data-xu", "data-yl", "data-yu", "data-kind") if e.get(k)]
        if tag == "path":
            paths += corners(e.get("d", ""))
        elif tag == "text":
            texts.append((float(e.get("x", 0)), float(e.get("y", 0))))
        elif tag in ("line", "rect", "circle"):
            at = [e.get(k) for k in ("x", "y", "x1", "y1", "x2", "y2", "cx", "cy", "width", "height", "r")]
            at = [float(v) for v in at if v is not None and not v.endswith("%")]
            shapes += zip(at[::2], at[1::2])
    out = {"words": of_text("\n".join(words)),
           "parts": ["words", crc(json.dumps({k: n for k, n in sorted(kinds.items()) if "path" not in k}))]}
    for name, points in (("paths", paths), ("texts", texts), ("shapes", shapes)):
        if points:
            out[name] = ["points", len(points), *of_points(points)]
    return out


def of_frame(path):
    """Arrays of a VTK file with their ranges, as its header has them."""
    head = path.read_bytes().split(b"<AppendedData")[0].decode(errors="replace")
    out = {}
    for text in re.findall(r"<(?:DataArray|Array)\b[^>]*>", head):
        given = dict(re.findall(r'(\w+)="([^"]*)"', text))
        ends = [number_or_none(given.get(k, "").strip()) for k in ("RangeMin", "RangeMax")]
        name = f"{given.get('Name', '')} {given.get('type')} {given.get('NumberOfComponents', 1)}"
        if None not in ends:
            out[name] = of_column(ends, max(map(abs, ends)))
    return out


def of_log(path):
    place = re.compile(r"\S*/([\w.-]+\.(?:toml|csv))")
    lines = [place.sub(r"\1", re.sub(r", [\d.e-]+ s CPU.*", "", line)) for line in Path(path).read_text(encoding="utf-8").splitlines()
             if not re.search(r"^results: | \d+ %  ", line)]
    return {f"line {i}": of_text(line) for i, line in enumerate(lines)}


def digest(folder, log):
    out = {}

    def add(name, features):
        for key, feature in features.items():
            out[f"{name}: {key}"] = feature

    folder = Path(folder)
    files = sorted(p.relative_to(folder) for p in folder.rglob("*") if p.is_file() and "checkpoint" not in p.parts)
    frames = [p for p in files if p.suffix in (".vtp", ".vtu")]
    named = [p for p in files if p.parts[0] != "vtk" and p.suffix != ".h5"]  # which a program may be built without
    add("files", {"names": of_text("\n".join(map(str, named)))})
    if frames:
        add("vtk", {"frames": ["count", len(frames)]})
    for p in files:
        if p.suffix == ".csv":
            add(str(p), of_csv(folder / p))
        elif p.suffix == ".svg":
            add(str(p), of_figure(folder / p))
        elif p.name == "summary.json":
            add(str(p), of_summary(folder / p))
        elif p.name == "report.html":
            add(str(p), of_report(folder / p))
        elif p.name == "resolved.toml":
            add(str(p), {"deck": of_text((folder / p).read_text())})
    last = {}
    for p in frames:
        last[str(p.parent)] = p
    for name, p in last.items():
        add(f"{name} (last frame)", of_frame(folder / p))
    add("log", of_log(log))
    return out


# ---- comparison ----

def differences(want, got):
    """Empty when the two are the same but for rounding."""
    kind = want[0]
    if kind == "varies":
        return ""
    if kind != got[0]:
        return f"is of kind {got[0]}, was {kind}"
    if kind == "words":
        return "" if want == got else "other words"
    if kind == "size":
        small = 1e-12
        ratio = (abs(got[1]) + small) / (abs(want[1]) + small)
        return "" if 0.1 < ratio < 10 else f"{got[1]:.3g} for {want[1]:.3g}"
    if kind == "count":
        return "" if abs(want[1] - got[1]) <= 0.01 * want[1] + 0.5 else f"{got[1]} for {want[1]}"
    if kind == "text":
        if want[1] != got[1]:
            return "other words"
        if want[2] != got[2]:
            return f"{got[2]} numbers for {want[2]}"
        return "" if abs(want[3] - got[3]) <= 2e-2 + 2e-5 * want[2] else f"other numbers (their sum {got[3]:.6g} for {want[3]:.6g})"
    if kind == "column":
        if abs(want[1] - got[1]) > 0.01 * want[1]:
            return f"{got[1]} values for {want[1]}"
        allowed = 1e-3 * want[2] if want[1] > 50 else 5e-4 * want[2]
        names = ("", "", "largest", "mean", "weighted mean", "root mean square")
        return ", ".join(f"{names[k]} {got[k]:.8g} for {want[k]:.8g}" for k in range(2, 6) if abs(want[k] - got[k]) > allowed)
    if abs(want[1] - got[1]) > 0.02 * want[1] + 2:  # a figure's points
        return f"{got[1]} points for {want[1]}"
    names = ("", "", "mean x", "mean y", "rms x", "rms y", "order")
    few = 0.05 if want[1] == got[1] else 1.0
    return ", ".join(f"{names[k]} {got[k]:.6g} px for {want[k]:.6g}" for k in range(2, 7) if abs(want[k] - got[k]) > few * (3 if k == 6 else 1))


def read(path):
    out, file = {}, ""
    for line in Path(path).read_text(encoding="utf-8").splitlines():
        if line.startswith("== "):
            file = line[3:]
        elif line and not line.startswith("#"):
            name, feature = line.rsplit("\t", 1)
            out[f"{file}: {name}"] = json.loads(feature)
    return out


def rounded(feature):
    digits = {"text": 8, "points": 6}.get(feature[0], 5)
    return [float(f"{v:.{digits}g}") if isinstance(v, float) else v for v in feature]


def text_of(feature):
    """The shortest JSON."""
    return json.dumps([int(v) if isinstance(v, float) and v.is_integer() and abs(v) < 1e5 else v for v in rounded(feature)], separators=(",", ":"))


def write(path, found):
    """Names follow that of their file."""
    lines, file = ["# What a run of this deck writes: see approved.py"], ""
    for name, feature in found.items():
        own, key = name.split(": ", 1)
        if own != file:
            lines.append(f"== {own}")
            file = own
        lines.append(f"{key}\t{text_of(feature)}")
    Path(path).write_text("\n".join(lines) + "\n", encoding="utf-8")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("results")
    parser.add_argument("log")
    parser.add_argument("approved")
    parser.add_argument("--write", nargs="*", metavar="OTHER")
    options = parser.parse_args()
    found = digest(options.results, options.log)
    if options.write is not None:
        other = digest(*options.write) if options.write else found
        for name in found:
            if name not in other or differences(rounded(found[name]), other[name]):
                found[name] = ["varies"]
        write(options.approved, found)
        return 0
    want = read(options.approved)
    faults = [f"{name}: is new" for name in found if name not in want]
    frames = any(name.startswith("vtk") for name in found)
    faults += [f"{name}: is gone" for name in want if name not in found and (frames or not name.startswith("vtk"))]
    for name in want:
        if name in found:
            text = differences(want[name], found[name])
            if text:
                faults.append(f"{name}: {text}")
    for fault in faults[:40]:
        print(fault)
    if faults:
        print(f"{len(faults)} differences from {options.approved}; where they are meant, tests/approved/update.sh writes it anew")
    return 1 if faults else 0


sys.exit(main())
