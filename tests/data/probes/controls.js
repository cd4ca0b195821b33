// Reads the state of the page, operates its controls, and returns results in its title.
const said = [];
for (const fold of document.querySelectorAll("main > details")) fold.open = true;
R.changed();
for (const id of ["controls", "map", "space", "before", "after", "along-x", "along-a", "boxes",
                  "forest", "cut-map", "cut-strip", "sweep-figures", "pareto-here", "verdicts", "scores", "failures"]) {
  const box = document.getElementById(id).getBoundingClientRect();
  if (box.width < 100 || box.height < 40) said.push(id + " is not to be seen");
}
const count = (what) => document.querySelectorAll(what).length;
if (count("#map path.curve") < 2) said.push("no curves on the map");
if (count("#boxes circle") < 12) said.push("runs are missing");
if (count("script") !== 18 || count("b[onclick], main i") > 0) said.push("a name became markup");
const change = (element, value) => {
  element.value = value;
  element.dispatchEvent(new Event("change"));
};
if (count("#cut-strip rect[style*=fill]") < 1) said.push("no windows");
const repeat = [...document.querySelectorAll("#controls label")].find((l) => l.textContent.startsWith("Repeat"));
change(repeat.querySelector("select"), "2");
if (!document.querySelector("#map figcaption").textContent.includes("(repeat 2")) said.push("repeat: " + document.querySelector("#map figcaption").textContent);
change(repeat.querySelector("select"), "0");
const score = [...document.querySelectorAll("#controls label")].find((l) => l.textContent.startsWith("Score")).querySelector("select");
for (const kind of R.scores.kinds.keys()) {
  change(score, String(kind));
  const [answer, ...others] = document.querySelectorAll("#answer [data-comparison]:not([hidden])");
  const comparison = R.comparison(kind);
  const place = comparison && comparison.methods.length > 1 ? String(R.comparisons.indexOf(comparison)) : "";
  if (others.length || answer.dataset.comparison !== place) said.push("answer of score " + kind);
}
change(score, String(R.scores.kinds.findIndex((k) => k.metric === "ate" && k.times === "dense")));
change(document.querySelector("#controls select"), "1");
if (!document.querySelector("#map figcaption").textContent.endsWith(")b")) said.push("sequence: " + document.querySelector("#map figcaption").textContent);
const plane = [...document.querySelectorAll("#controls label")].find((l) => l.textContent.startsWith("Plane"));
change(plane.querySelector("select"), "xz");
if (!document.querySelector("#map figcaption").textContent.includes("x, z")) said.push("plane");
if (!document.querySelector("#space svg").textContent.includes("-y")) said.push("up");
change(plane.querySelector("select"), "");
for (const key of ["ArrowLeft", "ArrowUp", "+", "-", "0"]) {
  for (const id of ["map", "space"]) {
    document.querySelector(`#${id} svg`).dispatchEvent(
      new KeyboardEvent("keydown", { key, bubbles: true, cancelable: true }));
  }
}
document.querySelectorAll("#controls details button").forEach((b) => b.click());
document.querySelectorAll("#controls details button")[1].click();
if (count("#map path.curve") !== 4) said.push("all methods: " + count("#map path.curve"));
// The address contains the choices, so that a link shows the same.
const link = new URLSearchParams(location.hash.slice(1));
if (link.get("sequence") !== R.scores.sequences[1]) said.push("link: " + location.hash);
if (link.getAll("method").length !== R.methods.length) said.push("methods in the link: " + location.hash);
document.querySelectorAll("#controls details button")[0].click();
const few = R.bestFew();
if (few.join() !== R.shown().map((m) => m.place).sort((a, b) => few.indexOf(a) - few.indexOf(b)).join()) said.push("best few");
const comparison = R.comparison(R.state.kind);
const ranked = comparison.methods.map((m) => m.method).filter((m) => m !== comparison.baseline);
if (few.some((m, i) => i > 0 && R.methods[m].name !== ranked[i - 1])) said.push("best few are not the best");
document.querySelectorAll("#controls details button")[1].click();
const headings = [...document.querySelector("#scores thead tr").cells].map((c) => c.textContent);
if (!headings[1].startsWith("time")) said.push("columns: " + headings.join());
if (document.querySelector("#controls details").open) said.push("the list of methods is not folded");
const shown = [...document.querySelectorAll("#scores figure")].find((f) => !f.hidden);
const column = () => [...shown.querySelectorAll("tbody th")].map((c) => c.textContent);
const before = column();
shown.querySelector("thead button").click();
shown.querySelector("thead button").click();
if (column().join() === before.join()) said.push("tables do not sort");
const filter = document.querySelector("#table-controls input");
filter.value = "swept";
filter.dispatchEvent(new Event("input"));
if ([...shown.querySelectorAll("tbody tr")].filter((r) => !r.hidden).length !== 2) said.push("filter");
// A click on a name in the legend draws a method or not, in the table of the answer, too.
document.querySelectorAll("#controls details button")[2].click();
if (count("#map path.curve") !== 0) said.push("none: " + count("#map path.curve"));
const names = () => [...document.querySelectorAll("#map button.switch")];
if (names().length !== 4) said.push("names in the legend: " + names().length);
names()[0].click();
if (count("#map path.curve") !== 1 || names()[0].getAttribute("aria-pressed") !== "true") said.push("a click draws nothing");
const row = document.querySelector("#answer div:not([hidden]) tr[data-method] button.switch");
row.click();
row.click();
// What is under the pointer is named there and in the curves of errors.
document.querySelectorAll("#controls details button")[1].click();
const path = document.querySelector("#map path.curve").getBoundingClientRect();
const on = (x, y) => document.querySelector("#map svg").dispatchEvent(new PointerEvent("pointermove", { clientX: x, clientY: y, bubbles: true }));
on(path.left + 1, path.top + 1);
for (let x = path.left; !document.querySelector("#along-x svg text.halo") && x < path.right; x += 5) {
  for (let y = path.top; !document.querySelector("#along-x svg text.halo") && y < path.bottom; y += 20) on(x, y);
}
if (!/ m at /.test(document.querySelector("#along-x svg").textContent)) said.push("no value under the pointer");
// Every method of the comparison has a row; names of error against time cover no dot.
const table = document.querySelector("#answer [data-comparison]:not([hidden]) table");
if (table.tBodies[0].rows.length < comparison.methods.length) said.push("rows of the answer");
const labels = [...document.querySelectorAll("#pareto-all text.halo")];
const dots = [...document.querySelectorAll("#pareto-all circle")];
if (labels.length !== dots.length) said.push(`${labels.length} of ${dots.length} dots have a name`);
for (const label of labels) {
  const a = label.getBoundingClientRect();
  for (const dot of dots) {
    const b = dot.getBoundingClientRect();
    const [wide, high] = [Math.min(a.right, b.right) - Math.max(a.left, b.left), Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top)];
    if (wide > 2 && high > 4) said.push("a name covers a dot: " + label.textContent);
  }
}
document.title = "probed: " + (said.join("; ") || "well");
