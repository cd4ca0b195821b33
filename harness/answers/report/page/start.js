// Controls and the first drawing; loaded last, after all figures are registered.
(() => {
  "use strict";
  const R = window.R;
  const form = document.getElementById("controls");
  const element = (tag, properties = {}, ...children) => {
    const out = Object.assign(document.createElement(tag), properties);
    out.append(...children);
    return out;
  };
  const choice = (text, entries, chosen, set) => {
    const select = element("select", {}, ...entries.map(([value, name]) => element("option", { value, textContent: name, selected: String(value) === String(chosen) })));
    select.addEventListener("change", () => { set(select.value); R.changed(); });
    return element("label", { className: "field" }, text, select);
  };
  const indexed = (names) => names.map((name, i) => [i, name]);
  const manyProtocols = new Set(R.scores.kinds.map((k) => k.protocol)).size > 1;
  const kindName = (k) => `${k.label}${k.unit ? ` [${k.unit}]` : ""}, ${k.times}` + (manyProtocols ? `, ${k.protocol}` : "");
  const state = R.state;
  const row = element("div", { className: "row" },
    choice("Sequence", indexed(R.scores.sequences), state.sequence, (v) => (state.sequence = Number(v))),
    choice("Score", indexed(R.scores.kinds.map(kindName)), state.kind, (v) => (state.kind = Number(v))),
    choice("Statistic", indexed(R.scores.statistics), state.statistic, (v) => (state.statistic = Number(v))),
    choice("Along", [["s", "path"], ["t", "time"]], state.abscissa, (v) => (state.abscissa = v)),
    choice("Plane", R.planes.map((p) => [p, p ? [...p].join(", ") : "largest extent"]), state.plane, (v) => (state.plane = v)));
  form.append(row);
  // Choice of repeat, if the page has trajectories of several.
  const repeat = element("select");
  repeat.addEventListener("change", () => { state.repeat = Number(repeat.value); R.changed(); });
  const repeatField = element("label", { className: "field" }, "Repeat", repeat);
  row.children[1].after(repeatField);
  R.follow(() => {
    const own = R.repeats(state.sequence);
    repeatField.hidden = own.length < 2;
    repeat.replaceChildren(...own.map((n) => element("option", { value: n, textContent: n, selected: n === state.repeat })));
  });

  const chips = element("div", { className: "chips" });
  const summary = element("summary");
  const boxes = R.methods.map((m) => {
    const box = element("input", { type: "checkbox", checked: state.shown.has(m.place) });
    box.addEventListener("change", () => {
      if (box.checked) state.shown.add(m.place); else state.shown.delete(m.place);
      R.changed();
    });
    chips.append(element("label", {}, box, m.label));
    return box;
  });
  const set = (places) => {
    state.shown = new Set(places);
    R.changed();
  };
  const button = (text, places) => {
    const out = element("button", { type: "button", textContent: text });
    out.addEventListener("click", () => set(places()));
    return out;
  };
  const all = R.methods.map((m) => m.place);
  const details = element("details", {}, summary,
    element("div", { className: "row" }, button("best few", R.bestFew), button("all", () => all), button("none", () => []),
      button("default", () => R.defaultMethods)), chips);
  form.append(details);
  form.addEventListener("submit", (e) => e.preventDefault());
  R.follow(() => {
    const drawn = R.shown().map((m) => m.label);
    const more = drawn.length > 5 ? ` and ${drawn.length - 5} more` : "";
    summary.textContent = `${R.Word}s drawn (${drawn.length} of ${R.methods.length}): ${drawn.slice(0, 5).join(", ") || "none"}${more}`;
    boxes.forEach((box, m) => (box.checked = state.shown.has(m)));
    boxes.forEach((box, m) => (box.style.accentColor = state.shown.has(m) ? R.color(m) : ""));
  });
  form.hidden = false;

  const names = indexed(R.methods.map((m) => m.label));
  const pair = document.getElementById("before-after-controls");
  const put = () => {
    const swap = element("button", { type: "button", textContent: "Swap" });
    swap.addEventListener("click", () => {
      [state.before, state.after] = [state.after, state.before];
      put();
      R.changed();
    });
    pair.replaceChildren(
      choice("Left", names, state.before, (v) => (state.before = Number(v))),
      choice("Right", names, state.after, (v) => (state.after = Number(v))), swap);
  };
  if (names.length > 1) put();
  if (!R.scores.sequences.some((_, s) => R.repeats(s).length)) ["trajectories", "before-after", "along"].forEach(R.hide);
  R.changed();
  // Links between sections keep the selection in the address.
  const show = (name) => {
    R.section = name;
    const target = document.getElementById(name);
    target.open = true;
    target.scrollIntoView();
    history.replaceState(null, "", R.link());
  };
  for (const link of document.querySelectorAll('a[href^="#"]')) {
    link.addEventListener("click", (event) => {
      event.preventDefault();
      show(link.getAttribute("href").slice(1));
    });
  }
  addEventListener("beforeprint", () => {
    for (const fold of document.querySelectorAll("main > details")) fold.open = true;
    R.changed();
  });
  if (R.section && document.getElementById(R.section)) show(R.section);
  document.documentElement.dataset.drawn = "yes";
})();
