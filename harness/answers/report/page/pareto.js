// Accuracy against time; the Pareto front contains methods that no other beats in both, among those that have
// every run and do not use the reference.
(() => {
  "use strict";
  const R = window.R;
  const geometric = (values) => Math.exp(d3.mean(values, (v) => Math.log(v)));

  if (!R.scores.cells.some((c) => c.ms > 0)) {  // results of files (`eval --store`)
    document.getElementById("pareto-all").hidden = document.getElementById("pareto-here").hidden = true;
    return;
  }

  // Of one sequence, or (s null) of all together.
  const points = (s) => {
    const runs = new Set(R.scores.cells.filter((c) => s === null || c.sequence === s).map((c) => `${c.sequence} ${c.repeat}`)).size;
    return R.methods.map((m) => {
      const values = R.values(R.state.kind, R.state.statistic, m.place, s);
      const groups = d3.groups(values, (v) => v.sequence);
      return {
        m, covers: values.length === runs,
        error: geometric(groups.map(([, list]) => d3.mean(list, (v) => v.value))),
        ms: geometric(groups.map(([, list]) => d3.median(list, (v) => v.ms))),
      };
    }).filter((p) => p.covers && p.error > 0 && p.ms > 0);
  };

  const draw = (host, s) => {
    host.replaceChildren();
    const kind = R.scores.kinds[R.state.kind];
    if (!kind) return;
    R.caption(host, "Error against time", s === null && R.scores.sequences.length > 1
      ? "geometric means over all sequences" : R.scores.sequences[s || 0]);
    if (kind.better !== "lower") return R.nothing(host, "Select a score for which lower is better.");
    const all = points(s);
    if (!all.length) return R.nothing(host, "No method has a positive value of this score.");
    const fair = all.filter((p) => !p.m.oracle);
    const front = d3.sort(R.front(fair), (p) => p.ms);
    const isNamed = (p) => front.includes(p) || R.state.shown.has(p.m.place);
    R.chart(host, {
      label: `${R.kindLabel(kind)} against time`, height: 400, zoom: true, margin: { left: 66, right: 24 },
      x: { label: "time of the method [ms]", domain: R.paddedLog(d3.extent(all, (p) => p.ms)), log: true },
      y: { label: R.kindLabel(kind), domain: R.paddedLog(d3.extent(all, (p) => p.error)), log: true },
      draw: (group, x, y) => {
        group.append("path").attr("class", "curve").style("stroke", "var(--soft)").attr("stroke-dasharray", "5 4")
          .attr("d", d3.line().x((p) => x(p.ms)).y((p) => y(p.error)).curve(d3.curveStepAfter)(front));
        const dots = group.selectAll("g").data(all).join("g").attr("transform", (p) => `translate(${x(p.ms)},${y(p.error)})`);
        dots.append("circle").attr("r", (p) => (front.includes(p) ? 7 : 5))
          .style("fill", (p) => (R.state.shown.has(p.m.place) ? R.color(p.m.place) : "var(--soft)"))
          .style("fill-opacity", (p) => (front.includes(p) ? 1 : 0.7)).style("stroke", "var(--card)")
          .append("title").text((p) => `${p.m.label}: ${R.number(p.error)} ${kind.unit}, ${R.number(p.ms)} ms${p.m.timeMark}`);
        // Avoids overlapping names: those at the right edge are placed left, others of the same height above or below.
        const taken = [];
        const most = Math.max(12, Math.floor(x.range()[1] / 16));  // characters: about half of the width
        dots.filter(isNamed).sort((a, b) => d3.ascending(a.error, b.error)).each(function (p) {
          const text = R.short(p.m.label, Math.min(40, most)) + p.m.timeMark;
          const onLeft = x(p.ms) + 12 + 7 * text.length > x.range()[1];
          const from = onLeft ? x(p.ms) - 12 - 7 * text.length : x(p.ms) + 12;
          const isFree = (at) => at > 12 && at < y.range()[0] &&
            !taken.some((t) => Math.abs(t.at - at) < 14 && from < t.to && t.from < from + 7 * text.length);
          const places = d3.range(60).map((k) => y(p.error) + 4 + 14 * (k % 2 ? -1 : 1) * Math.ceil(k / 2));
          const at = places.find(isFree) ?? places[0];
          taken.push({ at, from, to: from + 7 * text.length });
          d3.select(this).append("text").attr("class", "strong halo").attr("x", onLeft ? -12 : 12)
            .attr("y", at - y(p.error)).attr("text-anchor", onLeft ? "end" : null).text(text);
        });
      },
    });
    if (all.some((p) => p.m.timeMark)) R.nothing(host, R.scores.stated_note);
  };

  R.follow(() => draw(document.getElementById("pareto-all"), null));
  if (R.scores.sequences.length > 1) R.follow(() => draw(document.getElementById("pareto-here"), R.state.sequence), "spread");
})();
