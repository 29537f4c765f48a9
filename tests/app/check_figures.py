#!/usr/bin/env python3
"""Looks at figures as a reader would: no curve leaves its axes, no axis dwarfs its data, every axis has
two numbers, no text stands on another, on a frame, under a legend or outside the drawing.

    check_figures.py FOLDER      every *.svg in it, and the drawings of the report beside it; a line
                                 for each fault, exit code 1 with any
"""
import pathlib
import re
import statistics
import sys
import xml.etree.ElementTree as ET

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


def box_of(text, size, anchor):
    """Bounding box of a <text>, px; capitals are 0.72 of the size high."""
    x, y = (float(text.get(k)) for k in ("x", "y"))
    w, h = width_of(text.text or "", size), 0.72 * size
    shift = {"middle": 0.5, "end": 1.0}.get(anchor, 0.0)
    if "rotate(-90" in text.get("transform", ""):
        return Box(x - h, y - (1 - shift) * w, x, y + shift * w)
    return Box(x - shift * w, y - h, x + (1 - shift) * w, y)


def texts_of(element, size=0.0, anchor="start", groups=()):
    """Every text with its box and the classes of the groups that it stands in; a group may set size and
    anchor for all its texts."""
    for child in element:
        own_size = float(child.get("font-size", size))
        own_anchor = child.get("text-anchor", anchor)
        if child.tag == "text":
            if child.text:
                yield child.text, box_of(child, own_size, own_anchor), groups
        elif child.tag == "g":
            yield from texts_of(child, own_size, own_anchor, groups + (child.get("class"),))


def points_of(path):
    """Corners of a path of M and L commands."""
    numbers = re.findall(r"-?\d+(?:\.\d+)?", re.sub(r"[hV]0|Z", "", path.get("d")))
    values = [float(n) for n in numbers]
    return list(zip(values[::2], values[1::2]))


def groups_of(element, name):
    return [g for g in element.iter("g") if g.get("class") == name]


def curves_of(axes):
    """Corners of every curve of some axes, but for rules and outlines."""
    for plot in groups_of(axes, "plot"):
        for path in plot.findall("path"):
            if path.get("data-s") is not None and path.get("data-quiet") is None:
                yield path, points_of(path)


def frame_of(axes):
    x, y, w, h = (float(v) for v in axes.get("data-box").split())
    return Box(x, y, x + w, y + h)


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
    drawing = any(g.get("data-s") for plot in groups_of(axes, "plot")
                  for g in plot.findall("g"))   # bodies, bars: the curves are not all there is
    sizes = [s for s in sizes if s > 0]
    if sizes and not log and not drawing and max(abs(low), abs(high)) > 1e6 * statistics.median(sizes):
        yield f"axis from {low} to {high}, data about {statistics.median(sizes)}"


def faults_of_ticks(axes):
    """Of plane axes; without numbers one does not know how long anything is."""
    kind = axes.get("data-kind")
    if kind == "space":
        room_for_two = 40   # px, along an axis that is not seen nearly end on
        counts = {f"axis {i}": len(list(texts_of(g))) for i, g in enumerate(groups_of(axes, "ts"))
                  if float(g.get("data-px")) > room_for_two}
    elif kind == "polar":
        counts = {"radius": len([t for g in groups_of(axes, "radii") for t in texts_of(g)])}
    else:
        counts = {g.get("class"): len(list(texts_of(g))) for g in axes
                  if g.get("class") in ("tx", "ty", "tr") and (g.get("class"), axes.get("data-hidex")) != ("tx", "1")
                  and axes.get("data-fixed") is None}
    for name, count in counts.items():
        if count < 2:
            yield f"{name} has {count} numbers"


def faults_of_pins(axes):
    """Names within a frame, which is where they are cut; two in a row are read as one."""
    frame = frame_of(axes)
    apart, same_row = 2, 4   # px
    for pins in groups_of(axes, "pins"):
        texts = list(texts_of(pins))
        for i, (text, box, _) in enumerate(texts):
            for other, o, _ in texts[i + 1:]:
                if (min(box.y1, o.y1) - max(box.y0, o.y0) > same_row and
                        min(box.x1, o.x1) - max(box.x0, o.x0) > -apart):
                    yield f"'{text}' and '{other}' run together"
            beyond = max(frame.x0 - box.x0, box.x1 - frame.x1, frame.y0 - box.y0, box.y1 - frame.y1)
            if beyond > 0.5:
                yield f"the frame cuts '{text}'"


def stretch_of(use):
    """What a narrow drawing does with a curve of the wide one: factors and offsets."""
    fx, _, _, fy, x, y = (float(v) for v in re.findall(r"-?[\d.]+(?:e-?\d+)?", use.get("transform")))
    return fx, fy, x, y


