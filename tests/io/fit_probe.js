// Looks at the report as it stands in the window and leaves "ok", or what does not fit, in <pre id="probe">.
window.addEventListener("load", () => {
  const wrong = [...window.faults];
  const check = (ok, what) => { if (!ok) wrong.push(what); };
  check(innerWidth === window.wanted, "the window is " + innerWidth + " px wide");
  const page = document.documentElement;
  check(page.scrollWidth <= innerWidth, "the page is " + page.scrollWidth + " px wide");
  const seen = (e) => e.getClientRects().length > 0;
  for (const figure of document.querySelectorAll("figure")) {
    const drawings = [...figure.querySelectorAll("svg.figure")].filter(seen);
    check(drawings.length === 1, figure.id + " shows " + drawings.length + " drawings");
    check(figure.scrollWidth <= figure.clientWidth, figure.id + " is " + figure.scrollWidth + " px wide in " + figure.clientWidth);
    check(["visible", "hidden", "clip"].includes(getComputedStyle(figure).overflowX), figure.id + " scrolls");
    const box = drawings[0].getBoundingClientRect();
    check(box.left >= 0 && box.right <= innerWidth, figure.id + " leaves the window");
    const scale = box.width / drawings[0].viewBox.baseVal.width;
    for (const text of drawings[0].querySelectorAll("text")) {
      const size = parseFloat(getComputedStyle(text).fontSize) * scale, t = text.getBoundingClientRect();
      check(size > 7.4, figure.id + ": '" + text.textContent + "' is " + size.toFixed(1) + " px high");
      const out = Math.max(box.left - t.left, t.right - box.right, box.top - t.top, t.bottom - box.bottom);
      check(out < 2, figure.id + ": '" + text.textContent + "' leaves the figure by " + out.toFixed(0) + " px");
    }
    const texts = [...drawings[0].querySelectorAll("text")].map((e) => [e.textContent, e.getBoundingClientRect()]);
    texts.forEach(([a, p], i) => texts.slice(i + 1).forEach(([b, q]) => {
      // a line is higher than its letters
      const by = Math.min(p.right, q.right) - Math.max(p.left, q.left), high = Math.min(p.bottom, q.bottom) - Math.max(p.top, q.top);
      check(by <= 1 || high <= 5, figure.id + ": '" + a + "' stands on '" + b + "'");
    }));
    // what a curve covers is within its axes
    for (const axes of drawings[0].querySelectorAll("g.axes[data-kind=xy]")) {
      const frame = axes.querySelector("rect.frame").getBoundingClientRect();
      for (const path of axes.querySelectorAll(".plot > path[data-s]:not([data-quiet])")) {
        const p = path.getBoundingClientRect(), all = p.right < frame.left || p.left > frame.right || p.bottom < frame.top || p.top > frame.bottom;
        check(!all || !path.getAttribute("d"), figure.id + ": a curve stands outside its frame");
      }
    }
  }
  // on a telephone no table is moved sideways within its box, and each value of one has the name of its column
  for (const folded of document.querySelectorAll("details")) folded.open = true;
  for (const table of innerWidth > 600 ? [] : document.querySelectorAll("table")) {
    const box = table.parentElement, name = table.caption?.textContent ?? table.textContent.slice(0, 40);
    check(box.scrollWidth <= box.clientWidth, "table '" + name + "' is " + box.scrollWidth + " px wide in " + box.clientWidth);
    if (table.tHead && !seen(table.tHead))
      for (const row of table.tBodies[0].rows)
        [...row.cells].filter((cell) => seen(cell) && cell.colSpan === 1).forEach((cell) => {
          const title = table.tHead.rows[0].cells[cell.cellIndex], unit = title.querySelector("small")?.textContent ?? "";
          const said = getComputedStyle(cell, "::before").content, text = title.firstChild?.nodeType === 3 ? title.firstChild.data : "";
          const wanted = text + (unit ? ", " + unit : "");
          check(said === JSON.stringify(wanted) || (!wanted && said === '""'), "'" + cell.textContent + "' of '" + name + "' is called " + said);
        });
  }
  const out = document.createElement("pre");
  out.id = "probe";
  out.textContent = wrong.length ? wrong.join("\n") : "ok";
  document.body.append(out);
});
