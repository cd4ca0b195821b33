// Axes, grid and zoom, common to all planar figures.
(() => {
  "use strict";
  const R = window.R;
  let clips = 0;

  R.caption = (host, text, small = "") => {
    const caption = d3.select(host).insert("figcaption", ":first-child").text(text);
    if (small) caption.append("small").text(small);
  };

  // entries: {name, color, dash, wide}
  R.legend = (host, entries) => {
    const legend = d3.select(host).append("div").attr("class", "legend");
    for (const e of entries) {
      const span = legend.append("span");
      span.append("svg").attr("width", 26).attr("height", 10).style("width", "26px").attr("aria-hidden", true)
        .append("line").attr("x1", 2).attr("x2", 24).attr("y1", 5).attr("y2", 5)
        .style("stroke", e.color).attr("stroke-width", e.wide ? 5 : 2.4).attr("stroke-dasharray", e.dash || null);
      span.append("span").text(e.name);
    }
  };
  const swatch = (m) => {
    const isShown = R.state.shown.has(m.place);
    const svg = d3.create("svg").attr("width", 26).attr("height", 10).style("width", "26px").attr("aria-hidden", true);
    svg.append("line").attr("x1", 2).attr("x2", 24).attr("y1", 5).attr("y2", 5).style("stroke", isShown ? R.color(m.place) : "var(--line)")
      .attr("stroke-width", 2.4).attr("stroke-dasharray", R.dash(m.place));
    return svg.node();
  };
  // A button that draws a method or not, in all figures.
  R.switchOf = (m, text = m.label) => {
    const out = document.createElement("button");
    out.type = "button";
    out.className = "switch";
    out.dataset.method = m.place;
    const update = () => out.setAttribute("aria-pressed", R.state.shown.has(m.place));
    out.append(swatch(m), text);
    out.addEventListener("click", () => {
      const host = out.closest("figure");
      if (!R.state.shown.delete(m.place)) R.state.shown.add(m.place);
      R.changed();
      const again = host && host.querySelector(`button.switch[data-method="${m.place}"]`);  // figures are drawn anew
      if (again) again.focus({ preventScroll: true });
    });
    update();
    return out;
  };
  // All methods that have a trajectory on a sequence: those that are drawn, and those that a click draws.
  R.switches = (host, s, withReference = true) => {
    if (withReference) R.legend(host, [{ name: "reference", color: "var(--band)", wide: true }]);
    const legend = withReference ? host.lastChild : host.appendChild(Object.assign(document.createElement("div"), { className: "legend" }));
    for (const m of R.methods) if (R.trace(s, m.place)) legend.append(R.switchOf(m));
  };

  // A point {s, m, t} of a trajectory under the pointer is marked in all figures that show it.
  let marks = [];
  R.point = (point) => {
    marks = marks.filter((each) => each.node.isConnected);
    for (const each of marks) each.show(point);
  };

  R.methodLegend = (host, methods, withReference = true) => R.legend(host, [
    ...(withReference ? [{ name: "reference", color: "var(--band)", wide: true }] : []),
    ...methods.map((m) => ({ name: m.label, color: R.color(m.place), dash: R.dash(m.place) })),
  ]);

  R.padded = ([low, high], share = 0.05) => {
    const pad = (high - low) * share || Math.abs(low) * 0.1 || 1;
    return [low - pad, high + pad];
  };
  R.paddedLog = ([low, high]) => {
    const factor = Math.max(Math.pow(high / low, 0.08), 1.08);
    return [low / factor, high * factor];
  };

  // Equal scales of x and y: extends the shorter domain.
  const equalised = (x, y, width, height) => {
    const scale = Math.max((x[1] - x[0]) / width, (y[1] - y[0]) / height) || 1;
    const grown = (d, pixels) => {
      const middle = (d[0] + d[1]) / 2;
      return [middle - (scale * pixels) / 2, middle + (scale * pixels) / 2];
    };
    return [grown(x, width), grown(y, height)];
  };

  const moves = { ArrowLeft: [40, 0], ArrowRight: [-40, 0], ArrowUp: [0, 40], ArrowDown: [0, -40] };

  // The axis along the path length of the reference, or the time.
  R.along = (by) => (by === "s" ? { label: "path length of the reference", unit: "m" } : { label: "time", unit: "s" });

  // o: {label, width, height, margin, x: {label, unit, domain, log, ticks, format}, y: likewise or {band}, equal, zoom,
  // draw(group, x, y), pointer}; draw is called again at every zoom.
  R.chart = (host, o) => {
    // Uses the available width, so that text keeps its size on a phone.
    const width = o.width || Math.max(330, Math.min(600, host.clientWidth || 600));
    // On narrow screens row names are above the rows.
    const above = o.y.band !== undefined && width < 480;
    const height = above ? 60 + 36 * o.y.band.length
      : Math.round((o.height || 420) * (o.y.band ? 1 : Math.min(1, 0.3 + (0.7 * width) / 600)));
    const margin = { top: 10, right: 14, bottom: 44, left: 60, ...o.margin, ...(above ? { left: 14 } : {}) };
    const inner = { width: width - margin.left - margin.right, height: height - margin.top - margin.bottom };
    const svg = d3.select(host).append("svg").attr("viewBox", `0 0 ${width} ${height}`)
      .attr("role", "img").attr("aria-label", o.label);
    const clip = `clip-${++clips}`;
    svg.append("clipPath").attr("id", clip).append("rect").attr("width", inner.width).attr("height", inner.height);
    const root = svg.append("g").attr("transform", `translate(${margin.left},${margin.top})`);
    let [xDomain, yDomain] = [o.x.domain, o.y.domain];
    if (o.equal) [xDomain, yDomain] = equalised(xDomain, yDomain, inner.width, inner.height);
    // Long numbers, such as those of UTM, are those above an origin, which the label contains.
    const origin = (axis, domain) => {
      const range = axis.band || axis.log ? 0 : domain[1] - domain[0];
      if (!range || d3.max(domain, Math.abs) < Math.min(1e5, 1e4 * range)) return 0;
      const step = Math.pow(10, Math.floor(Math.log10(range)));
      return +(step * Math.floor(domain[0] / step)).toPrecision(9);
    };
    const [xOrigin, yOrigin] = [origin(o.x, xDomain), origin(o.y, yDomain)];
    const labelOf = (axis, from) => {
      const unit = axis.unit ? ` [${axis.unit}]` : "";
      if (!from) return axis.label + unit;
      const shift = ` ${from < 0 ? "+" : "−"} ${Math.abs(from)}`;
      return unit || !axis.label.includes(" [") ? axis.label + shift + unit : axis.label.replace(" [", shift + " [");
    };
    const numbers = (axis, s, from) => axis.format ? axis.format : axis.log ? R.number : from ? (t) => s.tickFormat(7)(t - from) : null;
    const scale = (axis, domain, range) => axis.band
      ? d3.scaleBand(axis.band, range).padding(above ? 0.5 : 0.25)
      : (axis.log ? d3.scaleLog(domain, range) : d3.scaleLinear(domain, range));
    const x0 = scale(o.x, xDomain, [0, inner.width]);
    const y0 = scale(o.y, yDomain, o.y.band ? [0, inner.height] : [inner.height, 0]);
    const grid = root.append("g").attr("class", "grid");
    root.append("rect").attr("class", "frame").attr("width", inner.width).attr("height", inner.height)
      .style("pointer-events", "all");
    const plot = root.append("g").attr("clip-path", `url(#${clip})`);
    const bottom = root.append("g").attr("class", "axis").attr("transform", `translate(0,${inner.height})`);
    const left = root.append("g").attr("class", "axis");
    root.append("text").attr("x", inner.width / 2).attr("y", inner.height + 37)
      .attr("text-anchor", "middle").text(labelOf(o.x, xOrigin));
    if (o.y.label) {
      root.append("text").attr("transform", `translate(${-margin.left + 14},${inner.height / 2}) rotate(-90)`)
        .attr("text-anchor", "middle").text(labelOf(o.y, yOrigin));
    }
    // A log axis over less than a decade has no powers of ten to label, so it gets plain ticks.
    const ticks = (s, axis, count) => {
      if (axis.ticks) return axis.ticks;
      if (!axis.log) return s.ticks(count);
      const [a, b] = s.domain();
      if (b / a < 8) return d3.scaleLinear([a, b], [0, 1]).ticks(count);
      const leading = b / a < 300 ? [1, 2, 5] : b / a < 3000 ? [1, 3] : [1];
      return s.ticks(30).filter((t) => leading.includes(Math.round(t / Math.pow(10, Math.floor(Math.log10(t) + 1e-9)))));
    };
    // Skips labels that would overlap the previous one (about 7 px per digit).
    const apart = (values, s) => {
      let end = -Infinity;
      return values.filter((t) => {
        const half = 3.5 * (o.x.log ? R.number(t) : s.tickFormat(7)(t - xOrigin)).length + 3;
        return s(t) - half >= end && ((end = s(t) + half), true);
      });
    };
    const render = (x, y) => {
      const xTicks = apart(ticks(x, o.x, Math.min(7, Math.ceil(inner.width / 60))), x);
      bottom.call(d3.axisBottom(x).tickValues(xTicks).tickFormat(numbers(o.x, x, xOrigin)).tickSizeOuter(0));
      grid.selectAll("line").remove();
      grid.selectAll(null).data(xTicks).join("line").attr("x1", (t) => x(t)).attr("x2", (t) => x(t)).attr("y2", inner.height);
      if (o.y.band) {
        left.call(d3.axisLeft(y).tickSize(0).tickPadding(8).tickFormat(o.y.name || null));
        if (above) left.raise().selectAll("text").attr("class", "halo").attr("x", 4).attr("y", -17).attr("text-anchor", "start");
      } else {
        let last = Infinity;
        const yTicks = ticks(y, o.y, 6).filter((t) => last - y(t) >= 13 && ((last = y(t)), true));
        left.call(d3.axisLeft(y).tickValues(yTicks).tickFormat(numbers(o.y, y, yOrigin)).tickSizeOuter(0));
        grid.selectAll(null).data(yTicks).join("line").attr("x2", inner.width).attr("y1", (t) => y(t)).attr("y2", (t) => y(t));
      }
      plot.selectAll("*").remove();
      o.draw(plot, x, y);
      scales = [x, y];
    };
    let scales;
    render(x0, y0);
    if (o.pointer) {
      // o.pointer: {find(px, py, x, y): point or null, at(point, x, y): [px, py] or null, text(point)}
      const mark = root.append("g").style("pointer-events", "none").attr("aria-hidden", true);
      const show = (point) => {
        mark.selectAll("*").remove();
        const at = point && o.pointer.at(point, ...scales);
        if (!at || at[0] < 0 || at[0] > inner.width || at[1] < 0 || at[1] > inner.height) return;
        mark.append("circle").attr("cx", at[0]).attr("cy", at[1]).attr("r", 5).style("fill", R.color(point.m)).style("stroke", "var(--ink)");
        const onLeft = at[0] > inner.width / 2;
        const lines = o.pointer.text(point);
        const top = Math.max(12, Math.min(inner.height - 14 * lines.length, at[1] - 8));
        lines.forEach((line, i) => mark.append("text").attr("class", "halo strong").attr("x", at[0] + (onLeft ? -10 : 10))
          .attr("y", top + 14 * i).attr("text-anchor", onLeft ? "end" : null).text(line));
      };
      marks.push({ node: svg.node(), show });
      svg.on("pointermove.point", (e) => R.point(o.pointer.find(...d3.pointer(e, root.node()), ...scales)))
        .on("pointerleave.point", () => R.point(null));
    }
    if (o.zoom) {
      const zoom = d3.zoom().scaleExtent([1, 60])
        .filter((e) => (e.type === "wheel" ? e.ctrlKey : e.touches ? e.touches.length > 1 : !e.button))
        .on("zoom", (e) => render(e.transform.rescaleX(x0), e.transform.rescaleY(y0)));
      svg.attr("tabindex", 0).attr("class", "turns").call(zoom).on("keydown", (e) => {
        if (e.key === "+" || e.key === "=") svg.call(zoom.scaleBy, 1.4);
        else if (e.key === "-") svg.call(zoom.scaleBy, 1 / 1.4);
        else if (e.key === "0") svg.call(zoom.transform, d3.zoomIdentity);
        else if (moves[e.key]) svg.call(zoom.translateBy, ...moves[e.key]);
        else return;
        e.preventDefault();
      });
    }
  };

  R.curve = (group, xs, ys, x, y, method) => group.append("path").attr("class", "curve")
    .attr("d", d3.line().defined((i) => Number.isFinite(xs[i]) && Number.isFinite(ys[i]))
      .x((i) => x(xs[i])).y((i) => y(ys[i]))(d3.range(xs.length)))
    .style("stroke", R.color(method.place)).attr("stroke-dasharray", R.dash(method.place))
    .append("title").text(method.label);

  R.nothing = (host, text) => d3.select(host).append("p").attr("class", "hint below").text(text);
})();
