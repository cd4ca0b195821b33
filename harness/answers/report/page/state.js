// Selection: one sequence, one score, some methods. Controls set it, figures are redrawn.
(() => {
  "use strict";
  const R = window.R;
  // Dashes by number, so that a method has the same style in the figures of `plot`.
  const kDashes = [null, "7 3", "2 2", "9 3 2 3", "9 3 2 3 2 3"];
  R.dark = matchMedia("(prefers-color-scheme: dark)");
  R.color = (m) => d3.interpolateRgb(R.scores.styles[m].color, "#fff")(R.dark.matches ? 0.35 : 0);
  R.dash = (m) => kDashes[R.scores.styles[m].dash - 1];

  const kinds = R.scores.kinds;
  const wanted = (k) => (k.metric.startsWith("ate") && k.relation === "translation" ? 4 : 0) +
    (k.axis === "3d" ? 2 : 0) + (k.times === "dense" ? 1 : 0);
  const kind = kinds.reduce((best, k, i) => (best < 0 || wanted(k) > wanted(kinds[best]) ? i : best), -1);

  R.comparison = (place) => {
    const k = kinds[place];
    return k && R.comparisons.find((c) => c.label === k.metric &&
      ["protocol", "times", "relation", "axis", "unit"].every((key) => c[key] === k[key])) || null;
  };

  // The best methods by the selected score, after the baseline.
  R.bestFew = () => {
    const comparison = R.comparison(R.state.kind);
    const ranked = (comparison ? comparison.methods : []).map((m) => R.methods.findIndex((method) => method.name === m.method));
    const base = R.baseline ? [R.baseline.place] : [];
    return [...base, ...ranked.filter((m) => !base.includes(m)).slice(0, 4)];
  };

  // The baseline, the best method, then the best without a smoother, as in `plot`.
  const shown = R.scores.default_methods;
  const best = shown.find((m) => !R.baseline || m !== R.baseline.place);
  const defaultState = {
    sequence: 0, repeat: 0, kind, statistic: 0, abscissa: "s", plane: "", shown: new Set(shown),
    before: R.baseline ? R.baseline.place : 0, after: best === undefined ? 0 : best,
  };

  // A link contains the selection by names, in the fragment: report.html#sequence=driving&method=raw.
  // ?sequence=driving selects that sequence, too.
  const kindName = (place) => (kinds[place] ? ["protocol", "times", "metric", "relation", "axis"].map((key) => kinds[place][key]).join("/") : "");
  const names = {
    sequence: R.scores.sequences, kind: kinds.map((_, i) => kindName(i)), statistic: R.scores.statistics,
    before: R.methods.map((m) => m.name), after: R.methods.map((m) => m.name),
  };
  const planes = ["", "xy", "xz", "yz"];
  const link = new URLSearchParams(location.hash.slice(1));
  const query = new URLSearchParams(location.search).get("sequence");
  if (query !== null && !link.has("sequence")) link.set("sequence", query);
  R.state = { ...defaultState };
  for (const [key, known] of Object.entries(names)) {
    const place = known.indexOf(link.get(key));
    if (link.has(key) && place >= 0) R.state[key] = place;
  }
  if (link.get("along") === "t") R.state.abscissa = "t";
  if (planes.includes(link.get("plane"))) R.state.plane = link.get("plane");
  if (/^[0-9]+$/.test(link.get("repeat"))) R.state.repeat = Number(link.get("repeat"));
  if (link.has("method")) {
    const places = link.getAll("method").map((name) => names.before.indexOf(name)).filter((m) => m >= 0);
    R.state.shown = new Set(places);
  }
  R.section = link.get("at") || (document.getElementById(location.hash.slice(1)) ? location.hash.slice(1) : "");
  R.link = () => {
    const out = new URLSearchParams();
    for (const [key, known] of Object.entries(names)) {
      if (R.state[key] !== defaultState[key]) out.set(key, known[R.state[key]]);
    }
    if (R.state.abscissa !== defaultState.abscissa) out.set("along", R.state.abscissa);
    if (R.state.plane !== defaultState.plane) out.set("plane", R.state.plane);
    if (R.state.repeat !== 0) out.set("repeat", R.state.repeat);
    const isDefault = R.state.shown.size === shown.length && shown.every((m) => R.state.shown.has(m));
    if (!isDefault) {
      if (!R.state.shown.size) out.append("method", "");
      for (const m of R.shown()) out.append("method", m.name);
    }
    if (R.section) out.set("at", R.section);
    return "#" + out.toString();
  };
  // Falls back to the first repeat.
  R.keepRepeat = () => {
    const own = R.repeats(R.state.sequence);
    if (!own.includes(R.state.repeat)) R.state.repeat = own.length ? own[0] : 0;
  };
  R.keepRepeat();
  // "room" or "room (repeat 2)" as in tables, counted from 0.
  R.runName = (s) => R.scores.sequences[s] + (R.state.repeat > 0 ? ` (repeat ${R.state.repeat})` : "");
  R.defaultMethods = shown;
  R.planes = planes;
  R.shown = () => R.methods.filter((m) => R.state.shown.has(m.place));
  R.kindLabel = (k, times = true) => `${k.label} ${R.scores.statistics[R.state.statistic]}` +
    (k.unit ? ` [${k.unit}]` : "") + (times ? `, ${k.times}` : "");

  // A section without content, and its link.
  R.hide = (id) => document.querySelectorAll(`#${id}, nav a[href="#${id}"]`).forEach((each) => (each.hidden = true));
  // What is folded is drawn when it is opened.
  const followers = [];
  const folds = [...document.querySelectorAll("main > details")];
  const drawIn = (fold) => followers.forEach((each) => each.fold === fold && each.draw());
  for (const fold of folds) fold.addEventListener("toggle", () => fold.open && drawIn(fold));
  R.follow = (draw, id = "") => followers.push({ draw, fold: id ? document.getElementById(id) : null });
  R.changed = () => {
    R.keepRepeat();
    for (const fold of [null, ...folds.filter((each) => each.open)]) drawIn(fold);
    if (R.link() !== (location.hash || "#")) history.replaceState(null, "", R.link());
  };
})();
