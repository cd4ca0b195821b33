// The selected plane: all methods, and two methods side by side, coloured by error.
(() => {
  "use strict";
  const R = window.R;
  // The colours of errors in figures of plot, for every kind of sight; in the dark without the darkest.
  const ramp = (share) => d3.interpolatePlasma(R.dark.matches ? 0.3 + 0.7 * share : 0.86 * share);
  R.dark.addEventListener("change", () => R.changed());
  const kLevels = 16;

  const extent = (lists) => {
    let low = Infinity, high = -Infinity;
    for (const list of lists) for (const v of list) if (Number.isFinite(v)) { low = Math.min(low, v); high = Math.max(high, v); }
    return low > high ? [0, 1] : [low, high];
  };
  R.extent = extent;

  // Two axes: the selected ones, or those of the largest extent (x and z in camera axes).
  R.plane = (path) => {
    if (R.state.plane) return [...R.state.plane];
    const size = (axis) => extent([path[axis]]).reduce((low, high) => high - low);
    const normal = d3.least(["z", "y", "x"], size);
    return ["x", "y", "z"].filter((axis) => axis !== normal);
  };

  const band = (group, reference, x, y, [a, b]) => group.append("path").attr("class", "band")
    .attr("d", d3.line().x((i) => x(reference[a][i])).y((i) => y(reference[b][i]))(d3.range(reference.t.length)));

  const around = (traces, [a, b]) => ({
    x: { label: a, unit: "m", domain: R.padded(extent(traces.map((t) => t[a]))) },
    y: { label: b, unit: "m", domain: R.padded(extent(traces.map((t) => t[b]))) },
  });

  R.follow(() => {
    const host = document.getElementById("map");
    host.replaceChildren();
    const s = R.state.sequence;
    const reference = R.reference(s);
    const methods = R.shown().filter((m) => R.trace(s, m.place));
    const [a, b] = reference ? R.plane(reference) : ["x", "y"];
    R.caption(host, `Trajectories (plane ${a}, ${b})`, R.runName(s));
    if (!reference) return R.nothing(host, "No stored trajectories of this sequence (traces: false).");
    const traces = methods.map((m) => R.trace(s, m.place));
    R.chart(host, {
      label: `Trajectories of ${R.scores.sequences[s]}, plane ${a}, ${b}`, height: 470, equal: true, zoom: true,
      ...around([reference, ...traces], [a, b]),
      draw: (group, x, y) => {
        band(group, reference, x, y, [a, b]);
        methods.forEach((m, i) => R.curve(group, traces[i][a], traces[i][b], x, y, m));
        group.append("circle").attr("cx", x(reference[a][0])).attr("cy", y(reference[b][0])).attr("r", 4.5)
          .style("fill", "var(--ink)").append("title").text("start of the reference");
      },
      pointer: {
        find: (px, py, x, y) => {
          let [best, least] = [null, 40 ** 2];  // within 40 pixels
          methods.forEach((m, i) => traces[i].t.forEach((t, k) => {
            const far = (x(traces[i][a][k]) - px) ** 2 + (y(traces[i][b][k]) - py) ** 2;
            if (far < least) [best, least] = [{ s, m: m.place, t }, far];
          }));
          return best;
        },
        at: (point, x, y) => {
          const trace = point.s === s && R.state.shown.has(point.m) && R.trace(s, point.m);
          if (!trace) return null;
          const k = R.placeAt(trace.t, point.t);
          return [x(trace[a][k]), y(trace[b][k])];
        },
        text: (point) => {
          const trace = R.trace(s, point.m);
          const k = R.placeAt(trace.t, point.t);
          const angle = Number.isFinite(trace.a[k]) ? `, ${R.number(trace.a[k])} deg` : "";
          return [R.methods[point.m].label, `${R.number(trace.norm[k])} m${angle}`, `at ${R.number(trace.t[k])} s, ${R.number(trace.s[k])} m`];
        },
      },
    });
    R.switches(host, s);
  });

  const coloured = (host, m, most, axes, reference, s) => {
    host.replaceChildren();
    const trace = R.trace(s, m.place);
    if (!trace) {
      R.caption(host, m.label);
      return R.nothing(host, `This ${R.word} has no trajectory; see the failures.`);
    }
    const squares = d3.pairs(trace.norm, (e, f) => (e * e + f * f) / 2);
    const seconds = d3.pairs(trace.t, (t, u) => u - t);
    const rms = Math.sqrt(d3.sum(squares, (e, i) => e * seconds[i]) / d3.sum(seconds)) || d3.max(trace.norm);
    const digits = d3.format(".3~g");
    R.caption(host, m.label, `RMS of the drawn errors ${digits(rms)} m, largest ${digits(d3.max(trace.norm))} m`);
    const levels = Array.from({ length: kLevels }, () => []);
    for (let i = 1; i < trace.t.length; ++i) {
      const level = Math.min(kLevels - 1, Math.floor((kLevels * trace.norm[i]) / most));
      if (Number.isFinite(level)) levels[level].push(i);
    }
    const [a, b] = R.plane(reference);
    R.chart(host, {
      label: `${m.label} on ${R.scores.sequences[s]}, coloured by position error`, height: 440, equal: true, zoom: true, ...axes,
      draw: (group, x, y) => {
        band(group, reference, x, y, [a, b]);
        levels.forEach((places, level) => group.append("path").attr("class", "curve").style("stroke-width", 3)
          .style("stroke", ramp((level + 0.5) / kLevels))
          .attr("d", places.map((i) => `M${x(trace[a][i - 1])},${y(trace[b][i - 1])}L${x(trace[a][i])},${y(trace[b][i])}`).join("")));
        for (const [from, to] of reference.closures) {
          const [i, k] = [R.placeAt(trace.t, from), R.placeAt(trace.t, to)];
          const [x1, y1, x2, y2] = [x(trace[a][i]), y(trace[b][i]), x(trace[a][k]), y(trace[b][k])];
          const loop = group.append("g").attr("class", "loop");
          loop.append("line").attr("x1", x1).attr("y1", y1).attr("x2", x2).attr("y2", y2);
          for (const [cx, cy] of [[x1, y1], [x2, y2]]) loop.append("circle").attr("cx", cx).attr("cy", cy).attr("r", 3);
          loop.append("title").text("loop closure");
        }
      },
    });
  };

  R.follow(() => {
    const s = R.state.sequence;
    const reference = R.reference(s);
    const [before, after] = [document.getElementById("before"), document.getElementById("after")];
    const legend = document.getElementById("ramp");
    legend.replaceChildren();
    if (!reference) return [before, after].forEach((host) => host.replaceChildren());
    const pair = [R.methods[R.state.before], R.methods[R.state.after]];
    const traces = pair.map((m) => R.trace(s, m.place)).filter(Boolean);
    const most = d3.max(traces, (t) => d3.max(t.norm)) || 1;
    const axes = around([reference, ...traces], R.plane(reference));
    coloured(before, pair[0], most, axes, reference, s);
    const isAlone = pair[0] === pair[1];
    after.replaceChildren();
    if (!isAlone) coloured(after, pair[1], most, axes, reference, s);
    const svg = d3.select(legend).append("svg").attr("viewBox", "0 0 440 34").style("max-width", "440px").attr("role", "img").attr("aria-label", "Colours of position errors");
    svg.selectAll("rect").data(d3.range(kLevels)).join("rect").attr("x", (l) => 28 + 24 * l).attr("y", 6).attr("width", 24).attr("height", 12)
      .style("fill", (l) => ramp((l + 0.5) / kLevels));
    svg.selectAll(null).data([0, 0.5, 1]).join("text").attr("x", (f) => 28 + 24 * kLevels * f).attr("y", 31).attr("text-anchor", "middle").text((f) => d3.format(".2~g")(most * f));
    R.nothing(legend, "Position error [m]" + (isAlone ? "" : ", same colours on both sides") + (reference.closures.length
      ? `; joined circles: ${reference.closures.length} of ${reference.allClosures} loop closures.` : "; no loop closures."));
  });
})();
