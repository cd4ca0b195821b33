// Errors in time or along the path, axis by axis, and what metrics state for each pose.
(() => {
  "use strict";
  const R = window.R;
  const parts = [
    ["along-x", "ex", "x", "error x [m]"], ["along-y", "ey", "y", "error y [m]"],
    ["along-z", "ez", "z", "error z [m]"], ["along-a", "a", "rotation", "angle [deg]"],
  ];
  R.follow(() => {
    const s = R.state.sequence;
    const methods = R.shown().filter((m) => R.trace(s, m.place));
    const traces = methods.map((m) => R.trace(s, m.place));
    const by = R.state.abscissa;
    const far = d3.max(traces, (t) => t[by][t[by].length - 1]) || 1;
    const reference = R.reference(s);
    // Common scale of the three axes, so that errors are comparable.
    const [low, high] = R.padded(R.extent(traces.flatMap((t) => [t.ex, t.ey, t.ez])));
    for (const [id, key, name, label] of parts) {
      const host = document.getElementById(id);
      host.replaceChildren();
      R.caption(host, name === "rotation" ? "Rotation" : `Along ${name}`, R.runName(s));
      if (!traces.length) { R.nothing(host, `None of the selected ${R.word}s has a trajectory.`); continue; }
      R.chart(host, {
        label: `${label} of ${methods.map((m) => m.label).join(", ")}`, height: 250, zoom: true,
        x: { ...R.along(by), domain: [0, far] },
        y: { label, domain: key === "a" ? [0, 1.05 * (d3.max(traces, (t) => d3.max(t.a)) || 1)] : [low, high] },
        draw: (group, x, y) => {
          group.append("line").attr("class", "zero").attr("x1", -1e4).attr("x2", 1e4).attr("y1", y(0)).attr("y2", y(0));
          for (const [, to] of reference ? reference.closures : []) {
            const at = x(traces[0][by][R.placeAt(traces[0].t, to)]);
            group.append("line").attr("class", "loop").style("opacity", 0.45).attr("x1", at).attr("x2", at).attr("y1", -1e4).attr("y2", 1e4)
              .append("title").text("loop closure");
          }
          methods.forEach((m, i) => R.curve(group, traces[i][by], traces[i][key], x, y, m));
        },
        pointer: {
          find: (px, py, x, y) => {
            let [best, least] = [null, 60];  // pixels
            methods.forEach((m, i) => {
              const k = R.placeAt(traces[i][by], x.invert(px));
              const far = Math.abs(y(traces[i][key][k]) - py);
              if (far < least) [best, least] = [{ s, m: m.place, t: traces[i].t[k] }, far];
            });
            return best;
          },
          at: (point, x, y) => {
            const i = point.s === s ? methods.findIndex((m) => m.place === point.m) : -1;
            if (i < 0) return null;
            const k = R.placeAt(traces[i].t, point.t);
            return Number.isFinite(traces[i][key][k]) ? [x(traces[i][by][k]), y(traces[i][key][k])] : null;
          },
          text: (point) => {
            const trace = R.trace(s, point.m);
            const k = R.placeAt(trace.t, point.t);
            return [R.methods[point.m].label, `${R.number(trace[key][k])} ${key === "a" ? "deg" : "m"} at ${R.number(trace[by][k])} ${by === "s" ? "m" : "s"}`];
          },
        },
      });
    }
    const stated = document.getElementById("along-values");
    stated.replaceChildren();
    for (const label of new Set(traces.flatMap((t) => [...t.values.keys()]))) {
      const own = d3.range(traces.length).filter((i) => traces[i].values.has(label));
      const host = stated.appendChild(document.createElement("figure"));
      R.caption(host, label, R.runName(s));
      R.chart(host, {
        label: `${label} of ${own.map((i) => methods[i].label).join(", ")}`, height: 250, zoom: true,
        x: { ...R.along(by), domain: [0, far] },
        y: { label, domain: R.padded(R.extent(own.map((i) => traces[i].values.get(label)))) },
        draw: (group, x, y) => own.forEach((i) => R.curve(group, traces[i][by], traces[i].values.get(label), x, y, methods[i])),
      });
    }
    const last = document.getElementById("along-a");
    R.switches(last, s, false);
    const loops = reference ? reference.closures.length : 0;
    if (loops) d3.select(last).append("p").attr("class", "hint below").text("Vertical lines: loop closures.");
  });
})();
