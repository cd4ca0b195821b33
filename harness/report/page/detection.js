// Precision over recall of the place recognition on the selected sequence.
(() => {
  "use strict";
  const R = window.R;
  const section = document.getElementById("detection");
  const link = document.querySelector('[data-for="detection"]');
  const curve = R.scores.kinds.map((k, place) => ({ ...k, place })).filter((k) => k.relation === "precision_at_recall");
  const first = curve.filter((k) => k.times === curve[0].times && k.protocol === curve[0].protocol && k.metric === curve[0].metric);
  if (!first.length) {
    section.hidden = true;
    link.hidden = true;
    return;
  }
  // Does not depend on the method: uses any cell of the sequence with the score.
  const valueOf = (place) => {
    const cell = R.scores.cells.find((c) => c.sequence === R.state.sequence && c.values[place]);
    return cell ? cell.values[place][0] : NaN;
  };
  const placeOf = (relation) => R.scores.kinds.findIndex((k) => k.relation === relation && k.metric === first[0].metric &&
    k.times === first[0].times && k.protocol === first[0].protocol);

  R.follow(() => {
    const host = document.getElementById("detection-curve");
    host.replaceChildren();
    const points = first.map((k) => ({ x: Number(k.axis), y: valueOf(k.place) })).filter((p) => Number.isFinite(p.y));
    const summary = ["revisits", "closures", "false_poses", "average_precision", "full_precision_recall"]
      .map((name) => `${name.replaceAll("_", " ")} ${R.number(valueOf(placeOf(name)))}`).join(", ");
    R.caption(host, `Loop detection: ${R.scores.sequences[R.state.sequence]}`, points.length ? summary : "");
    if (!points.length) return R.nothing(host, "This sequence has no loop candidates or no loops.");
    const reached = points.filter((p) => p.y > 0);
    const accepted = { x: valueOf(placeOf("recall")), y: valueOf(placeOf("precision")) };
    R.chart(host, {
      label: "Precision over recall", height: 360,
      x: { label: "recall", domain: [0, 1.02] }, y: { label: "precision", domain: [0, 1.05] },
      draw: (group, x, y) => {
        group.append("path").attr("class", "curve").style("stroke", "#0068b0")
          .attr("d", d3.line().x((p) => x(p.x)).y((p) => y(p.y))(reached));
        group.selectAll(null).data(reached).join("circle").attr("cx", (p) => x(p.x)).attr("cy", (p) => y(p.y)).attr("r", 4)
          .style("fill", "#0068b0").append("title").text((p) => `precision ${R.number(p.y)} at recall ${p.x} or more`);
        if (!Number.isFinite(accepted.x)) return;
        group.append("circle").attr("cx", x(accepted.x)).attr("cy", y(accepted.y)).attr("r", 7)
          .style("fill", "none").style("stroke", "#cc4c02").attr("stroke-width", 2.4)
          .append("title").text(`accepted closures: precision ${R.number(accepted.y)}, recall ${R.number(accepted.x)}`);
      },
    });
    R.legend(host, [{ name: "best precision at this or higher recall", color: "#0068b0" }, { name: "accepted closures (ring)", color: "#cc4c02" }]);
  });
})();
