// Names and roles for a screen reader, which the theme, the gallery and long signatures lack.
addEventListener("DOMContentLoaded", () => {
  for (const toggle of document.querySelectorAll("summary:has(.toctree-toggle)"))
    toggle.setAttribute("aria-label", `Pages of ${toggle.closest("li").querySelector("a").textContent.trim()}`);
  for (const link of document.querySelectorAll(".sphx-glr-thumbcontainer a.reference"))
    link.setAttribute("aria-label", link.textContent);
  for (const list of document.querySelectorAll("dt.sig > dl"))
    list.insertAdjacentHTML("afterbegin", '<dt class="visually-hidden">Parameters</dt>');
  for (const formula of document.querySelectorAll("div.math"))
    if (formula.scrollWidth > formula.clientWidth) formula.tabIndex = 0; // so that the keyboard scrolls it
});
