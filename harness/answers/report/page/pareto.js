// Accuracy against time; the Pareto front contains methods that no other beats in both, among those that have
// every run and do not use the reference.
(() => {
  "use strict";
  const R = window.R;
  const geometric = (values) => Math.exp(d3.mean(values, (v) => Math.log(v)));

  if (!R.scores.cells.some((c) => c.ms > 0)) {  // results of files (`eval --store`)
    R.hide("time");
    document.getElementById("pareto-here").hidden = true;
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
    if (!all.length) return R.nothing(host, `No ${R.word} has a positive value of this score.`);
    const fair = all.filter((p) => !p.m.oracle);
    const front = d3.sort(R.front(fair), (p) => p.ms);
    R.chart(host, {
      label: `${R.kindLabel(kind)} against time`, height: 400, zoom: true, margin: { left: 66, right: 24 },
      x: { label: `time of the ${R.word}`, unit: "ms", domain: R.paddedLog(d3.extent(all, (p) => p.ms)), log: true },
      y: { label: R.kindLabel(kind), domain: R.paddedLog(d3.extent(all, (p) => p.error)), log: true },
      draw: (group, x, y) => {
        group.append("path").attr("class", "curve").style("stroke", "var(--soft)").attr("stroke-dasharray", "5 4")
          .attr("d", d3.line().x((p) => x(p.ms)).y((p) => y(p.error)).curve(d3.curveStepAfter)(front));
        const radius = (p) => (front.includes(p) ? 7 : 5);
        group.selectAll("circle").data(all).join("circle").attr("cx", (p) => x(p.ms)).attr("cy", (p) => y(p.error)).attr("r", radius)
          .style("fill", (p) => (R.state.shown.has(p.m.place) ? R.color(p.m.place) : "var(--soft)"))
          .style("fill-opacity", (p) => (front.includes(p) ? 1 : 0.7)).style("stroke", "var(--card)")
          .append("title").text((p) => `${p.m.label}: ${R.number(p.error)} ${kind.unit}, ${R.number(p.ms)} ms${p.m.timeMark}`);
        // Names of all points, above the dots, where they cover neither dots nor names.
        const [width, height] = [x.range()[1], y.range()[0]];
        const taken = all.map((p) => ({ left: x(p.ms) - radius(p) - 1, right: x(p.ms) + radius(p) + 1, top: y(p.error) - radius(p) - 1, bottom: y(p.error) + radius(p) + 1 }));
        const isFree = (box) => box.left >= 0 && box.right <= width && box.top >= 0 && box.bottom <= height &&
          taken.every((t) => box.right < t.left || t.right < box.left || box.bottom < t.top || t.bottom < box.top);
        const most = Math.max(12, Math.floor(width / 16));  // characters: about half of the width
        for (const p of [...front, ...d3.sort(all.filter((q) => !front.includes(q)), (q) => q.error)]) {
          const [cx, cy] = [x(p.ms), y(p.error)];
          if (cx < 0 || cx > width || cy < 0 || cy > height) continue;
          const text = R.short(p.m.label, Math.min(40, most)) + p.m.timeMark;
          const wide = 7 * text.length;
          const places = d3.range(80).flatMap((k) => {
            const dy = 13 * (k % 2 ? -1 : 1) * Math.ceil(k / 2);
            return [[11, dy], [-11 - wide, dy], [-wide / 2, dy]];
          });
          const boxes = places.map(([dx, dy]) => ({ left: cx + dx, right: cx + dx + wide, top: cy + dy - 7, bottom: cy + dy + 6 }));
          const box = boxes.find(isFree);
          if (!box) continue;
          taken.push(box);
          const middle = (box.top + box.bottom) / 2;
          if (Math.abs(middle - cy) > 18) {
            group.append("line").attr("x1", cx).attr("y1", cy).attr("x2", Math.max(box.left, Math.min(box.right, cx))).attr("y2", middle < cy ? box.bottom : box.top)
              .style("stroke", "var(--soft)").style("stroke-width", 0.7);
          }
          group.append("text").attr("class", "strong halo").attr("x", box.left).attr("y", box.bottom - 2).text(text);
        }
      },
    });
    if (all.some((p) => p.m.timeMark)) R.nothing(host, R.scores.stated_note);
  };

  R.follow(() => draw(document.getElementById("pareto-all"), null));
  if (R.scores.sequences.length > 1) R.follow(() => draw(document.getElementById("pareto-here"), R.state.sequence), "spread");
})();
