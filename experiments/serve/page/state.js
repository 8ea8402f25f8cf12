// What the page knows, which its other files share.
import {$} from "./controls.js";
import {Stage} from "./stage.js";

export const sides = ["left", "right"], sources = ["left", "right", "reference"];
export const layers = ["mean", "airlight", "surface", "ambient", "transmittance"], films = [160, 320, 480, 640];

// What the address of a view keeps.
export const state = {
  scene: 0, values: {}, film: 320, orders: "all",
  panes: {left: {method: "", settings: {}}, right: {method: "", settings: {}}},
  view: {mode: "wipe", a: "left", b: "right", showA: true, exposure: null, gain: 0, relative: false, tone: "clamp", colours: false,
         layer: "mean", wipe: 0.5},
};

// The server's description of the scene, of the file as it is; names of all scene files; does a flow give the smoke, and did somebody choose
// the exposure?
export const page = {scene: null, files: [], flows: false, exposed: false};
export const work = Object.fromEntries(sides.map(s => [s, {number: 0, busy: false, still: false, again: false, head: null, latency: null}]));
export const reference = {known: -1, head: null, asking: false};
export const stage = new Stage($("canvas"), state);

export const aspect = () => page.scene ? page.scene.film.width / page.scene.film.height : 4 / 3;
export function film(part = 1) {
  const width = Math.max(16, Math.round(state.film * part));
  return {width, height: Math.max(12, Math.round(width / aspect()))};
}

export function camera() {
  const c = {...page.scene.camera};
  for (const key of ["position", "look_at", "up", "vertical_fov", "height"])
    if (state.values[`camera.${key}`] !== undefined) c[key] = state.values[`camera.${key}`];
  return c;
}
