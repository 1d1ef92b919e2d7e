"use strict";
// Tables that sort and filter. The page is whole without it.
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

  document.querySelectorAll(".scroll").forEach(enhance);
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
