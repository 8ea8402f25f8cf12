// Cameras as scene files describe them, and how they move: {type, position, look_at, up, vertical_fov or height}.

export const add = (a, b) => a.map((x, i) => x + b[i]);
export const minus = (a, b) => a.map((x, i) => x - b[i]);
export const times = (a, f) => a.map(x => x * f);
export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
export const size = a => Math.hypot(...a);
export const unit = a => times(a, 1 / size(a));

// About a unit axis, counter-clockwise seen against it.
export function turn(v, axis, angle) {
  const c = Math.cos(angle), s = Math.sin(angle);
  return add(add(times(v, c), times(cross(axis, v), s)), times(axis, dot(axis, v) * (1 - c)));
}

export function frame(camera) {
  const forward = unit(minus(camera.look_at, camera.position)), right = unit(cross(forward, camera.up));
  return {forward, right, up: cross(right, forward)};
}

// Half of the film's height, in metres, at this distance from the camera.
function half(camera, depth) {
  return camera.type === "perspective" ? depth * Math.tan(camera.vertical_fov / 2) : camera.height / 2;
}

// Where a point is on the film: u and v in [0, 1] from the top left, and its depth; nothing behind the camera.
export function project(camera, aspect, point) {
  const f = frame(camera), from = minus(point, camera.position), depth = dot(from, f.forward);
  if (!(depth > 1e-6)) return null;
  const h = half(camera, depth);
  return {u: 0.5 + dot(from, f.right) / (2 * h * aspect), v: 0.5 - dot(from, f.up) / (2 * h), depth};
}

// The point of this depth at u and v on the film.
export function at_depth(camera, aspect, u, v, depth) {
  const ahead = add(camera.position, times(frame(camera).forward, depth));
  return add(ahead, step(camera, aspect, depth, u - 0.5, v - 0.5));
}

// The step in the world that moves a point of this depth by du and dv on the film.
export function step(camera, aspect, depth, du, dv) {
  const f = frame(camera), h = half(camera, depth);
  return add(times(f.right, 2 * h * aspect * du), times(f.up, -2 * h * dv));
}

// Keeps the view away from the upward direction, where it would turn over.
function upright(direction, up, before) {
  return Math.abs(dot(unit(direction), unit(up))) < 0.998 ? direction : before;
}

// Around the target; angles in radians.
export function orbit(camera, yaw, pitch) {
  const up = unit(camera.up);
  let from = turn(minus(camera.position, camera.look_at), up, yaw);
  from = upright(turn(from, unit(cross(up, from)), pitch), up, from);
  return {...camera, position: add(camera.look_at, from)};
}

// On the spot.
export function look(camera, yaw, pitch) {
  const up = unit(camera.up);
  let to = turn(minus(camera.look_at, camera.position), up, yaw);
  to = upright(turn(to, unit(cross(to, up)), pitch), up, to);
  return {...camera, look_at: add(camera.position, to)};
}

export function shift(camera, by) {
  return {...camera, position: add(camera.position, by), look_at: add(camera.look_at, by)};
}

export function pan(camera, aspect, du, dv) {
  return shift(camera, times(step(camera, aspect, size(minus(camera.look_at, camera.position)), du, dv), -1));
}

// Nearer to the target by this factor.
export function zoom(camera, factor) {
  if (camera.type !== "perspective") return {...camera, height: camera.height * factor};
  return {...camera, position: add(camera.look_at, times(minus(camera.position, camera.look_at), factor))};
}

// Forward, to the right and upwards, in parts of the distance to the target.
export function fly(camera, forward, right, up) {
  const f = frame(camera), distance = size(minus(camera.look_at, camera.position));
  return shift(camera, times(add(add(times(f.forward, forward), times(f.right, right)), times(unit(camera.up), up)), distance));
}
