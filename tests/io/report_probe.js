// Uses the report as a reader would and leaves "ok", or what went wrong, in <pre id="probe">. Expected numbers come from gallery.hpp.
// When the pictures in it are there.
window.addEventListener("load", () => {
  const wrong = [...window.faults];
  const check = (ok, what) => { if (!ok) wrong.push(what); };
  // Of the two drawings of a figure, and of what belongs to them, the one that is seen.
  const seen = (root, what) => [...root.querySelectorAll(what)].find((e) => e.getClientRects().length);
  const svg = (id) => seen(document.getElementById(id), "svg.figure");
  const readout = document.getElementById("readout");
  const at = (s, x, y) => { const m = s.getScreenCTM(); return { clientX: m.a * x + m.e, clientY: m.d * y + m.f }; };
  const fire = (s, type, x, y, more = {}) => s.dispatchEvent(new PointerEvent(type, { bubbles: true, cancelable: true, pointerId: 1, button: 0, ...at(s, x, y), ...more }));
  const text = () => (readout.style.display === "none" ? "" : readout.innerText);
  const value = (label) => { const m = text().replace(/−/g, "-").match(new RegExp(label + "[^\\d-]*(-?[\\d.]+)")); return m ? +m[1] : NaN; };
  // px of a value on plane axes
  const place = (id, vx, vy, k = 0) => {
    const g = svg(id).querySelectorAll("g.axes")[k], [bx, by, bw, bh] = g.dataset.box.split(" ").map(Number);
    const f = (d, v) => { const [lo, hi, log] = d.split(" ").map(Number); return log ? Math.log(v / lo) / Math.log(hi / lo) : (v - lo) / (hi - lo); };
    return [bx + bw * f(g.dataset.x, vx), by + bh * (1 - f(g.dataset.y, vy))];
  };
  SVGElement.prototype.setPointerCapture = () => {};   // there is no real pointer

  // Readout: the torsional line of the Campbell diagram, 1010 rad/s at any speed, log decrement 0.02.
  svg("campbell").scrollIntoView();
  fire(svg("campbell"), "pointermove", ...place("campbell", 9000, 1010 / (2 * Math.PI)));
  check(Math.abs(value("natural frequency") - 1010 / (2 * Math.PI)) < 0.05, "Campbell frequency: " + text());
  check(Math.abs(value("log decrement") - 0.02) < 1e-9, "Campbell log decrement: " + text());
  check(text().includes("torsion 1"), "Campbell name: " + text());

  // A polar plot and a map answer too.
  svg("spectrogram").scrollIntoView();
  fire(svg("spectrogram"), "pointermove", ...place("spectrogram", 12000, 485 / (2 * Math.PI)));
  check(value("0-peak") > 30, "map: " + text());
  svg("study").scrollIntoView();
  fire(svg("study"), "pointermove", ...place("study", 0.02, 0.02));
  check(Math.abs(value("run time \\(CPU\\)") - 0.02) < 1e-4 && text().includes("step 1.0"), "study: " + text());

  // Wheel: nothing before the figure is clicked, then closer, with new ticks on all axes that share x.
  const h = svg("history");
  h.scrollIntoView();
  const ticks = () => [...h.querySelectorAll(".tx")].map((g) => g.textContent).join("|");
  const before = ticks(), [hx, hy] = place("history", 2.4, 0);
  const wheel = () => h.dispatchEvent(new WheelEvent("wheel", { bubbles: true, cancelable: true, deltaY: -600, ...at(h, hx, hy) }));
  wheel();
  check(ticks() === before, "the wheel zoomed unasked");
  fire(h, "pointerdown", hx, hy), fire(h, "pointerup", hx, hy);
  wheel();
  check(ticks() !== before, "the wheel did not zoom");
  const moved = [...h.querySelectorAll(".plot")].map((g) => g.getAttribute("transform")?.split(" ")[0]);
  check(moved.length === 3 && new Set(moved).size === 1 && moved[0], "shared x: " + moved);
  fire(h, "pointermove", ...place("history", 2.4, 0));
  check(Math.abs(value("time") - 2.4) < 0.05, "readout under zoom: " + text());
  h.dispatchEvent(new MouseEvent("dblclick", { bubbles: true }));
  check(ticks() === before, "double click did not reset: " + ticks());

  // Legend: the phase follows the amplitude.
  const entry = svg("bode").querySelector(".entry[data-s='0']"), hidden = () => [...svg("bode").querySelectorAll("path[data-s='0']")].filter((p) => getComputedStyle(p).display === "none").length;
  entry.dispatchEvent(new MouseEvent("click", { bubbles: true }));
  check(hidden() === 2, "legend hides " + hidden());
  entry.dispatchEvent(new MouseEvent("click", { bubbles: true }));
  check(hidden() === 0, "legend shows again");

  // A figure in space turns, and reads x, y, z.
  const s = svg("space"), path = s.querySelector("path[data-xyz]"), d0 = path.getAttribute("d"), box = s.querySelector("g.axes").dataset.box.split(" ").map(Number);
  s.scrollIntoView();
  const c = [box[0] + box[2] / 2, box[1] + box[3] / 2];
  s.dispatchEvent(new MouseEvent("dblclick", { bubbles: true }));
  const same = (a, b) => { const n = (t) => t.match(/-?[\d.]+/g).map(Number); const x = n(a), y = n(b); return x.length === y.length && x.every((v, i) => Math.abs(v - y[i]) < 0.35); };
  check(same(d0, path.getAttribute("d")), "the script projects otherwise than the renderer");
  fire(s, "pointerdown", ...c), fire(s, "pointermove", c[0] + 80, c[1] + 20), fire(s, "pointerup", c[0] + 80, c[1] + 20);
  check(!same(d0, path.getAttribute("d")), "it does not turn");
  s.dispatchEvent(new MouseEvent("dblclick", { bubbles: true }));
  check(same(d0, path.getAttribute("d")), "it does not turn back");

  // A shape moves: half a cycle on, the deflection is the other way round; reset brings it back.
  const button = (id) => seen(svg(id).closest("figure"), "[data-do=play]");
  const shape = window.whirlFigures.find((f) => f.svg === svg("machine_shape")), shaft = svg("machine_shape").querySelector("path[data-name=rotor]");
  check(button("machine_shape") && button("mode") && !button("bode"), "play buttons");
  const home = shaft.getAttribute("d");
  shape.axes[0].setPhase(Math.PI);
  const turned = shaft.getAttribute("d");
  check(!same(home, turned), "the shape does not move");
  shape.axes[0].setPhase(2 * Math.PI);
  check(same(home, shaft.getAttribute("d")), "a cycle does not end where it began");
  shape.axes[0].setPhase(Math.PI);
  shape.reset();
  check(same(home, shaft.getAttribute("d")), "reset leaves the shape in motion");

  // A replay: it shows what was drawn, the slider sets moment and orbit.
  const run = svg("replay").closest("figure"), slider = seen(run, "input[type=range]"), said = () => seen(run, "output").textContent;
  check(slider && slider.value === "9" && button("replay"), "replay has its slider");
  check(said() === "4.5 s, 6000 rpm, largest 100 µm", "replay says: " + said());
  const rod = svg("replay").querySelector("path[data-name=rod]"), last = rod.getAttribute("d");
  slider.value = "0";
  slider.dispatchEvent(new Event("input"));
  check(said() === "0 s, 600 rpm, largest 10 µm", "replay at its start says: " + said());
  check(!same(last, rod.getAttribute("d")), "the slider moves nothing");
  slider.value = "9";
  slider.dispatchEvent(new Event("input"));
  check(same(last, rod.getAttribute("d")), "the slider does not bring the moment back");

  const out = document.createElement("pre");
  out.id = "probe";
  out.textContent = wrong.length ? wrong.join("\n") : "ok";
  document.body.append(out);
});