def rules_of(axes, plots):
    """Places of upright and of level rules, px; plots: those that narrow drawings repeat."""
    upright, level = [], []
    for plot in groups_of(axes, "plot"):
        fx, fy, dx, dy = 1.0, 1.0, 0.0, 0.0
        use = plot.find("use")
        if use is not None:
            fx, fy, dx, dy = stretch_of(use)
            plot = plots[use.get("href")[1:]]
        for path in plot.findall("path"):
            rule = re.fullmatch(r"M(-?[\d.]+) (-?[\d.]+)([VH])-?[\d.]+", path.get("d"))
            if rule and rule[3] == "V":
                upright.append(fx * float(rule[1]) + dx)
            elif rule:
                level.append(fy * float(rule[2]) + dy)
    return upright, level


def faults_of_rules(axes, plots):
    """A text that a rule crosses stands on paper."""
    upright, level = rules_of(axes, plots)
    for pin in groups_of(axes, "pin"):
        if pin.find("rect") is not None:
            continue
        for text, box, _ in texts_of(pin):
            if any(box.x0 + 1 < x < box.x1 - 1 for x in upright) or any(box.y0 + 1 < y < box.y1 - 1 for y in level):
                yield f"a rule crosses '{text}'"


def legends_of(root):
    for legend in groups_of(root, "legend"):
        x, y, w, h = (float(legend.find("rect").get(k)) for k in ("x", "y", "width", "height"))
        yield Box(x, y, x + w, y + h)


def faults_of_legends(root):
    """What a legend covers; the texts in it are its own."""
    for legend in legends_of(root):
        for text, box, groups in texts_of(root):
            if "legend" not in groups and box.overlaps(legend):
                yield f"a legend covers '{text}'"
        for axes in groups_of(root, "axes"):
            for plot in groups_of(axes, "plot"):
                for path in plot.iter("path"):
                    corners = points_of(path) if re.fullmatch(r"M[-\d. L]+Z", path.get("d")) else []
                    if len(corners) > 2:
                        xs, ys = [p for p, _ in corners], [q for _, q in corners]
                        if Box(min(xs), min(ys), max(xs), max(ys)).overlaps(legend):
                            yield f"a legend covers a body at {min(xs):.0f}, {min(ys):.0f}"


def faults_of_space(axes):
    left, right = (float(v) for v in axes.get("data-cell").split()[:2])
    for path in axes.iter("path"):
        if path.get("data-xyz") is not None:
            beyond = max((max(left - x, x - right) for x, _ in points_of(path)), default=0)
            if beyond > 1.5:
                yield f"curve {path.get('data-name')} leaves its axes by {beyond:.0f} px"


def faults_of_polar(axes):
    frame = frame_of(axes)
    x, y, radius = (frame.x0 + frame.x1) / 2, (frame.y0 + frame.y1) / 2, (frame.x1 - frame.x0) / 2
    for path, points in curves_of(axes):
        beyond = max((((p - x) ** 2 + (q - y) ** 2) ** 0.5 - radius for p, q in points), default=0)
        if beyond > 1.5:
            yield f"curve {path.get('data-name')} leaves its axes by {beyond:.0f} px"


def faults_of_texts(root):
    texts = [(text, box) for text, box, _ in texts_of(root)]
    width, height = (float(v) for v in root.get("viewBox").split()[2:])
    for i, (a, box) in enumerate(texts):
        if min(box.x0, box.y0, width - box.x1, height - box.y1) < -1:
            yield f"text leaves the figure: '{a}'"
        for b, other in texts[i + 1:]:
            if box.overlaps(other):
                yield f"texts overlap: '{a}' and '{b}'"


def faults_of(root, plots, alone):
    """alone: of a file, whose curves are all there and written in full."""
    of_curves = {"xy": faults_of_axes, "polar": faults_of_polar, "space": faults_of_space}
    for axes in groups_of(root, "axes"):
        kind = axes.get("data-kind")
        if alone:
            yield from of_curves[kind](axes)
        if kind == "xy":
            yield from faults_of_pins(axes)
            yield from faults_of_rules(axes, plots)
        yield from faults_of_ticks(axes)
    yield from faults_of_legends(root)
    yield from faults_of_texts(root)


def drawing_in(file):
    return ET.fromstring(file.read_text(encoding="utf-8").replace(' xmlns="http://www.w3.org/2000/svg"', ""))


def drawings_of_page(file):
    """Those for desks and for telephones, and the curves that these repeat, by their names."""
    drawings = [ET.fromstring(text) for text in
                re.findall(r'<svg class="figure.*?</svg>', file.read_text(encoding="utf-8"), re.DOTALL)]
    plots = {g.get("id"): g for root in drawings for g in groups_of(root, "plot") if g.get("id")}
    return drawings, plots


def faults_in(folder):
    for file in sorted(folder.glob("*.svg")):
        for fault in faults_of(drawing_in(file), {}, True):
            yield f"{file.name}: {fault}"
    report = folder.parent / "report.html"
    if not report.exists():
        return
    drawings, plots = drawings_of_page(report)
    for root in drawings:
        for fault in faults_of(root, plots, False):
            yield f"{root.get('id')}: {fault}"


def main():
    folder = pathlib.Path(sys.argv[1])
    if not any(folder.glob("*.svg")):
        print(f"no figures in {folder}")
        return 1
    faults = list(faults_in(folder))
    for fault in faults:
        print(fault)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
