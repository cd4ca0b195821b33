// The verdict of the selected score, with a bar and an interval for each group.
(() => {
  "use strict";
  const R = window.R;
  const answers = [...document.querySelectorAll("#answer [data-comparison]")];
  const kWidth = 130, kHeight = 18;

  const bar = (row, group, x, color) => {
    const svg = d3.select(row.insertCell(1)).attr("class", "bar").append("svg").attr("viewBox", `0 0 ${kWidth} ${kHeight}`)
      .attr("role", "img").attr("aria-label", group.change ? `${group.change.map(R.number).join(" to ")} %` : "no change known");
    svg.append("line").attr("class", "zero").attr("x1", x(0)).attr("x2", x(0)).attr("y2", kHeight);
    if (!group.change) return;
    const [low, high] = group.change;
    const end = low + high < 0 ? low : high;
    svg.append("rect").attr("x", Math.min(x(0), x(end))).attr("width", Math.abs(x(end) - x(0))).attr("y", 3).attr("height", kHeight - 6)
      .style("fill", color).style("fill-opacity", 0.6);
    if (!group.interval) return;
    const [from, to] = group.interval.map(x);
    svg.append("path").attr("d", `M${from},${kHeight / 2}H${to}M${from},5v8M${to},5v8`).style("stroke", "var(--ink)").style("stroke-width", 1.6);
  };

  R.comparisons.forEach((comparison, i) => {
    const table = document.querySelector(`#answer [data-comparison="${i}"] table`);
    if (!table) return;
    const groups = comparison.groups_of_methods;
    const ends = groups.flatMap((g) => [...(g.change || []), ...(g.interval || [])]).concat(0);
    const x = d3.scaleLinear(d3.extent(ends), [3, kWidth - 3]);
    table.tHead.rows[0].cells[1].colSpan = 2;  // bars and numbers
    groups.forEach((group, g) => {
      const drawn = R.scores.default_methods.find((m) => group.methods.includes(R.methods[m].name));
      bar(table.tBodies[0].rows[g], group, x, drawn === undefined ? "var(--soft)" : R.color(drawn));
    });
  });

  const every = d3.select("#every-verdict");
  for (const c of R.comparisons.filter((each) => each.methods.length > 1)) {
    every.append("p").text(c.verdict).append("small").text(` ${c.protocol}`);
  }
  every.append("p").attr("class", "hint").text("Each score is tested separately; with many scores, some claims are false by chance.");

  const fixed = (value) => (value === null ? "-" : value.toFixed(4));
  const columns = [
    ["method", (m) => m.method], ["median", (m) => R.number(m.median)], ["ratio", (m) => fixed(m.ratio)],
    ["interval", (m) => (m.interval ? m.interval.map(fixed).join(" .. ") : "-")],
    ["better/worse/equal", (m) => `${m.better}/${m.worse}/${m.equal}`],
    ["p", (m) => (m.p !== null && m.p < 1e-4 ? "< 0.0001" : fixed(m.p))],
    ["mean", (m) => fixed(m.geometric_mean)], ["fails", (m) => m.fails], ["place", (m) => m.place],
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
