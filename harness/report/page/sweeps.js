// Methods of one label that differ in numbers: "LABEL (option=0.1, other=2)".
(() => {
  "use strict";
  const R = window.R;

  const sweeps = (() => {
    const families = new Map();
    for (const m of R.methods) {
      const found = /^(.*) \(([^()]*=[^()]*)\)$/.exec(m.name);
      if (!found) continue;
      const options = new Map(found[2].split(", ").map((text) => {
        const at = text.indexOf("=");
        return [text.slice(0, at), Number(text.slice(at + 1))];
      }));
      if (![...options.values()].every(Number.isFinite)) continue;
      const key = found[1] + "\n" + [...options.keys()].join(",");
      if (!families.has(key)) families.set(key, { name: found[1], members: [] });
      families.get(key).members.push({ m, options });
    }
    const out = [];
    for (const family of families.values()) {
      const names = [...family.members[0].options.keys()];
      const varying = names.filter((n) => new Set(family.members.map((member) => member.options.get(n))).size > 1);
      if (varying.length === 1 || varying.length === 2) out.push({ ...family, varying });
    }
    return out;
  })();

  const link = document.querySelector('[data-for="sweeps"]');
  if (!sweeps.length) {
    document.getElementById("sweeps").hidden = true;
    link.hidden = true;
    return;
  }

  const valueOf = (m) => {
    const values = R.values(R.state.kind, R.state.statistic, m, R.state.sequence);
    return values.length ? d3.mean(values, (v) => v.value) : NaN;
  };

  // The domain follows the values of the sweep; a baseline far outside is a note below.
  const curve = (host, family) => {
    const kind = R.scores.kinds[R.state.kind];
    const [option] = family.varying;
    const points = d3.sort(family.members.map(({ m, options }) => ({ x: options.get(option), y: valueOf(m.place) }))
      .filter((p) => Number.isFinite(p.y)), (p) => p.x);
    R.caption(host, `${family.name}: ${option}`, R.scores.sequences[R.state.sequence]);
    if (!points.length) return R.nothing(host, "No value of this score.");
    const base = R.baseline ? valueOf(R.baseline.place) : NaN;
    const [low, high] = d3.extent(points, (p) => p.y);
    const range = Math.max(high - low, 1e-9 * Math.abs(high));
    const isNear = Number.isFinite(base) && base > low - 2 * range && base < high + 2 * range;
    const [first, last] = d3.extent(points, (p) => p.x);
    const log = first > 0 && last / first >= 8;
    R.chart(host, {
      label: `${R.kindLabel(kind)} of ${family.name} against ${option}`, height: 330, margin: { left: 84 },
      x: { ticks: points.length <= 12 ? points.map((p) => p.x) : null, label: option + (log ? " (logarithmic)" : ""), log, domain: log ? R.paddedLog([first, last]) : R.padded([first, last]) },
      y: { label: R.kindLabel(kind), domain: R.padded(isNear ? [Math.min(low, base), Math.max(high, base)] : [low, high], 0.15) },
      draw: (group, x, y) => {
        if (isNear) {
          group.append("line").attr("class", "zero").attr("x1", 0).attr("x2", 1e4).attr("y1", y(base)).attr("y2", y(base));
          group.append("text").attr("class", "halo").attr("x", 6).attr("y", y(base) - 5).text(R.baseline.label);
        }
        group.append("path").attr("class", "curve").style("stroke", "var(--accent)").attr("d", d3.line().x((p) => x(p.x)).y((p) => y(p.y))(points));
        const dots = group.selectAll(null).data(points).join("g").attr("transform", (p) => `translate(${x(p.x)},${y(p.y)})`);
        dots.append("circle").attr("r", 4.5).style("fill", "var(--accent)").append("title").text((p) => `${option} ${p.x}: ${R.number(p.y)}`);
        if (points.length <= 10) {
          // The outer texts stay inside narrow charts.
          const anchor = (p, i) => (points.length > 1 && i === 0 ? "start" : points.length > 1 && i === points.length - 1 ? "end" : "middle");
          dots.append("text").attr("class", "halo strong").attr("y", -9).attr("text-anchor", anchor).text((p) => R.number(p.y));
        }
      },
    });
    if (Number.isFinite(base) && !isNear) R.nothing(host, `${R.baseline.label}: ${R.number(base)}, outside this range.`);
  };

  const heat = (host, family) => {
    const [option, other] = family.varying;
    const kind = R.scores.kinds[R.state.kind];
    const values = new Map();
    for (const { m, options } of family.members) values.set(`${options.get(option)} ${options.get(other)}`, valueOf(m.place));
    const all = [...values.values()].filter(Number.isFinite);
    const axis = (name) => [...new Set(family.members.map((member) => member.options.get(name)))].sort(d3.ascending);
    const [xs, ys] = [axis(option), axis(other).reverse()];
    R.caption(host, `${family.name}: ${option} and ${other}`, R.kindLabel(kind));
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
    for (const family of sweeps) {
      (family.varying.length === 2 ? heat : curve)(host.appendChild(document.createElement("figure")), family);
    }
  });
})();
