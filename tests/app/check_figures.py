#!/usr/bin/env python3
"""Looks at figures as a reader would: no curve leaves its axes, no axis dwarfs its data, no two
texts overlap.

    check_figures.py FOLDER      every *.svg in it; a line for each fault, exit code 1 with any
"""
import pathlib
import re
import statistics
import sys
import xml.etree.ElementTree as ET

SVG = "{http://www.w3.org/2000/svg}"
# Helvetica, in thousandths of the size (Adobe's font metrics); what is not named counts as a digit
WIDTHS = {**dict.fromkeys("ijl'", 222), **dict.fromkeys("ftI .,:;/|!()[]-−", 280),
          **dict.fromkeys("rs", 400), **dict.fromkeys("ckvxyz", 500), **dict.fromkeys("ABCDEGHKNOPQRSTUVXY&w", 700),
          **dict.fromkeys("mMW%", 860)}


def width_of(text, size):
    """Between Helvetica and the wider fonts that stand for it where it is not there."""
    return 1.08 * sum(WIDTHS.get(c, 556) for c in text) * size / 1000


class Box:
    def __init__(self, x0, y0, x1, y1):
        self.x0, self.y0, self.x1, self.y1 = x0, y0, x1, y1

    def overlaps(self, o, by=1.0):
        return (min(self.x1, o.x1) - max(self.x0, o.x0) > by and
                min(self.y1, o.y1) - max(self.y0, o.y0) > by)


def box_of(text):
    """Bounding box of a <text>, px; capitals are 0.72 of the size high."""
    size, x, y = (float(text.get(k)) for k in ("font-size", "x", "y"))
    w, h = width_of(text.text or "", size), 0.72 * size
    shift = {"middle": 0.5, "end": 1.0}.get(text.get("text-anchor"), 0.0)
    if "rotate(-90" in text.get("transform", ""):
        return Box(x - h, y - (1 - shift) * w, x, y + shift * w)
    return Box(x - shift * w, y - h, x + (1 - shift) * w, y)


def points_of(path):
    """Corners of a path of M and L commands."""
    numbers = re.findall(r"-?\d+(?:\.\d+)?", re.sub(r"[hV]0|Z", "", path.get("d")))
    values = [float(n) for n in numbers]
    return list(zip(values[::2], values[1::2]))


def curves_of(axes):
    """Corners of every curve of some axes, but for rules and outlines."""
    for plot in axes.iter(SVG + "g"):
        if plot.get("class") == "plot":
            for path in plot.findall(SVG + "path"):
                if path.get("data-s") is not None and path.get("data-quiet") is None:
                    yield path, points_of(path)


def faults_of_axes(axes):
    x, y, w, h = (float(v) for v in axes.get("data-box").split())
    slack = 1.5
    low, high, log = (float(v) for v in axes.get("data-y").split())
    sizes = []
    for path, points in curves_of(axes):
        beyond = max((max(x - p, p - x - w, y - q, q - y - h) for p, q in points), default=0)
        if beyond > slack:
            yield f"curve {path.get('data-name') or path.get('data-s')} leaves its axes by {beyond:.0f} px"
        if path.get("data-right") is None:
            sizes += [abs(high - (q - y) / h * (high - low)) for p, q in points]
    drawing = any(g.get("data-s") for plot in axes.iter(SVG + "g") if plot.get("class") == "plot"
                  for g in plot.findall(SVG + "g"))   # bodies, bars: the curves are not all there is
    sizes = [s for s in sizes if s > 0]
    if sizes and not log and not drawing and max(abs(low), abs(high)) > 1e6 * statistics.median(sizes):
        yield f"axis from {low} to {high}, data about {statistics.median(sizes)}"


def faults_of_texts(root):
    texts = [(t.text, box_of(t)) for t in root.iter(SVG + "text") if t.text]
    width, height = (float(v) for v in root.get("viewBox").split()[2:])
    for i, (a, box) in enumerate(texts):
        if min(box.x0, box.y0, width - box.x1, height - box.y1) < -1:
            yield f"text leaves the figure: '{a}'"
        for b, other in texts[i + 1:]:
            if box.overlaps(other):
                yield f"texts overlap: '{a}' and '{b}'"


def faults_of(file):
    root = ET.parse(file).getroot()
    for axes in root.iter(SVG + "g"):
        if axes.get("class") == "axes" and axes.get("data-kind") == "xy":
            yield from faults_of_axes(axes)
    yield from faults_of_texts(root)


def main():
    files = sorted(pathlib.Path(sys.argv[1]).glob("*.svg"))
    if not files:
        print(f"no figures in {sys.argv[1]}")
        return 1
    count = 0
    for file in files:
        for fault in faults_of(file):
            print(f"{file.name}: {fault}")
            count += 1
    return 1 if count else 0


if __name__ == "__main__":
    sys.exit(main())
