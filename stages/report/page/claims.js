"use strict";
(() => {
  const list = document.getElementById("list");
  const pairs = JSON.parse(document.getElementById("pairs-data").textContent);
  const fields = [...document.querySelectorAll("#filters [data-key]")];
  const items = [...list.children].map((item) => ({ item, text: item.textContent.toLowerCase() }));
  document.getElementById("filters").hidden = false;

  function filter() {
    let count = 0;
    for (const { item, text } of items) {
      const fits = fields.every(({ dataset, value }) => !value
        || (dataset.key ? item.dataset[dataset.key].split(" ").includes(value) : text.includes(value.toLowerCase())));
      item.hidden = !fits;
      count += fits;
    }
    document.getElementById("found").textContent = `${count} of ${items.length} claims`;
  }

  // The pairs of a claim: a dot each on a line with its zero, and a table.
  function show(item) {
    const place = item.querySelector(".pairs"), found = pairs[item.id];
    if (!found || place.dataset.done) return;
    place.dataset.done = "yes";
    const values = found.map(([, value]) => value);
    const [low, high] = [Math.min(0, ...values), Math.max(0, ...values)];
    const at = (value) => 2 + (96 * (value - low)) / (high - low || 1);
    const dots = found.map(([name, value], k) =>
      `<circle cx="${at(value).toFixed(1)}%" cy="${9 + 7 * (k % 3)}" r="3.5"><title></title></circle>`).join("");
    const strip = document.createElement("div");
    strip.innerHTML = `<svg class="strip" width="100%" height="34" role="img" aria-label="Each pair, beside zero">
      <line x1="${at(0)}%" x2="${at(0)}%" y1="0" y2="32"/>${dots}</svg>`;
    strip.querySelectorAll("title").forEach((title, k) => { title.textContent = `${found[k][0]}: ${found[k][1]}`; });
    const table = document.createElement("table");
    table.createTHead().innerHTML = '<tr><th scope="col">pair</th><th scope="col" class="number"></th></tr>';
    table.tHead.rows[0].cells[1].textContent = `difference, ${place.dataset.unit}`;
    const body = table.createTBody();
    for (const [name, value] of found) {
      const row = body.insertRow();
      row.insertCell().textContent = name;
      row.insertCell().textContent = value;
      row.cells[1].className = "number";
    }
    const box = document.createElement("div");
    Object.assign(box, { className: "scroll tall", tabIndex: 0 });
    box.setAttribute("role", "region");
    box.setAttribute("aria-label", "Pairs");
    box.append(table);
    place.append(strip, box);
    window.site.enhance(box);
  }

  list.addEventListener("toggle", (event) => { if (event.target.open) show(event.target.closest("li")); }, true);
  for (const field of fields) field.addEventListener("input", filter);
  document.getElementById("filters").addEventListener("submit", (event) => event.preventDefault());
  // A link such as #chapter=T3&verdict=open sets the filters, a link to a claim opens the claim.
  function jump() {
    const wanted = new URLSearchParams(location.hash.slice(1));
    if (location.hash.includes("=")) {
      for (const field of fields) field.value = wanted.get(field.dataset.key) ?? "";
      filter();
      document.getElementById("filters").scrollIntoView();
      return;
    }
    const item = location.hash && document.getElementById(location.hash.slice(1));
    if (!item || !list.contains(item)) return;
    item.querySelector("details").open = true;
    item.scrollIntoView();
  }
  addEventListener("hashchange", jump);
  filter();
  jump();
})();
