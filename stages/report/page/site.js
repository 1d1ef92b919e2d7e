"use strict";
// Tables that sort and filter, and charts whose values can be read with pointer or keyboard. The page is whole without it.
window.site = (() => {
  const LONG = 8;  // rows from which a table gets a filter
  const number = (text) => {
    const found = text.replaceAll(",", "").replace("−", "-").match(/^[^\d+-]{0,2}([+-]?\d+(?:\.\d+)?(?:e[+-]?\d+)?)/);
    return found ? Number(found[1]) : NaN;
  };
  const compare = (a, b) => {
    const [x, y] = [number(a), number(b)];
    if (Number.isNaN(x) || Number.isNaN(y)) return Number.isNaN(x) - Number.isNaN(y) || a.localeCompare(b, "en", { numeric: true });
    return x - y;
  };

  function sort(table, column) {
    const head = table.tHead.rows[0].cells[column], body = table.tBodies[0];
    const down = head.getAttribute("aria-sort") === "ascending";
    for (const cell of table.tHead.rows[0].cells) cell.removeAttribute("aria-sort");
    head.setAttribute("aria-sort", down ? "descending" : "ascending");
    const text = (row) => row.cells[column].textContent.trim();
    const empty = (row) => ["", "–"].includes(text(row));
    const order = (a, b) => empty(a) - empty(b) || (down ? -1 : 1) * compare(text(a), text(b));  // gaps stay below
    body.append(...[...body.rows].sort(order));
  }

  function enhance(box) {
    const table = box.querySelector("table"), rows = [...table.tBodies[0].rows];
    if (rows.length < 2) return;
    [...table.tHead.rows[0].cells].forEach((cell, column) => {
      const button = document.createElement("button");
      button.type = "button";
      button.append(...cell.childNodes);
      button.addEventListener("click", () => sort(table, column));
      cell.append(button);
    });
    if (rows.length < LONG) return;
    const label = document.createElement("label"), field = document.createElement("input"), said = document.createElement("span");
    label.className = "filter";
    field.type = "search";
    said.setAttribute("role", "status");
    label.append("Filter ", field, " ", said);
    box.before(label);
    field.addEventListener("input", () => {
      const words = field.value.toLowerCase().split(/\s+/);
      for (const row of rows) {
        const text = row.textContent.toLowerCase();
        row.hidden = !words.every((word) => text.includes(word));
      }
      said.textContent = field.value ? `${rows.filter((row) => !row.hidden).length} of ${rows.length} rows` : "";
    });
  }

  const tip = document.createElement("div");
  tip.id = "tip";
  tip.setAttribute("role", "status");
  document.body.append(tip);
  let shown = null;
  function point(circle) {
    if (shown) shown.classList.remove("on");
    shown = circle;
    tip.classList.toggle("on", Boolean(circle));
    if (!circle) return;
    circle.classList.add("on");
    tip.textContent = circle.dataset.text;
    const at = circle.getBoundingClientRect(), size = tip.getBoundingClientRect();
    const left = Math.max(4, Math.min(at.x + at.width / 2 - size.width / 2, innerWidth - size.width - 4));
    tip.style.left = `${left}px`;
    tip.style.top = `${at.y > size.height + 12 ? at.y - size.height - 6 : at.bottom + 6}px`;
  }

  function readable(chart) {
    const hits = [...chart.querySelectorAll(".hits circle")];
    for (const hit of hits) {
      hit.dataset.text = hit.firstChild.textContent;
      hit.firstChild.remove();  // the browser's own tip would cover ours
      hit.addEventListener("pointerenter", () => point(hit));
      hit.addEventListener("pointerleave", () => point(null));
    }
    const box = chart.closest("[tabindex]");
    if (!hits.length || !box) return;
    box.setAttribute("aria-label", `${box.getAttribute("aria-label")}: the arrow keys read its values`);
    box.addEventListener("keydown", (event) => {
      const step = { ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1 }[event.key];
      if (step) point(hits.at((hits.indexOf(shown) + (shown || step > 0 ? step : 0)) % hits.length));
      else if (event.key === "Escape") point(null);
      else return;
      event.preventDefault();
    });
    box.addEventListener("blur", () => point(null));
  }

  document.querySelectorAll(".scroll").forEach(enhance);
  document.querySelectorAll("svg.chart").forEach(readable);
  addEventListener("scroll", () => point(null), { passive: true });
  const opened = () => {  // a link to what is folded unfolds it
    const target = location.hash && document.getElementById(location.hash.slice(1));
    for (let fold = target && target.closest("details:not([open])"); fold; fold = fold.parentElement.closest("details:not([open])")) {
      fold.open = true;
      target.scrollIntoView();
    }
  };
  addEventListener("hashchange", opened);
  opened();
  return { enhance };
})();
