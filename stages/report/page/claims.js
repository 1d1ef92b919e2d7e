"use strict";
(() => {
  const list = document.getElementById("list");
  const chapters = [...list.children];
  const fields = [...document.querySelectorAll("#filters [data-key]")];
  const items = [...list.querySelectorAll("li")].map((item) => ({ item, text: item.textContent.toLowerCase() }));
  document.getElementById("filters").hidden = false;

  function filter() {
    let count = 0;
    for (const { item, text } of items) {
      const fits = fields.every(({ dataset, value }) => !value
        || (dataset.key ? item.dataset[dataset.key] === value : text.includes(value.toLowerCase())));
      item.hidden = !fits;
      count += fits;
    }
    const asked = fields.some(({ value }) => value);
    for (const chapter of chapters) {
      chapter.hidden = !chapter.querySelector("li:not([hidden])");
      if (asked) chapter.open = true;
    }
    document.getElementById("found").textContent = `${count} of ${items.length} claims`;
  }

  for (const field of fields) field.addEventListener("input", filter);
  document.getElementById("filters").addEventListener("submit", (event) => event.preventDefault());
  // A link such as #verdict=open sets the filters, a link to a claim opens it.
  function jump() {
    const wanted = new URLSearchParams(location.hash.slice(1));
    if (location.hash.includes("=")) {
      for (const field of fields) field.value = wanted.get(field.dataset.key) ?? "";
      filter();
      return;
    }
    const item = location.hash && document.getElementById(decodeURIComponent(location.hash.slice(1)));
    if (!item || !list.contains(item)) return;
    item.closest("#list > details").open = true;
    item.querySelector("details").open = true;
    item.scrollIntoView();
  }
  addEventListener("hashchange", jump);
  filter();
  jump();
})();
