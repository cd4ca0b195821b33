// Points {error, ms} that no other beats: less is better, and relative differences below 1e-6 count
// as none.
(() => {
  "use strict";
  const less = (a, b) => b - a > 1e-6 * Math.max(Math.abs(a), Math.abs(b));
  const beats = (p, q) => !less(q.ms, p.ms) && !less(q.error, p.error) && (less(p.ms, q.ms) || less(p.error, q.error));
  window.R.front = (points) => points.filter((p) => !points.some((q) => beats(q, p)));
})();
