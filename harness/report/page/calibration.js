// Share of errors inside the regions that stated covariances give, over their probability.
(() => {
  "use strict";
  const R = window.R;
  const section = document.getElementById("calibration");
  const link = document.querySelector('[data-for="calibration"]');
  const levels = [50, 90, 95];
  const placed = R.scores.kinds.map((k, place) => ({ ...k, place })).filter((k) => k.metric === "nees");
  const first = placed.find((k) => k.axis === "pose") || placed.find((k) => k.axis === "position");
  if (!first) {
    section.hidden = true;
    link.hidden = true;
    return;
  }
  const placeOf = (relation) => placed.find((k) => k.relation === relation && k.axis === first.axis &&
    k.times === first.times && k.protocol === first.protocol).place;
  // Mean over the runs of the selected sequence.
  const valueOf = (m, relation) => d3.mean(R.values(placeOf(relation), 0, m, R.state.sequence), (v) => v.value);

  R.follow(() => {
    const host = document.getElementById("calibration-curve");
    host.replaceChildren();
    const rows = R.methods.map((m) => ({
      m, points: levels.map((level) => ({ x: level, y: valueOf(m.place, `coverage_${level}`) })),
      low: valueOf(m.place, "coverage_95_low"), high: valueOf(m.place, "coverage_95_high"),
    })).filter((row) => R.state.shown.has(row.m.place) && row.points.every((p) => Number.isFinite(p.y)));
    R.caption(host, `Covariances: ${R.scores.sequences[R.state.sequence]}`, `${first.axis}, ${first.times}`);
    if (!rows.length) return R.nothing(host, "No selected method has covariances on this sequence.");
    R.chart(host, {
      label: "Coverage over stated probability", height: 420,
      x: { label: "stated probability [%]", domain: [40, 102] }, y: { label: "errors inside the region [%]", domain: [-2, 102] },
      draw: (group, x, y) => {
        group.append("line").attr("class", "zero").attr("x1", x(0)).attr("x2", x(100)).attr("y1", y(0)).attr("y2", y(100));
        for (const { m, points, low, high } of rows) {
          R.curve(group, levels, points.map((p) => p.y), x, y, m);
          group.append("line").attr("x1", x(95)).attr("x2", x(95)).attr("y1", y(low)).attr("y2", y(high))
            .style("stroke", R.color(m.place)).attr("stroke-width", 2.4);
          group.selectAll(null).data(points).join("circle").attr("cx", (p) => x(p.x)).attr("cy", (p) => y(p.y)).attr("r", 4)
            .style("fill", R.color(m.place)).append("title").text((p) => `${m.label}: ${R.number(p.y)} % inside the ${p.x} % region`);
        }
      },
    });
    R.methodLegend(host, rows.map((row) => row.m), false);
    d3.select(host).append("p").attr("class", "hint below")
      .text("On the diagonal, covariances are right; below it, they are too small. Bar at 95 %: interval for autocorrelated errors.");
  });
})();
