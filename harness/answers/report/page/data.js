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

  // Columns as harness/sweep/model/packed_columns.hpp packs them.
  const columns = (text, count, steps) => {
    const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
    const view = new DataView(bytes.buffer);
    const rows = view.getUint32(0, true);
    let bit = 32;
    const read = (bits) => {
      let out = 0;
      for (; bits > 0; --bits, ++bit) out = 2 * out + ((bytes[bit >> 3] >> (7 - (bit & 7))) & 1);
      return out;
    };
    let first = null; // words of the first column
    return Array.from({ length: count }, () => {
      const at = (bit + 7) >> 3;
      const [low, high, order] = [view.getFloat32(at, true), view.getFloat32(at + 4, true), bytes[at + 8]];
      bit = 8 * (at + 9);
      const words = [];
      const predicted = (i) => {
        const last = i > 0 ? words[i - 1] : 0;
        if (order === 1) return last;
        const slope = last - (i > 1 ? words[i - 2] : 0);
        const [share, whole] = i > 1 && first ? [first[i] - first[i - 1], first[i - 1] - first[i - 2]] : [1, 1];
        return Math.max(0, Math.min(steps + 1, last + Math.trunc(whole ? (slope * share) / whole : slope)));
      };
      for (let [i, sum, seen] = [0, 1, 1]; i < rows; ++i) {
        let [k, ones] = [0, 0];
        while (seen * 2 ** (k + 1) <= sum) ++k;
        while (ones < 20 && read(1)) ++ones;
        const number = ones === 20 ? read(24) : ones * 2 ** k + read(k);
        [sum, seen] = seen === 7 ? [Math.floor((sum + number) / 2), 4] : [sum + number, seen + 1];
        words.push(predicted(i) + (number % 2 ? -(number + 1) / 2 : number / 2));
      }
      first = first || words;
      return Float64Array.from(words, (word) => (word ? low + (high - low) * ((word - 1) / steps) : NaN));
    });
  };
  const [kDrawnSteps, kFineSteps] = [4096, 65534];

  const path = (packed) => {
    const [t, s, x, y, z] = columns(packed, 5, kFineSteps);  // s: distance travelled [m]
    return { t, x, y, z, s };
  };

  // The columns with rows between them, so that none is farther than 1/400 of the time from the next.
  const filled = (all) => {
    const [t] = all;
    const step = (t[t.length - 1] - t[0]) / 400 || 1;
    const out = all.map((column) => [column[0]]);
    for (let i = 1; i < t.length; ++i) {
      const parts = Math.max(1, Math.ceil((t[i] - t[i - 1]) / step));
      for (let p = 1; p <= parts; ++p) all.forEach((column, c) => out[c].push(column[i - 1] * (1 - p / parts) + column[i] * (p / parts)));
    }
    return out.map((column) => Float64Array.from(column));
  };

  const reference = cached((s) => {
    const packed = raw.traces.sequences[s];
    return packed && { ...path(packed.path), runs: packed.runs };
  });
  // {t, x, y, z, s, closures} of a sequence's reference, with the closures of the selected run, their ledger
  // (text) and the keyframes before correction; or null.
  R.reference = (s) => {
    const found = reference(s);
    const run = found && (found.runs[R.state.repeat] || Object.values(found.runs)[0]);
    return found && { ...found, closures: run.closures, allClosures: run.all, ledger: run.ledger || "", keyframes: run.keyframes && path(run.keyframes) };
  };

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
    const stated = packed.values || [];
    const [t, s, x, y, z, ex, ey, ez, a, ...values] = filled([
      ...columns(packed.samples, 9, kDrawnSteps), ...stated.map((each) => columns(each.v, 1, kDrawnSteps)[0])]);
    return {
      times: packed.times, t, s, ex, ey, ez, a, x, y, z, norm: ex.map((e, k) => Math.hypot(e, ey[k], ez[k])),
      values: new Map(stated.map((each, k) => [`${each.name} [${each.unit}]`, values[k]])),
    };
  });

  // The estimate of a method on the selected run with its errors, or null.
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
