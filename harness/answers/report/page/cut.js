// Segments and windows of a method along the path, and its choice for each.
(() => {
  "use strict";
  const R = window.R;
  const has = R.methods.filter((m) => R.scores.cells.some((c, i) => c.method === m.place && R.cutOf(i)));
  if (!has.length) return R.hide("cut");
  const kFamilies = ["#0068b0", "#cc4c02", "#2aa59a", "#7d1d6f", "#efb400", "#7fb8ec", "#5c3a14", "#f2a0c0"]; // of plot
  const kPlain = ["#0068b0", "#cc4c02"]; // alternating colours of unnamed neighbours
  const state = { method: has[0].place, kind: "segment" };
  const colourOf = (part, names) => (k) => (part.what[k] ? kFamilies[names.indexOf(part.what[k]) % kFamilies.length] : kPlain[k % 2]);

  const select = (text, entries, chosen, set) => {
    const label = document.createElement("label");
    label.className = "field";
    const out = document.createElement("select");
    for (const [value, name] of entries) out.append(new Option(name, value, false, value === chosen));
    out.addEventListener("change", () => { set(out.value); R.changed(); });
    label.append(text, out);
    return label;
  };
  const controls = (parts) => document.getElementById("cut-controls").replaceChildren(
    select("Method", has.map((m) => [String(m.place), m.label]), String(state.method), (v) => (state.method = Number(v))),
    select("On the map", parts.map((p) => [p.kind, `${p.kind}s`]), state.kind, (v) => (state.kind = v)));

  const tell = (part, k) => `${part.kind} ${k + 1}: ${R.number(part.begin[k])} to ${R.number(part.end[k])} s` + (part.what[k] ? `, ${part.what[k]}` : "");

  const map = (host, trace, part, names, title) => {
    host.replaceChildren();
    const [a, b] = R.plane(trace);
    R.caption(host, `${part.all} ${part.kind}${part.all === 1 ? "" : "s"}, plane ${a}, ${b}`, title);
    const colour = colourOf(part, names);
    R.chart(host, {
      label: `${part.kind}s of ${title}`, height: 440, equal: true, zoom: true,
      x: { label: a, unit: "m", domain: R.padded(R.extent([trace[a]])) }, y: { label: b, unit: "m", domain: R.padded(R.extent([trace[b]])) },
      draw: (group, x, y) => part.begin.forEach((begin, k) => {
        const [i, j] = [R.placeAt(trace.t, begin), R.placeAt(trace.t, part.end[k])];
        const line = d3.range(i, Math.max(i + 1, j + 1)).map((p) => [x(trace[a][p]), y(trace[b][p])]);
        group.append("path").attr("class", "curve").attr("d", d3.line()(line)).style("stroke", colour(k)).style("stroke-width", 2.6)
          .append("title").text(tell(part, k));
        group.append("circle").attr("cx", line[0][0]).attr("cy", line[0][1]).attr("r", 2.4).style("fill", "var(--ink)");
      }),
    });
  };

  const strip = (host, trace, reference, parts, names, title) => {
    host.replaceChildren();
    const by = R.state.abscissa;
    const at = (t) => trace[by][R.placeAt(trace.t, t)];
    const distance = d3.scaleLinear(reference.t, reference.s).clamp(true);
    const [first, last] = d3.extent(trace.t);
    const times = d3.range(first, last + 1e-9, (last - first) / 400 || 1);
    const speed = times.map((t, i) => (i === 0 ? NaN : (distance(t) - distance(times[i - 1])) / (t - times[i - 1])));
    const x = { ...R.along(by), domain: [0, trace[by][trace[by].length - 1]] };
    R.caption(host, "Along the path", title);
    R.chart(host, {
      label: `Speed along ${title}`, height: 190, zoom: false, x, y: { label: "speed", unit: "m/s", domain: [0, 1.05 * (d3.max(speed) || 1)] },
      margin: { left: 110 },
      draw: (group, sx, sy) => {
        const segments = parts.find((p) => p.kind === "segment");
        for (const begin of segments ? segments.begin : []) {
          group.append("line").attr("class", "zero").attr("x1", sx(at(begin))).attr("x2", sx(at(begin))).attr("y1", -1e4).attr("y2", 1e4).style("opacity", 0.5);
        }
        group.append("path").attr("class", "curve").style("stroke", "var(--ink)")
          .attr("d", d3.line().defined((i) => Number.isFinite(speed[i])).x((i) => sx(at(times[i]))).y((i) => sy(speed[i]))(d3.range(speed.length)));
      },
    });
    R.chart(host, {
      label: `Segments and windows along ${title}`, height: 60 + 46 * parts.length, zoom: false, x, y: { band: parts.map((p) => p.kind) },
      margin: { left: 110 },
      draw: (group, sx, sy) => {
        for (const part of parts) {
          const colour = colourOf(part, names);
          part.begin.forEach((begin, k) => {
            const [from, to] = [sx(at(begin)), sx(at(part.end[k]))];
            group.append("rect").attr("x", from).attr("width", Math.max(0.5, to - from)).attr("y", sy(part.kind)).attr("height", sy.bandwidth())
              .style("fill", colour(k)).style("fill-opacity", 0.75).style("stroke", "var(--card)").style("stroke-width", 0.8)
              .append("title").text(tell(part, k));
          });
        }
      },
    });
    const counts = new Map();
    for (const part of parts) for (const what of part.what) if (what) counts.set(what, (counts.get(what) || 0) + 1);
    R.legend(host, names.map((name, i) => ({ name: `${name} (${counts.get(name)})`, color: kFamilies[i % kFamilies.length], wide: true })));
    if (parts.some((p) => p.all > p.begin.length)) R.nothing(host, "Some segments are not drawn, because there are too many.");
  };

  R.follow(() => {
    const [left, right] = [document.getElementById("cut-map"), document.getElementById("cut-strip")];
    const s = R.state.sequence;
    const m = R.methods[state.method];
    const trace = R.trace(s, m.place);
    const parts = R.cut(s, m.place);
    if (parts && !parts.some((p) => p.kind === state.kind)) state.kind = parts[0].kind;
    controls(parts || []);
    if (!trace || !parts) {
      right.replaceChildren();
      left.replaceChildren();
      return R.nothing(left, `${m.label} reported no segments.`);
    }
    const names = d3.sort(new Set(parts.flatMap((p) => p.what).filter(Boolean)));
    const title = `${m.label}, ${R.runName(s)}`;
    map(left, trace, parts.find((p) => p.kind === state.kind), names, title);
    strip(right, trace, R.reference(s), parts, names, title);
  }, "cut");
})();
