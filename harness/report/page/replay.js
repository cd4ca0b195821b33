// What replayed methods knew over time: a slider moves through it.
(() => {
  "use strict";
  const R = window.R;
  const section = document.getElementById("replay");
  if (!R.scores.sequences.some((_, s) => R.methods.some((m) => R.replay(s, m.place)))) {
    section.hidden = true;
    document.querySelector('[data-for="replay"]').hidden = true;
    return;
  }
  const kSteps = 200;
  const kFrame = 60; // [ms] between steps while it plays
  let step = kSteps;
  let redraw = () => {};
  let timer = null;

  // The trajectory known at time t: poses of the last snapshot before it, up to that time.
  const knownAt = (replay, t) => {
    const snapshot = replay.known.findLast((each) => each.time <= t) || replay.known[0];
    const count = d3.bisectRight(snapshot.t, t);
    return { path: snapshot, count };
  };

  const slider = Object.assign(document.createElement("input"), { type: "range", min: 0, max: kSteps, value: kSteps, id: "replay-time" });
  slider.setAttribute("aria-label", "Time");
  const play = Object.assign(document.createElement("button"), { type: "button", textContent: "Play" });
  const shown = document.createElement("output");
  const stop = () => { clearInterval(timer); timer = null; play.textContent = "Play"; };
  const go = (to) => { step = Math.max(0, Math.min(kSteps, to)); slider.value = step; redraw(); };
  slider.addEventListener("input", () => { stop(); go(Number(slider.value)); });
  play.addEventListener("click", () => {
    if (timer) return stop();
    if (step === kSteps) go(0);
    play.textContent = "Pause";
    timer = setInterval(() => { go(step + 1); if (step === kSteps) stop(); }, kFrame);
  });
  document.getElementById("replay-controls").append(play, slider, shown);

  R.follow(() => {
    const [map, chart] = ["replay-map", "replay-error"].map((id) => document.getElementById(id));
    [map, chart].forEach((host) => host.replaceChildren());
    const s = R.state.sequence;
    const reference = R.reference(s);
    const methods = R.shown().filter((m) => R.replay(s, m.place));
    R.caption(map, "Known at the time", R.scores.sequences[s]);
    redraw = () => {};
    if (!reference || !methods.length) return R.nothing(map, "None of the selected methods was replayed on this sequence.");
    const replays = methods.map((m) => R.replay(s, m.place));
    const [a, b] = R.plane(reference);
    const all = (axis) => R.padded(R.extent([reference[axis], ...replays.flatMap((r) => r.known.map((each) => each[axis]))]));
    const [begin, end] = R.extent(replays.map((r) => r.known[r.known.length - 1].t));
    const layers = [];
    R.chart(map, {
      label: `Trajectories known at the time, plane ${a}, ${b}`, height: 440, equal: true, zoom: true,
      x: { label: `${a} [m]`, domain: all(a) }, y: { label: `${b} [m]`, domain: all(b) },
      draw: (group, x, y) => {
        group.append("path").attr("class", "band").attr("d", d3.line().x((i) => x(reference[a][i])).y((i) => y(reference[b][i]))(d3.range(reference.t.length)));
        layers[0] = { group: group.append("g"), x, y };
        redraw();
      },
    });
    R.methodLegend(map, methods);
    R.caption(chart, "Position error", "solid: as known at the time; dotted: last trajectory");
    const errors = methods.map((m) => R.trace(s, m.place));
    const most = d3.max([...replays.map((r) => d3.max(r.error) || 0), ...errors.map((t) => (t ? d3.max(t.norm) : 0))]) || 1;
    R.chart(chart, {
      label: "Position error over time, as known at the time and at the end", height: 440, zoom: true,
      x: { label: "time [s]", domain: [begin, end] }, y: { label: "error [m]", domain: [0, 1.05 * most] },
      draw: (group, x, y) => {
        methods.forEach((m, i) => {
          R.curve(group, replays[i].t, replays[i].error, x, y, m);
          if (!errors[i]) return;
          group.append("path").attr("class", "curve").style("stroke", R.color(m.place)).style("stroke-dasharray", "1.5 4").style("opacity", 0.9)
            .attr("d", d3.line().defined((k) => Number.isFinite(errors[i].norm[k])).x((k) => x(errors[i].t[k])).y((k) => y(errors[i].norm[k]))(d3.range(errors[i].t.length)));
        });
        layers[1] = { line: group.append("line").attr("class", "loop").attr("y1", -1e4).attr("y2", 1e4), x };
        redraw();
      },
    });
    redraw = () => {
      const t = begin + ((end - begin) * step) / kSteps;
      shown.textContent = `${R.number(t)} s`;
      if (layers[0]) {
        const { group, x, y } = layers[0];
        group.selectAll("*").remove();
        methods.forEach((m, i) => {
          const { path, count } = knownAt(replays[i], t);
          if (!count) return;
          R.curve(group, path[a].slice(0, count), path[b].slice(0, count), x, y, m);
          group.append("circle").attr("cx", x(path[a][count - 1])).attr("cy", y(path[b][count - 1])).attr("r", 4.5).style("fill", R.color(m.place));
        });
      }
      if (layers[1]) layers[1].line.attr("x1", layers[1].x(t)).attr("x2", layers[1].x(t));
    };
    redraw();
  });
})();
