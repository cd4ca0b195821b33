// What the loop closures of the selected run state about each other: verdict, map, and rows, the most suspicious first.
(() => {
  "use strict";
  const R = window.R;
  const ledgers = R.scores.sequences.map((_, s) => R.reference(s)).filter((each) => each && each.ledger);
  if (!ledgers.length) return R.hide("closures");

  // The colours of `loops --plot`.
  const kinds = { disagrees: ["disagrees", "#7d1d6f"], unchecked: ["cannot be checked", "#efb400"], agrees: ["agrees", "#2aa59a"] };
  const color = (kind) => d3.interpolateRgb(kinds[kind][1], "#fff")(R.dark.matches ? 0.35 : 0);
  const number = (text) => (text === "" ? "-" : d3.format(text < 1 ? ".3f" : text < 10 ? ".2f" : text < 100 ? ".1f" : ".0f")(text));
  // An id can have more digits than a number.
  const keyframe = (text) => (/^-?\d+$/.test(text) ? text : +Number(text).toFixed(3));
  const name = (row) => [row.from, row.to].map(keyframe).join(" → ");
  const of = (column) => (row) => number(row[column]);
  const columns = [
    ["closure", name], ["judgement", (row) => kinds[row.judgement][0]],
    ["place", (row) => row.place], ["loop [m]", of("loop_m")],
    ["odometry [m]", of("odometry_m")], ["[deg]", of("odometry_deg")], ["[sd]", of("odometry_sd")],
    ["others [m]", of("others_m")], ["[deg]", of("others_deg")], ["[sd]", of("others_sd")],
    ["moves rms [m]", of("moves_rms_m")], ["max [m]", of("moves_max_m")], ["at", (row) => keyframe(row.moves_max_at)],
    ["chi2 drop", of("chi2_drop")],
  ];

  const map = (host, { keyframes, closures }, rows) => {
    const [a, b] = R.plane(keyframes);
    const curve = d3.line().x((i) => i[0]).y((i) => i[1]);
    R.chart(host, {
      label: "Keyframes with loop closures, coloured by what the others state", height: 470, equal: true, zoom: true,
      x: { label: a, unit: "m", domain: R.padded(R.extent([keyframes[a]])) }, y: { label: b, unit: "m", domain: R.padded(R.extent([keyframes[b]])) },
      draw: (group, x, y) => {
        const at = (i) => [x(keyframes[a][i]), y(keyframes[b][i])];
        group.append("path").attr("class", "band").style("stroke-width", 2).attr("d", curve(d3.range(keyframes.t.length).map(at)));
        for (const row of [...rows].reverse()) {
          const ends = closures[row.closure].map((t) => at(R.placeAt(keyframes.t, t)));
          const loop = group.append("g").attr("class", "loop").style("stroke", color(row.judgement));
          loop.append("path").attr("d", curve(ends));
          loop.selectAll("circle").data(ends).join("circle").attr("cx", (p) => p[0]).attr("cy", (p) => p[1]).attr("r", 3);
          loop.append("title").text(`${name(row)}: ${kinds[row.judgement][0]}`);
        }
      },
    });
    R.legend(host, Object.keys(kinds).filter((kind) => rows.some((row) => row.judgement === kind)).map((kind) => ({ name: kinds[kind][0], color: color(kind) })));
  };

  const table = (host, rows) => {
    const box = d3.select(host).append("div").attr("class", "scroll").attr("tabindex", 0);
    const body = box.append("table");
    body.append("thead").append("tr").selectAll("th").data(columns).join("th").attr("scope", "col").text(([name]) => name);
    for (const row of rows) {
      const line = body.append("tbody").append("tr");
      columns.forEach(([, text], i) => line.append(i ? "td" : "th").text(text(row)));
    }
    R.nothing(host, "place: closures whose ends are within 20 keyframes of those of its first closure; odometry: distance and angle between the closure and the odometry between its keyframes; others: the same to the solution with the closures of other places that agree; [sd]: stated standard deviations; moves: change of the positions without the closure; chi2 drop: decrease of the cost without it.");
  };

  R.follow(() => {
    const [host, list] = ["closures-map", "closures-rows"].map((id) => document.getElementById(id));
    [host, list].forEach((each) => each.replaceChildren());
    const run = R.reference(R.state.sequence);
    const [sentence, ...lines] = ((run && run.ledger) || "No loop closures.").split("\n");
    document.getElementById("closures-verdict").textContent = sentence;
    const [header, ...values] = lines.filter(Boolean).map((line) => line.split(","));
    if (!values.length) return;
    const rows = values.map((row) => Object.fromEntries(header.map((column, i) => [column, row[i]])));
    R.caption(host, "Keyframes before correction", R.runName(R.state.sequence));
    map(host, run, rows);
    table(list, rows);
  }, "closures");
})();
