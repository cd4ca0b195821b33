// Data of the report and access functions. R is the global namespace.
(() => {
  "use strict";
  const R = (window.R = window.R || {});
  const raw = JSON.parse(document.getElementById("report-data").textContent);
  R.scores = raw.scores;
  R.comparisons = raw.comparisons;
  // What the page compares: "method", or "estimate" on pages of evaluated files.
  R.word = raw.scores.word;
  R.Word = R.word[0].toUpperCase() + R.word.slice(1);
  R.methods = raw.scores.methods.map((name, m) => ({
    name, place: m, oracle: raw.scores.oracle[m], timeMark: raw.scores.stated[m] ? " (s)" : "",
    label: raw.scores.oracle[m] ? name + " (oracle)" : name,
  }));
  R.baseline = R.methods.find((m) => m.name === raw.scores.baseline) || null;

  R.unpack = (packed) => {
    const bytes = atob(packed.words);
    const out = new Float64Array(bytes.length / 2);
    for (let i = 0; i < out.length; ++i) {
      const word = bytes.charCodeAt(2 * i) | (bytes.charCodeAt(2 * i + 1) << 8);
      out[i] = word === 65535 ? NaN : packed.low + packed.step * word;
    }
    return out;
  };

  const cached = (make) => {
    const known = new Map();
    return (key) => {
      if (!known.has(key)) known.set(key, make(key));
      return known.get(key);
    };
  };

  const path = (packed) => {
    const [t, x, y, z] = ["t", "x", "y", "z"].map((axis) => R.unpack(packed[axis]));
    const s = new Float64Array(t.length); // distance travelled [m]
    for (let i = 1; i < t.length; ++i) {
      s[i] = s[i - 1] + (Math.hypot(x[i] - x[i - 1], y[i] - y[i - 1], z[i] - z[i - 1]) || 0);
    }
    return { t, x, y, z, s };
  };

  const reference = cached((s) => {
    const packed = raw.traces.sequences[s];
    return packed && { ...path(packed), runs: packed.runs };
  });
  // {t, x, y, z, s, closures} of a sequence's reference, with the closures of the selected run, their ledger
  // (text) and the keyframes before correction; or null.
  R.reference = (s) => {
    const found = reference(s);
    const run = found && (found.runs[R.state.repeat] || Object.values(found.runs)[0]);
    return found && { ...found, closures: run.closures, allClosures: run.all, ledger: run.ledger || "", keyframes: run.keyframes && path(run.keyframes) };
  };
  const grid = cached((g) => path(raw.traces.grids[g]));

  const drawn = new Map();
  const placeOf = (s, m, n) => `${s},${m},${n}`;
  const repeats = R.scores.sequences.map(() => new Set());
  raw.scores.cells.forEach((cell, i) => {
    if (!raw.traces.cells[i]) return;
    drawn.set(placeOf(cell.sequence, cell.method, cell.repeat), i);
    repeats[cell.sequence].add(cell.repeat);
  });
  // The repeats of a sequence whose trajectories are drawn.
  R.repeats = (s) => d3.sort(repeats[s]);
  const errors = cached((i) => {
    const packed = raw.traces.cells[i];
    const reference = grid(packed.grid);
    const [ex, ey, ez, a] = ["x", "y", "z", "angle"].map((axis) => R.unpack(packed[axis]));
    const plus = (u, v) => u.map((value, k) => value + v[k]);
    return {
      times: packed.times, t: reference.t, s: reference.s, ex, ey, ez, a,
      x: plus(reference.x, ex), y: plus(reference.y, ey), z: plus(reference.z, ez),
      norm: ex.map((e, k) => Math.hypot(e, ey[k], ez[k])),
      values: new Map((packed.values || []).map((each) => [`${each.name} [${each.unit}]`, R.unpack(each.v)])),
    };
  });

  // The subsampled estimate of a method on the selected run with its errors, or null.
  R.trace = (s, m) => {
    const i = drawn.get(placeOf(s, m, R.state.repeat));
    return i === undefined ? null : errors(i);
  };

  // Segments of the path reported by the method of a cell: [{kind, begin, end, what, all}], or null.
  R.cutOf = cached((i) => {
    const cell = raw.traces.cells[i];
    return (cell && cell.cut && cell.cut.map((part) => ({
      kind: part.kind, all: part.all, begin: R.unpack(part.begin), end: R.unpack(part.end), what: part.choices.map((name) => part.names[name]),
    }))) || null;
  });
  R.cut = (s, m) => {
    const i = drawn.get(placeOf(s, m, R.state.repeat));
    return i === undefined ? null : R.cutOf(i);
  };

  // Values of a score: one for each cell of the method, on one sequence or (s null) on all.
  R.values = (kind, statistic, m, s = null) => raw.scores.cells
    .filter((c) => c.method === m && (s === null || c.sequence === s) && c.values[kind] && c.values[kind][statistic] !== null)
    .map((c) => ({ value: c.values[kind][statistic], sequence: c.sequence, repeat: c.repeat, ms: c.ms }));

  // Index of the first stamp that is not before t.
  R.placeAt = (stamps, t) => Math.min(d3.bisectLeft(stamps, t), stamps.length - 1);

  // A ratio as a change: "-41 %" of 0.59.
  R.change = (ratio) => (ratio === null || !Number.isFinite(ratio) ? "-" : d3.format("+.3~g")(100 * (ratio - 1)));
  R.number = (value) => {
    if (value === null || !Number.isFinite(value)) return "-";
    return Math.abs(value) >= 1e4 || (value !== 0 && Math.abs(value) < 1e-3)
      ? value.toExponential(2) : d3.format(".4~g")(value);
  };
})();
