// Reports in its title what does not fit the window.
const said = [];
const wide = document.documentElement.clientWidth;
if (wide >= 1200 && document.documentElement.scrollHeight > 6000) said.push("higher than 6000 pixels");
const charts = [...document.querySelectorAll("#answer .bar svg, #map > svg")].map((chart) => chart.getBoundingClientRect());
const first = charts.find((box) => box.width > 0);
if (!first || first.width < 60 || first.bottom > innerHeight) said.push("no chart on the first screen");
for (const table of document.querySelectorAll("#answer table")) {
  const headings = [...table.tHead.rows[0].cells];
  const columns = headings.reduce((sum, heading) => sum + heading.colSpan, 0);
  const changes = headings.filter((heading) => heading.textContent.startsWith("change")).length;
  if (columns !== table.tBodies[0].rows[0].cells.length || changes !== 1) said.push("headings of the answer");
}
for (const fold of document.querySelectorAll("main > details")) fold.open = true;
R.changed();
if (document.documentElement.scrollWidth > wide) said.push("page wider than the window: " + document.documentElement.scrollWidth);
for (const chart of document.querySelectorAll("figure > svg")) {
  const box = chart.getBoundingClientRect();
  if (box.width > 0 && (box.right > wide || box.left < 0)) said.push("chart outside: " + chart.getAttribute("aria-label"));
}
for (const box of document.querySelectorAll(".scroll")) {
  const style = getComputedStyle(box);
  const isShown = style.overflowX === "auto" && style.backgroundImage.includes("gradient");
  if (box.scrollWidth > box.clientWidth && !isShown) said.push("no sign of more columns: " + box.getAttribute("aria-label"));
}
if (wide >= 1200) {
  for (const heading of document.querySelectorAll("#scores figure:not([hidden]) thead th")) {
    const isWanted = /^(gain|time)/.test(heading.textContent);
    if (isWanted && heading.getBoundingClientRect().right > wide) said.push("hidden column " + heading.textContent);
  }
}
for (const figure of document.querySelectorAll("#sweep-figures figure")) {
  const [chart, text] = [figure.querySelector("svg"), figure.querySelector("svg text")];
  const size = parseFloat(getComputedStyle(text).fontSize) * chart.getBoundingClientRect().width / chart.viewBox.baseVal.width;
  if (size < 8 || size > 16) said.push("text of " + size + " px");
}
if (document.querySelectorAll("#sweep-figures rect[style*=fill]").length !== 4) said.push("no heat map");
if (document.querySelectorAll("#sweep-figures path.curve").length !== 1) said.push("no curve");
if (document.querySelectorAll("#closures-map .loop").length < 1) said.push("no closures on their map");
const ledger = [...document.querySelectorAll("#closures-rows tbody tr")].map((row) => row.cells[3].textContent);
if (ledger.length < 1 || ledger.some((loop) => !/^[0-9.]+$/.test(loop))) said.push("lengths of loops: " + ledger);
const sentence = document.getElementById("closures-verdict").textContent;
if (!/places?\b|closures? (agree|contradict)/.test(sentence) || /undefined/.test(sentence)) said.push("verdict: " + sentence);
const dark = matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light";
const option = document.querySelector("#controls select").selectedOptions[0].textContent;
document.title = `${wide} ${dark} ${option}: ` + (said.join("; ") || "well");
if (parent !== window) parent.postMessage(document.title, "*");
