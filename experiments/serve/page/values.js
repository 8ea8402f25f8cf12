// Sliders of the scene: media, lights, frames of sequences.
import * as cameras from "./camera.js";
import {$, element, short, slider} from "./controls.js";
import {moved} from "./frames.js";
import {page, sides, state, work} from "./state.js";

let playing = null;  // shows the next frame of a sequence

// A row of the scene's values: a name and a slider for a number, which `set` writes into the values.
function valueRow(name, help, value, ends, limits, set, whole = false) {
  const row = element("div", {className: "setting"}, element("label", {textContent: name}));
  row.append(...slider(name, value, ends, limits, whole, x => { set(x); moved(); }), element("div", {className: "help", textContent: help}));
  return row;
}

function mediumRows(medium, i) {
  const at = key => `medium.${i}.${key}`, now = (key, start) => state.values[at(key)] ?? start, rows = [];
  const greatest = Math.max(...medium.sigma_t), brightest = Math.max(...medium.albedo);
  if (greatest > 0)
    rows.push(valueRow(`${medium.label}: extinction`, "greatest sigma_t of a channel; times the density it is the extinction in 1/m",
      Math.max(...[now("sigma_t", medium.sigma_t)].flat()), [greatest / 16, greatest * 16], [0, null],
      x => { state.values[at("sigma_t")] = medium.sigma_t.map(s => short(s / greatest * x)); }));
  rows.push(valueRow(`${medium.label}: albedo`, "share of the light that is scattered, greatest channel",
    Math.max(...[now("albedo", medium.albedo)].flat()), [0, 1], [0, 1],
    x => { state.values[at("albedo")] = medium.albedo.map(a => short(brightest > 0 ? a / brightest * x : x)); }));
  if (medium.g !== undefined)
    rows.push(valueRow(`${medium.label}: g`, "mean cosine of scattering (Henyey-Greenstein); above 0 forward",
      now("phase", {g: medium.g}).g, [-0.95, 0.95], [-0.999, 0.999], x => { state.values[at("phase")] = {type: "hg", g: x}; }));
  if (medium.frames && medium.frames[1] > medium.frames[0]) {
    const [first, last, start] = medium.frames, play = element("button", {type: "button", textContent: "play"});
    const row = valueRow(`${medium.label}: frame`, `of the sequence, ${first} to ${last}`, now("frame", start), [first, last], [first, last],
      x => { state.values[at("frame")] = x; }, true);
    play.addEventListener("click", () => {
      playing = playing ? null : () => {
        const next = now("frame", start) + 1, field = row.querySelectorAll("input")[1];
        field.value = next > last ? first : next;
        field.dispatchEvent(new Event("input"));
      };
      play.textContent = playing ? "stop" : "play";
    });
    row.append(play);
    rows.push(row);
  }
  return rows;
}

function lightRows(light, i) {
  const at = key => `light.${i}.${key}`, rows = [], name = `light ${i}, ${light.type}`;
  const key = ["intensity", "irradiance", "radiance", "scale"].find(k => light[k]), start = light[key], greatest = Math.max(...start);
  if (greatest > 0)
    rows.push(valueRow(`${name}: ${key}`, "greatest channel; the colour stays", Math.max(...[state.values[at(key)] ?? start].flat()),
      [greatest / 16, greatest * 16], [0, null], x => { state.values[at(key)] = start.map(s => short(s / greatest * x)); }));
  if (light.to_light) {
    const to = cameras.unit(state.values[at("to_light")] ?? light.to_light);
    let azimuth = Math.atan2(to[0], -to[2]), height = Math.asin(to[1]);
    const set = () => {
      state.values[at("to_light")] = [Math.cos(height) * Math.sin(azimuth), Math.sin(height), -Math.cos(height) * Math.cos(azimuth)].map(short);
    };
    rows.push(valueRow(`${name}: azimuth`, "in radians, from -z towards +x", short(azimuth), [-Math.PI, Math.PI], [-4, 4], x => { azimuth = x; set(); }),
      valueRow(`${name}: height`, "in radians above the horizon", short(height), [-Math.PI / 2, Math.PI / 2], [-1.571, 1.571],
        x => { height = x; set(); }));
  }
  if (light.turn !== undefined)
    rows.push(valueRow(`${name}: turn`, "in radians about the upward axis", short((state.values[at("rotation")] ?? {angle: light.turn}).angle),
      [-Math.PI, Math.PI], [-7, 7], x => { state.values[at("rotation")] = {axis: [0, 1, 0], angle: short(x)}; }));
  return rows;
}

export function buildValues() {
  const reset = element("button", {type: "button", textContent: "scene as in its file"});
  reset.addEventListener("click", () => {
    state.values = {};
    buildValues();
    moved();
  });
  $("values").querySelector("div").replaceChildren(...page.scene.media.flatMap(mediumRows), ...page.scene.lights.flatMap(lightRows), reset);
}

// The next frame of a sequence that plays, once both panes have drawn the last one.
export function playSequence() {
  if (playing && !document.hidden && sides.every(s => !work[s].busy)) playing();
}

export function stopSequence() { playing = null; }
