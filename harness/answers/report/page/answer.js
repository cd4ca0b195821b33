// The verdict of the selected score, with a switch, a bar and an interval for each method.
(() => {
  "use strict";
  const R = window.R;
  const answers = [...document.querySelectorAll("#answer [data-comparison]")];
  const kWidth = 130, kHeight = 18;

  // `change` [%] and its interval (of ratios).
  const bar = (row, change, interval, x, color) => {
    const svg = d3.select(row.insertCell(2)).attr("class", "bar").append("svg").attr("viewBox", `0 0 ${kWidth} ${kHeight}`)
      .attr("role", "img").attr("aria-label", change === null ? "no change known" : `${R.number(change)} %`);
    svg.append("line").attr("class", "zero").attr("x1", x(0)).attr("x2", x(0)).attr("y2", kHeight);
    if (change === null) return;
    svg.append("rect").attr("x", Math.min(x(0), x(change))).attr("width", Math.abs(x(change) - x(0))).attr("y", 3).attr("height", kHeight - 6)
      .style("fill", color).style("fill-opacity", 0.6);
    if (!interval) return;
    const [from, to] = interval.map((v) => x(100 * (v - 1)));
    svg.append("path").attr("d", `M${from},${kHeight / 2}H${to}M${from},5v8M${to},5v8`).style("stroke", "var(--ink)").style("stroke-width", 1.6);
  };

  // Names become switches; rows of methods that are not drawn stay.
  const rows = [...document.querySelectorAll("#answer tr[data-method]")]
    .map((row) => ({ row, m: R.methods.find((each) => each.name === row.dataset.method) })).filter(({ m }) => m);
  const isDrawn = (m) => R.scores.sequences.some((_, s) => R.trace(s, m.place));
  R.comparisons.forEach((comparison, i) => {
    const table = document.querySelector(`#answer [data-comparison="${i}"] table`);
    if (!table) return;
    const ends = comparison.methods.flatMap((m) => [m.ratio, ...(m.interval || [])]).filter((v) => v !== null).map((v) => 100 * (v - 1));
    const x = d3.scaleLinear(d3.extent(ends.concat(0)), [3, kWidth - 3]);
    table.tHead.rows[0].cells[2].colSpan = 2;  // bars and numbers
    for (const row of table.tBodies[0].rows) {
      const found = comparison.methods.find((m) => m.method === row.dataset.method);
      const known = R.methods.find((m) => m.name === row.dataset.method);
      const change = found && found.ratio !== null && found.method !== comparison.baseline ? 100 * (found.ratio - 1) : null;
      bar(row, change, (found && found.interval) || null, x, known ? R.color(known.place) : "var(--soft)");
    }
  });
  R.follow(() => {
    for (const { row, m } of rows) {
      const name = row.cells[0].querySelector("span");
      if (!isDrawn(m)) continue;
      name.replaceChildren(R.switchOf(m));
    }
  });

  const every = d3.select("#every-verdict");
  for (const c of R.comparisons.filter((each) => each.methods.length > 1)) {
    every.append("p").text(c.verdict).append("small").text(` ${c.protocol}`);
  }
  every.append("p").attr("class", "hint").text("Each score is tested separately; with many scores, some claims are false by chance.");

  const fixed = (value) => (value === null ? "-" : value.toFixed(4));
  const columns = [
    [R.word, (m) => m.method], ["median", (m) => R.number(m.median)], ["change [%]", (m) => R.change(m.ratio)],
    ["interval", (m) => (m.interval ? m.interval.map(R.change).join(" to ") : "-")],
    ["better/worse/equal", (m) => `${m.better}/${m.worse}/${m.equal}`],
    ["p", (m) => (m.p !== null && m.p < 1e-4 ? "< 0.0001" : fixed(m.p))],
    ["mean change [%]", (m) => R.change(m.geometric_mean)], ["fails", (m) => m.fails], ["place", (m) => m.place],
  ];
  R.follow(() => {
    const host = d3.select("#ranking").html("");
    const comparison = R.comparison(R.state.kind);
    if (!comparison || comparison.methods.length < 2) return;
    const table = host.append("div").attr("class", "scroll").append("table");
    const { label, unit, times, protocol } = R.scores.kinds[R.state.kind];
    table.append("caption").text(`${label} ${comparison.value}${unit ? ` [${unit}]` : ""}, ${times}, ${protocol}`);
    table.append("thead").append("tr").selectAll("th").data(columns).join("th").attr("scope", "col").text(([name]) => name);
    for (const m of comparison.methods) {
      const row = table.append("tbody").append("tr");
      columns.forEach(([, text], i) => row.append(i ? "td" : "th").text(text(m)));
    }
    const notes = host.append("ul").attr("class", "notes");
    for (const remark of comparison.remarks) notes.append("li").text(remark);
  }, "verdicts");

  R.follow(() => {
    const place = String(R.comparisons.indexOf(R.comparison(R.state.kind)));
    const known = answers.some((answer) => answer.dataset.comparison === place);
    for (const answer of answers) answer.hidden = answer.dataset.comparison !== (known ? place : "");
  });
})();
