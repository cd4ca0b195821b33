// Dispersion over runs: box plots on one sequence, changes to the baseline with intervals over all.
(() => {
  "use strict";
  const R = window.R;
  const rowHeight = (rows) => (rows.length > 24 ? 17 : 24);
  // Shortens swept labels by dropping option names; the values identify the method.
  const short = (text, most = 30) => {
    const bare = text.length > most ? text.replace(/[\w.]+=/g, "") : text;
    return bare.length > most ? bare.slice(0, most - 1) + "…" : bare;
  };
  R.short = short;
  const left = (methods) => Math.min(215, 24 + 6.6 * (d3.max(methods, (m) => short(m.label).length) || 0));

  const boxes = (host) => {
    const kind = R.scores.kinds[R.state.kind];
    const rows = R.methods.map((m) => ({ m, values: R.values(R.state.kind, R.state.statistic, m.place, R.state.sequence).map((v) => v.value).sort(d3.ascending) }))
      .filter((row) => row.values.length).sort((a, b) => d3.median(a.values) - d3.median(b.values));
    const repeats = d3.max(rows, (row) => row.values.length) || 0;
    R.caption(host, R.kindLabel(kind), `${R.scores.sequences[R.state.sequence]}, ${repeats === 1 ? "one run" : repeats + " repeats"}`);
    if (!rows.length) return R.nothing(host, `No ${R.word} has this score.`);
    const all = rows.flatMap((row) => row.values);
    const log = d3.min(all) > 0 && d3.max(all) / d3.min(all) > 20;
    R.chart(host, {
      label: `${R.kindLabel(kind)} of every method`, height: 60 + rowHeight(rows) * rows.length, margin: { left: left(R.methods) },
      x: { label: R.kindLabel(kind), domain: log ? R.paddedLog(d3.extent(all)) : R.padded(d3.extent(all)), log },
      y: { band: rows.map((row) => row.m.place), name: (m) => short(R.methods[m].label) },
      draw: (group, x, y) => {
        for (const { m, values } of rows) {
          const [top, height, middle] = [y(m.place), y.bandwidth(), y(m.place) + y.bandwidth() / 2];
          const g = group.append("g").style("color", R.state.shown.has(m.place) ? R.color(m.place) : "var(--soft)");
          g.append("title").text(`${m.label}: median ${R.number(d3.median(values))}, ${R.number(values[0])} to ${R.number(values[values.length - 1])} (${values.length})`);
          if (values.length > 2) {
            const [q1, q2, q3] = [0.25, 0.5, 0.75].map((p) => d3.quantile(values, p));
            g.append("line").attr("x1", x(values[0])).attr("x2", x(values[values.length - 1])).attr("y1", middle).attr("y2", middle).attr("stroke", "currentColor");
            g.append("rect").attr("x", x(q1)).attr("width", Math.max(1, x(q3) - x(q1))).attr("y", top).attr("height", height)
              .attr("fill", "currentColor").attr("fill-opacity", 0.22).attr("stroke", "currentColor");
            g.append("line").attr("x1", x(q2)).attr("x2", x(q2)).attr("y1", top).attr("y2", top + height).attr("stroke", "currentColor").attr("stroke-width", 3);
          }
          g.selectAll("circle").data(values).join("circle").attr("cx", (v) => x(v)).attr("cy", middle).attr("r", 3).attr("fill", "currentColor").attr("fill-opacity", 0.75);
        }
      },
    });
    d3.select(host).append("p").attr("class", "hint below")
      .text(repeats > 2 ? "Dots: runs. Box: quartiles and median; whiskers: minimum and maximum." : "Dots: runs; too few for boxes.");
  };

  const forest = (host) => {
    const kind = R.scores.kinds[R.state.kind];
    const comparison = R.comparison(R.state.kind);
    R.caption(host, "Change to " + (R.baseline ? R.baseline.label : "the baseline"), `${kind.label} rmse, ${kind.times}, all sequences`);
    const rows = (comparison ? comparison.methods : []).filter((m) => m.ratio !== null);
    if (!rows.length) return R.nothing(host, "No comparison with a baseline for this score.");
    const place = new Map(R.methods.map((m) => [m.name, m.place]));
    const all = rows.flatMap((m) => [m.ratio, ...(m.interval || [])]).concat(1);
    R.chart(host, {
      label: `Change of ${kind.label} to the baseline, with intervals`, height: 60 + rowHeight(rows) * rows.length, margin: { left: left(R.methods) },
      x: { label: `typical change [%] (${kind.better === "higher" ? "right" : "left"} is better)`, domain: R.paddedLog(d3.extent(all)), log: true, format: R.change },
      y: { band: rows.map((m) => place.get(m.method)), name: (m) => short(R.methods[m].label) },
      draw: (group, x, y) => {
        group.append("line").attr("class", "zero").attr("x1", x(1)).attr("x2", x(1)).attr("y1", 0).attr("y2", 1e4);
        for (const m of rows) {
          const middle = y(place.get(m.method)) + y.bandwidth() / 2;
          const g = group.append("g").style("color", R.state.shown.has(place.get(m.method)) ? R.color(place.get(m.method)) : "var(--soft)");
          if (m.interval) {
            g.append("line").attr("x1", x(m.interval[0])).attr("x2", x(m.interval[1])).attr("y1", middle).attr("y2", middle)
              .attr("stroke", "currentColor").attr("stroke-width", 3).attr("stroke-linecap", "round");
          }
          g.append("circle").attr("cx", x(m.ratio)).attr("cy", middle).attr("r", 5.5).attr("fill", "currentColor");
          g.append("title").text(`${m.method}: ${R.change(m.ratio)} %` + (m.interval ? ` [${m.interval.map(R.change).join(", ")}]` : "") + `, p = ${R.number(m.p)}, ${m.place === "=" ? "shares the first place" : "significantly worse"}` + (m.fails ? `, fails ${m.fails}` : ""));
        }
      },
    });
    if (rows.some((m) => m.interval)) R.nothing(host, `Bars: ${100 * (1 - comparison.alpha)} % intervals over ${comparison.unit_of_observation}.`);
  };

  R.follow(() => {
    for (const [id, draw] of [["boxes", boxes], ["forest", forest]]) {
      const host = document.getElementById(id);
      host.replaceChildren();
      if (R.scores.kinds.length) draw(host);
    }
  }, "spread");
})();
