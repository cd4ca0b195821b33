// Points {error, ms} that no other beats: less is better. Relative differences count as none below 1e-6
// for errors and below 10 % for times, which vary between runs of a sweep.
(() => {
  "use strict";
  const less = (a, b, tie) => b - a > tie * Math.max(Math.abs(a), Math.abs(b));
  const faster = (p, q) => less(p.ms, q.ms, 0.1);
  const better = (p, q) => less(p.error, q.error, 1e-6);
  const beats = (p, q) => !faster(q, p) && !better(q, p) && (faster(p, q) || better(p, q));
  window.R.front = (points) => points.filter((p) => !points.some((q) => beats(q, p)));
})();
