// Views: an eye, a point in the middle of the picture and the upward direction, turned and moved.

const plus = (a, b) => a.map((v, k) => v + b[k]);
const minus = (a, b) => a.map((v, k) => v - b[k]);
const times = (a, s) => a.map((v) => v * s);
const dot = (a, b) => a.reduce((sum, v, k) => sum + v * b[k], 0);
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const size = (a) => Math.hypot(...a);
const unit = (a) => times(a, 1 / (size(a) || 1));

// A vector after a turn about an axis, by the formula of Rodrigues.
function turned(v, axis, angle) {
  const [s, c] = [Math.sin(angle), Math.cos(angle)];
  return plus(plus(times(v, c), times(cross(axis, v), s)), times(axis, dot(axis, v) * (1 - c)));
}

// Around the middle, by angles to the right and upwards; not over the poles.
function orbited(gaze, axis, right, above) {
  const from = minus(gaze.eye, gaze.center);
  const side = unit(cross(gaze.up, from));
  const polar = Math.acos(Math.min(1, Math.max(-1, dot(unit(from), axis))));
  const angle = Math.min(Math.max(above, polar - Math.PI + 0.02), polar - 0.02);
  const turn = (v) => turned(turned(v, side, -angle), axis, right);
  return { eye: plus(gaze.center, turn(from)), center: gaze.center, up: turn(gaze.up) };
}

// Across the view, by parts of its distance.
function panned(gaze, right, above) {
  const from = minus(gaze.eye, gaze.center);
  const side = unit(cross(gaze.up, from));
  const up = unit(cross(from, side));
  const step = times(plus(times(side, right), times(up, above)), size(from));
  return { eye: plus(gaze.eye, step), center: plus(gaze.center, step), up: gaze.up };
}

// Nearer to the middle, or farther.
function zoomed(gaze, factor) {
  const from = times(minus(gaze.eye, gaze.center), factor);
  return { eye: plus(gaze.center, from), center: gaze.center, up: gaze.up };
}
