// Names and roles for a screen reader, which the theme, the gallery and long signatures lack, and links to whole pictures.
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
addEventListener("load", () => {
  for (const picture of document.querySelectorAll("figure img, img:is(.sphx-glr-single-img, .sphx-glr-multi-img)"))
    if (picture.naturalWidth > 1.3 * picture.clientWidth && !picture.closest("a")) {
      const link = document.createElement("a"); // its letters may be too small to read here
      link.href = picture.src;
      picture.replaceWith(link);
      link.append(picture);
    }
});
