// Orthographic 3-D view above the selected plane, rotated by dragging or with the arrow keys. Its axes
// are right-handed: above the plane of x and z, as in camera axes, up is -y.
(() => {
  "use strict";
  const R = window.R;
  const view = { turn: -0.65, tilt: 0.5, zoom: 1, heightScale: 1 };
  let scaledFor = null;
  const kWidth = 600, kHeight = 470;

  const draw = (svg, scene) => {
    const { middle, reference, methods, traces } = scene;
    const [ct, st, cp, sp] = [Math.cos(view.turn), Math.sin(view.turn), Math.cos(view.tilt), Math.sin(view.tilt)];
    const seen = (x, y, z) => {
      const [a, b, c] = [x - middle[0], y - middle[1], (z - middle[2]) * view.heightScale];
      const right = a * ct - b * st, deep = a * st + b * ct;
      return [right, c * cp + deep * sp];
    };
    // The bounding box fills the picture.
    const corners = d3.cross(d3.cross(scene.x, scene.y), scene.z, ([x, y], z) => seen(x, y, z));
    const scale = view.zoom * Math.min(...[[0, kWidth - 70], [1, kHeight - 60]]
      .map(([axis, pixels]) => pixels / (2 * d3.max(corners, (p) => Math.abs(p[axis])) || 1)));
    const at = (x, y, z) => {
      const [right, up] = seen(x, y, z);
      return [kWidth / 2 + scale * right, kHeight / 2 - scale * up];
    };
    const line = d3.line().defined((p) => Number.isFinite(p[0]) && Number.isFinite(p[1]));
    const along = (t) => line(Array.from(t.x, (_, i) => at(t.x[i], t.y[i], t.z[i])));
    svg.selectAll("*").remove();
    // Floor grid with the projection of the reference.
    const floor = scene.z[0];
    const grid = svg.append("g").attr("class", "grid");
    const rule = (p, q) => grid.append("line").attr("x1", p[0]).attr("y1", p[1]).attr("x2", q[0]).attr("y2", q[1]);
    const [[x1, x2], [y1, y2]] = [scene.x, scene.y];
    const step = Math.max(d3.tickStep(x1, x2, 6), d3.tickStep(y1, y2, 6));
    for (const x of d3.range(Math.ceil(x1 / step) * step, x2 + step / 2, step)) rule(at(x, y1, floor), at(x, y2, floor));
    for (const y of d3.range(Math.ceil(y1 / step) * step, y2 + step / 2, step)) rule(at(x1, y, floor), at(x2, y, floor));
    svg.append("path").attr("d", line(Array.from(reference.x, (x, i) => at(x, reference.y[i], floor))))
      .style("fill", "none").style("stroke", "var(--band)").style("opacity", 0.45);
    const ends = [];
    const axis = (to, name) => {
      const [p, q] = [at(x1, y1, floor), at(...to)];
      ends.push([p, q, name]);
      svg.append("line").attr("x1", p[0]).attr("y1", p[1]).attr("x2", q[0]).attr("y2", q[1]).style("stroke", "var(--soft)");
    };
    axis([x2, y1, floor], `${scene.names[0]}, ${R.number(step)} m per square`);
    axis([x1, y2, floor], scene.names[1]);
    axis([x1, y1, scene.z[1]], `${scene.names[2]}, ${d3.format(".2~g")(scene.z[1] - scene.z[0])} m` + (view.heightScale === 1 ? "" : ` (× ${view.heightScale})`));
    svg.append("path").attr("class", "band").attr("d", along(reference));
    methods.forEach((m, i) => svg.append("path").attr("class", "curve").attr("d", along(traces[i]))
      .style("stroke", R.color(m.place)).attr("stroke-dasharray", R.dash(m.place)).append("title").text(m.label));
    // The picture is scaled to its column, its text is not.
    const shrunk = Math.max(1, kWidth / (svg.node().clientWidth || kWidth));
    for (const [p, q, name] of ends) {
      svg.append("text").attr("class", "halo").style("font-size", `${12 * shrunk}px`).attr("x", q[0]).attr("y", q[1] + (q[1] > p[1] ? 14 : -6))
        .attr("text-anchor", q[0] > 0.8 * kWidth ? "end" : q[0] < 0.2 * kWidth ? "start" : "middle").text(name);
    }
  };

  R.follow(() => {
    const host = document.getElementById("space");
    host.replaceChildren();
    const s = R.state.sequence;
    const reference = R.reference(s);
    R.caption(host, "3-D view", R.runName(s));
    if (!reference) return R.nothing(host, "No stored trajectories of this sequence (traces: false).");
    const methods = R.shown().filter((m) => R.trace(s, m.place));
    const [a, b] = R.plane(reference);
    const c = [..."xyz"].find((axis) => axis !== a && axis !== b);
    const above = (path) => ({ x: path[a], y: path[b], z: c === "y" ? path.y.map((v) => -v) : path[c] });
    const ground = above(reference);
    const traces = methods.map((m) => above(R.trace(s, m.place)));
    const [x, y, z] = ["x", "y", "z"].map((axis) => R.extent([ground, ...traces].map((t) => t[axis])));
    const scene = {
      x, y, z, reference: ground, methods, traces, names: [a, b, c === "y" ? "-y" : c],
      middle: [x, y, z].map((d) => (d[0] + d[1]) / 2),
    };
    // Scales heights of nearly planar trajectories; the z axis shows the factor.
    if (scaledFor !== s + a + b) {
      const wide = Math.max(x[1] - x[0], y[1] - y[0]);
      view.heightScale = Math.max(1, Math.min(20, Math.round((0.15 * wide) / Math.max(z[1] - z[0], 1e-9))));
      scaledFor = s + a + b;
    }
    const svg = d3.select(host).append("svg").attr("viewBox", `0 0 ${kWidth} ${kHeight}`).attr("role", "img")
      .attr("aria-label", `Trajectories of ${R.scores.sequences[s]} in 3-D; arrow keys rotate`)
      .attr("tabindex", 0).attr("class", "turns");
    const again = () => draw(svg, scene);
    const turned = (turn, tilt) => {
      view.turn += turn;
      view.tilt = Math.max(-1.57, Math.min(1.57, view.tilt + tilt));
      again();
    };
    svg.call(d3.drag().on("drag", (e) => turned(-e.dx / 150, e.dy / 150)));
    svg.on("wheel", (e) => {
      if (!e.ctrlKey) return;
      e.preventDefault();
      view.zoom = Math.max(0.5, Math.min(30, view.zoom * Math.exp(-e.deltaY / 300)));
      again();
    });
    const keys = {
      ArrowLeft: () => turned(0.1, 0), ArrowRight: () => turned(-0.1, 0),
      ArrowUp: () => turned(0, -0.1), ArrowDown: () => turned(0, 0.1),
      "+": () => { view.zoom *= 1.25; again(); }, "-": () => { view.zoom /= 1.25; again(); },
      0: () => { Object.assign(view, { turn: -0.65, tilt: 0.5, zoom: 1 }); again(); },
    };
    svg.on("keydown", (e) => {
      if (!keys[e.key]) return;
      keys[e.key]();
      e.preventDefault();
    });
    again();
    R.switches(host, s);
    const label = d3.select(host).append("label").attr("class", "field").text("heights ×");
    label.append("input").attr("type", "range").attr("min", 1).attr("max", 20).property("value", view.heightScale)
      .on("input", (e) => { view.heightScale = Number(e.target.value); again(); });
  });
})();
