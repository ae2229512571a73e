"use strict";
const all = (selector, root = document) => [...root.querySelectorAll(selector)];
const tip = document.getElementById("tip");
const body = document.body;
body.dataset.shown = "largest";

// The browser's own bubble would lie over ours.
for (const point of all(".point")) point.querySelector("title").remove();

function tell(point) {
  tip.textContent = point.getAttribute("aria-label");
  tip.hidden = false;
  const at = point.getBoundingClientRect();
  const size = tip.getBoundingClientRect();
  const width = document.documentElement.clientWidth;
  let left = at.right + 10;
  if (left + size.width > width - 8) left = Math.max(8, at.left - 10 - size.width);
  tip.style.left = left + scrollX + "px";
  tip.style.top = Math.max(8, at.top + at.height / 2 - size.height / 2) + scrollY + "px";
}
const hush = () => { tip.hidden = true; };

function choose(index) {
  for (const one of all(".detail")) one.hidden = one.dataset.index !== index;
  for (const one of all(".point, tbody tr")) one.classList.toggle("chosen", one.dataset.index === index);
}

for (const point of all(".point")) {
  point.addEventListener("pointerenter", () => tell(point));
  point.addEventListener("pointerleave", hush);
  point.addEventListener("focus", () => tell(point));
  point.addEventListener("blur", hush);
  point.addEventListener("click", () => choose(point.dataset.index));
  point.addEventListener("keydown", (event) => {
    if (event.key === "Enter" || event.key === " ") { event.preventDefault(); choose(point.dataset.index); }
    if (event.key === "Escape") hush();
  });
}
for (const row of all("tbody tr")) row.addEventListener("click", () => choose(row.dataset.index));
for (const link of all(".answer .link")) link.addEventListener("click", () => choose(link.dataset.index));
for (const one of all(".detail:not([hidden])")) choose(one.dataset.index);

for (const input of all(".switch input")) {
  input.addEventListener("change", () => {
    hush();
    body.dataset.shown = input.value;
    for (const view of all(".view")) view.hidden = view.dataset.figure !== input.value;
  });
}
// A browser that comes back to the page may remember another one.
all(".switch input:checked").forEach((input) => input.dispatchEvent(new Event("change")));

all("thead th").forEach((heading, column) => {
  heading.addEventListener("click", () => {
    const downward = heading.getAttribute("aria-sort") === "ascending";
    for (const one of all("thead th")) one.setAttribute("aria-sort", "none");
    heading.setAttribute("aria-sort", downward ? "descending" : "ascending");
    const value = (row) => row.children[column].dataset.value;
    const order = (a, b) => {
      const [x, y] = [value(a), value(b)];
      const numbers = [Number(x.replace("inf", "Infinity")), Number(y.replace("inf", "Infinity"))];
      return numbers.some(Number.isNaN) ? x.localeCompare(y) : numbers[0] - numbers[1];
    };
    const rows = all("tbody tr").sort((a, b) => (downward ? -1 : 1) * order(a, b));
    document.querySelector("tbody").append(...rows);
  });
});
