/* Order of the overview, sorting and filtering of the table of runs. Without this script both stand as they were made. */
(() => {
  "use strict";
  const order = document.getElementById("dots-order");
  if (order) {
    const list = document.querySelector("#dots ol");
    const walls = [...list.children];
    const sortings = {
      place: (a, b) => a.dataset.place - b.dataset.place,
      spread: (a, b) => b.dataset.spread - a.dataset.spread || a.dataset.place - b.dataset.place,
      name: (a, b) => a.firstElementChild.textContent.localeCompare(b.firstElementChild.textContent),
    };
    order.hidden = false;
    order.addEventListener("change", (event) => list.append(...walls.sort(sortings[event.target.value])));
  }
  const table = document.getElementById("runs-table");
  if (!table) return;
  const body = table.tBodies[0];
  const rows = [...body.rows];
  const original = new Map(rows.map((row, index) => [row, index]));

  const valueOf = (row, column) => {
    const cell = row.cells[column];
    if (cell.dataset.sort !== undefined) return cell.dataset.sort === "" ? null : Number(cell.dataset.sort);
    return cell.textContent.trim().toLowerCase();
  };
  const compare = (a, b) => (typeof a === "number" && typeof b === "number" ? a - b : String(a).localeCompare(String(b)));

  table.querySelectorAll("thead th").forEach((head, column) => {
    const button = head.querySelector("button");
    if (!button) return;
    button.addEventListener("click", () => {
      const before = head.getAttribute("aria-sort");
      const way = before === "ascending" ? "descending" : before === "descending" ? "none" : "ascending";
      table.querySelectorAll("thead th[aria-sort]").forEach((other) => other.removeAttribute("aria-sort"));
      if (way !== "none") head.setAttribute("aria-sort", way);
      const sign = way === "descending" ? -1 : 1;
      const sorted = [...rows].sort((first, second) => {
        if (way === "none") return original.get(first) - original.get(second);
        const [a, b] = [valueOf(first, column), valueOf(second, column)];
        if (a === null || b === null) return (a === null) - (b === null);
        return sign * compare(a, b) || original.get(first) - original.get(second);
      });
      body.append(...sorted);
    });
  });

  const form = document.getElementById("runs-filter");
  const count = document.getElementById("runs-count");
  const apply = () => {
    const words = form.elements.words.value.trim().toLowerCase().split(/\s+/).filter(Boolean);
    const method = form.elements.method.value;
    const which = form.elements.which.value;
    let shown = 0;
    for (const row of rows) {
      const text = row.textContent.toLowerCase();
      const fits = words.every((word) => text.includes(word))
        && (!method || row.dataset.method === method)
        && (which === "all" || row.dataset.trouble === "yes");
      row.hidden = !fits;
      shown += fits ? 1 : 0;
    }
    count.textContent = shown === rows.length ? `${rows.length} runs` : `${shown} of ${rows.length} runs`;
  };
  form.hidden = false;
  form.addEventListener("input", apply);
  form.addEventListener("submit", (event) => event.preventDefault());
  form.addEventListener("reset", () => setTimeout(apply, 0));
  apply();
})();
