// Scores over swept options, and costs over a swept size. Options are those of the config.
(() => {
  "use strict";
  const R = window.R;
  const families = (list, of) => list.map((family) => ({
    of, name: family.name, options: family.options, members: family.members.map(([place, ...values]) => ({ place, values })),
  }));
  const all = [...families(R.scores.sequence_families, "sequence"), ...families(R.scores.method_families, "method")];
  if (!all.length) R.hide("sweeps");
  if (!R.scores.growth.length) R.hide("growth");

  const valueOf = (m, s) => {
    const values = R.values(R.state.kind, R.state.statistic, m, s);
    return values.length ? d3.mean(values, (v) => v.value) : NaN;
  };
  const label = (m) => R.methods[m].label;
  const dots = (group, points, x, y, color, text) => group.selectAll(null).data(points).join("circle")
    .attr("cx", (p) => x(p.x)).attr("cy", (p) => y(p.y)).attr("r", 4).style("fill", color).append("title").text(text);
  const path = (group, points, x, y, color, dash) => group.append("path").attr("class", "curve").style("stroke", color)
    .attr("stroke-dasharray", dash).attr("d", d3.line().x((p) => x(p.x)).y((p) => y(p.y))(points));

  // Series {m, points}: of a family of methods one, on the selected sequence; of a family of sequences one for
  // each drawn method.
  const seriesOf = (family) => {
    const points = (value) => d3.sort(family.members.map((member) => ({ x: member.values[0], y: value(member.place) }))
      .filter((p) => Number.isFinite(p.y)), (p) => p.x);
    return (family.of === "method" ? [{ m: null, points: points((m) => valueOf(m, R.state.sequence)) }]
      : R.shown().map((m) => ({ m: m.place, points: points((s) => valueOf(m.place, s)) }))).filter((s) => s.points.length);
  };

  // The domain follows the values of the sweep; a baseline far outside is a note below.
  const curve = (host, family) => {
    const kind = R.scores.kinds[R.state.kind];
    const [option] = family.options;
    const isOfMethods = family.of === "method";
    const series = seriesOf(family);
    const points = series.flatMap((s) => s.points);
    R.caption(host, `${family.name}: ${option}`, isOfMethods ? R.scores.sequences[R.state.sequence] : "mean over the runs");
    if (!points.length) return R.nothing(host, "No value of this score.");
    const base = R.baseline && isOfMethods ? valueOf(R.baseline.place, R.state.sequence) : NaN;
    const [low, high] = d3.extent(points, (p) => p.y);
    const range = Math.max(high - low, 1e-9 * Math.abs(high));
    const isNear = Number.isFinite(base) && base > low - 2 * range && base < high + 2 * range;
    const [first, last] = d3.extent(points, (p) => p.x);
    const log = first > 0 && last / first >= 8;
    R.chart(host, {
      label: `${R.kindLabel(kind)} of ${family.name} against ${option}`, height: 330, margin: { left: 84 },
      x: { ticks: points.length <= 12 ? [...new Set(points.map((p) => p.x))] : null, label: option + (log ? " (logarithmic)" : ""), log, domain: log ? R.paddedLog([first, last]) : R.padded([first, last]) },
      y: { label: R.kindLabel(kind), domain: R.padded(isNear ? [Math.min(low, base), Math.max(high, base)] : [low, high], 0.15) },
      draw: (group, x, y) => {
        if (isNear) {
          group.append("line").attr("class", "zero").attr("x1", 0).attr("x2", 1e4).attr("y1", y(base)).attr("y2", y(base));
          group.append("text").attr("class", "halo").attr("x", 6).attr("y", y(base) - 5).text(R.baseline.label);
        }
        for (const { m, points: own } of series) {
          const color = m === null ? "var(--accent)" : R.color(m);
          path(group, own, x, y, color, m === null ? null : R.dash(m));
          dots(group, own, x, y, color, (p) => `${m === null ? "" : label(m) + ", "}${option} ${p.x}: ${R.number(p.y)}`);
        }
        if (series.length > 1 || points.length > 10) return;
        // The outer texts stay inside narrow charts.
        const anchor = (p, i) => (points.length > 1 && i === 0 ? "start" : points.length > 1 && i === points.length - 1 ? "end" : "middle");
        group.selectAll(null).data(points).join("text").attr("class", "halo strong").attr("x", (p) => x(p.x)).attr("y", (p) => y(p.y) - 9)
          .attr("text-anchor", anchor).text((p) => R.number(p.y));
      },
    });
    if (Number.isFinite(base) && !isNear) R.nothing(host, `${R.baseline.label}: ${R.number(base)}, outside this range.`);
    if (!isOfMethods) R.methodLegend(host, series.map((s) => R.methods[s.m]), false);
  };

  const heat = (host, family) => {
    const [option, other] = family.options;
    const kind = R.scores.kinds[R.state.kind];
    const isOfMethods = family.of === "method";
    const values = new Map();
    for (const { place, values: [a, b] } of family.members) {
      values.set(`${a} ${b}`, isOfMethods ? valueOf(place, R.state.sequence) : valueOf(R.state.after, place));
    }
    const all = [...values.values()].filter(Number.isFinite);
    const axis = (i) => [...new Set(family.members.map((member) => member.values[i]))].sort(d3.ascending);
    const [xs, ys] = [axis(0), axis(1).reverse()];
    R.caption(host, `${family.name}: ${option} and ${other}`,
      `${R.kindLabel(kind)}, ${isOfMethods ? R.scores.sequences[R.state.sequence] : label(R.state.after)}`);
    if (!all.length) return R.nothing(host, "No value of this score.");
    const width = Math.max(330, Math.min(600, host.clientWidth || 600));
    const [height, left, top] = [330, width < 480 ? 60 : 80, 10];
    const x = d3.scaleBand(xs, [left, width - 14]).padding(0.04);
    const y = d3.scaleBand(ys, [top, height - 50]).padding(0.04);
    const [low, high] = d3.extent(all);
    const level = (v) => (high > low ? (v - low) / (high - low) : 0);
    const color = d3.interpolateRgbBasis(["#e2f3ec", "#7cc4d8", "#2a6fb0", "#1d2f6f"]);
    const svg = d3.select(host).append("svg").attr("viewBox", `0 0 ${width} ${height}`).attr("role", "img")
      .attr("aria-label", `${R.kindLabel(kind)} of ${family.name} over ${option} and ${other}`);
    for (const a of xs) for (const b of ys) {
      const v = values.get(`${a} ${b}`);
      if (!Number.isFinite(v)) continue;
      svg.append("rect").attr("x", x(a)).attr("y", y(b)).attr("width", x.bandwidth()).attr("height", y.bandwidth()).style("fill", color(level(v)));
      svg.append("text").attr("x", x(a) + x.bandwidth() / 2).attr("y", y(b) + y.bandwidth() / 2 + 4).attr("text-anchor", "middle")
        .style("fill", level(v) > 0.45 ? "#fff" : "#1b1f24").text(R.number(v));
    }
    for (const a of xs) svg.append("text").attr("x", x(a) + x.bandwidth() / 2).attr("y", height - 32).attr("text-anchor", "middle").text(a);
    for (const b of ys) svg.append("text").attr("x", left - 8).attr("y", y(b) + y.bandwidth() / 2 + 4).attr("text-anchor", "end").text(b);
    svg.append("text").attr("x", (left + width) / 2).attr("y", height - 12).attr("text-anchor", "middle").text(option);
    svg.append("text").attr("transform", `translate(16,${(top + height - 50) / 2}) rotate(-90)`).attr("text-anchor", "middle").text(other);
  };

  R.follow(() => {
    const host = document.getElementById("sweep-figures");
    host.replaceChildren();
    if (!R.scores.kinds.length) return;
    for (const family of all) {
      (family.options.length === 2 ? heat : curve)(host.appendChild(document.createElement("figure")), family);
    }
  }, "sweeps");

  // Time and memory over the size, on logarithmic axes; exponents are fitted to the logarithms.
  const growth = (host, own, key, name, unit) => {
    const all = own.map((g) => ({ ...g, points: g.sizes.map((x, i) => ({ x, y: g[key][i] })).filter((p) => p.y > 0) }))
      .filter((g) => g.points.length);
    if (!all.length) return;
    R.caption(host.appendChild(document.createElement("figure")), name, own[0].family);
    const figure = host.lastChild;
    const points = all.flatMap((g) => g.points);
    R.chart(figure, {
      label: `${name} over ${own[0].unit}`, height: 400, margin: { left: 66 },
      x: { label: own[0].unit, log: true, domain: R.paddedLog(d3.extent(points, (p) => p.x)), ticks: [...new Set(points.map((p) => p.x))] },
      y: { label: name, unit, log: true, domain: R.paddedLog(d3.extent(points, (p) => p.y)) },
      draw: (group, x, y) => {
        for (const g of all) {
          path(group, g.points, x, y, R.color(g.method), R.dash(g.method));
          dots(group, g.points, x, y, R.color(g.method), (p) => `${label(g.method)}, ${p.x} ${g.unit}: ${R.number(p.y)} ${unit}`);
        }
      },
    });
    R.legend(figure, all.map((g) => ({ name: `${label(g.method)} ${g[key + "_law"]}`, color: R.color(g.method), dash: R.dash(g.method) })));
  };

  R.follow(() => {
    const host = document.getElementById("growth-figures");
    host.replaceChildren();
    for (const own of d3.group(R.scores.growth, (g) => g.family + g.unit).values()) {
      growth(host, own, "cpu", "CPU time", "ms");
      growth(host, own, "memory", "peak memory", "MB");
    }
    R.nothing(host, "Exponents are fitted to the logarithms, with 95 % intervals. The peak memory contains that of the program.");
  });
})();
