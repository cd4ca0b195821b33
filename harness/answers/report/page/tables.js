// Sorting of tables by their headings; score tables are filtered by sequence and by method name.
(() => {
  "use strict";
  const R = window.R;
  const numberIn = (text) => {
    const found = /^[<>\s]*([-+]?[\d.]+(?:e[-+]?\d+)?)/i.exec(text);
    return found ? Number(found[1]) : NaN;
  };

  for (const table of document.querySelectorAll("table")) {
    const body = table.tBodies[0];
    [...table.tHead.rows[0].cells].forEach((heading, column) => {
      const button = document.createElement("button");
      button.type = "button";
      button.title = "sort";
      button.append(...heading.childNodes);
      heading.append(button);
      button.addEventListener("click", () => {
        const down = heading.getAttribute("aria-sort") === "ascending";
        for (const other of table.tHead.rows[0].cells) other.removeAttribute("aria-sort");
        heading.setAttribute("aria-sort", down ? "descending" : "ascending");
        const rows = [...body.rows].map((row) => {
          const text = row.cells[column] ? row.cells[column].textContent : "";
          return { row, text, number: numberIn(text) };
        });
        const numeric = rows.some((r) => Number.isFinite(r.number)) && column > 0;
        rows.sort((a, b) => {
          if (!numeric) return (down ? -1 : 1) * a.text.localeCompare(b.text, "en", { numeric: true });
          if (Number.isFinite(a.number) !== Number.isFinite(b.number)) return Number.isFinite(a.number) ? -1 : 1;
          return (down ? b.number - a.number : a.number - b.number) || 0;
        });
        body.append(...rows.map((r) => r.row));
      });
    });
  }

  const host = document.getElementById("table-controls");
  const label = (text, input) => {
    const out = document.createElement("label");
    out.className = "field";
    out.append(text, input);
    host.append(out);
  };
  const filter = document.createElement("input");
  filter.type = "search";
  filter.placeholder = `part of the name of a ${R.word}`;
  const all = document.createElement("input");
  all.type = "checkbox";
  label(`${R.word}s`, filter);
  label("all sequences", all);

  const tables = [...document.querySelectorAll("#scores figure.table")];
  const show = () => {
    const wanted = filter.value.trim().toLowerCase();
    for (const figure of tables) {
      figure.hidden = !all.checked && figure.dataset.sequence !== R.scores.sequences[R.state.sequence];
      for (const row of figure.querySelectorAll("tbody tr")) {
        row.hidden = wanted !== "" && !row.cells[0].textContent.toLowerCase().includes(wanted);
      }
    }
  };
  filter.addEventListener("input", show);
  all.addEventListener("change", show);
  R.follow(show);
})();
