// Controls of what is shown: comparison, exposure, tone, layer, film.
import {remember} from "./address.js";
import {$, element, fill} from "./controls.js";
import {moved} from "./frames.js";
import {tones} from "./pictures.js";
import {films, layers, page, sources, stage, state} from "./state.js";
import {modes} from "./stage.js";

// null until the first picture says which one is good.
function showExposure() {
  const value = state.view.exposure ?? 0;
  $("exposure").value = value;
  $("exposure-shown").textContent = (value > 0 ? "+" : "") + value;
}

export function setExposure(value) {
  state.view.exposure = value;
  showExposure();
}

export function showView() {
  const v = state.view;
  [...$("modes").children].forEach(button => button.setAttribute("aria-pressed", button.textContent === v.mode));
  showExposure();
  $("gain").value = v.gain;
  $("gain-shown").textContent = (v.gain > 0 ? "+" : "") + v.gain;
  $("relative").value = v.relative ? "1" : "";
  $("tone").value = v.tone;
  $("colours").checked = v.colours;
  $("layer").value = v.layer;
  $("a").value = v.a;
  $("b").value = v.b;
  stage.draw();
}

export function setMode(mode) {
  if (mode === "flip" && state.view.mode === "flip") state.view.showA = !state.view.showA;
  state.view.mode = mode;
  showView();
  remember();
}

export function buildView() {
  $("modes").append(...modes.map(mode => {
    const button = element("button", {type: "button", textContent: mode});
    button.addEventListener("click", () => setMode(mode));
    return button;
  }));
  fill($("tone"), tones.map(t => ({value: t, text: t === "clamp" ? "sRGB" : t === "aces" ? "ACES" : "AgX"})), state.view.tone);
  fill($("layer"), layers.map(l => ({value: l, text: l === "mean" ? "mean (all light)" : l})), state.view.layer);
  fill($("a"), sources.map(s => ({value: s, text: s})), state.view.a);
  fill($("b"), sources.map(s => ({value: s, text: s})), state.view.b);
  fill($("film"), films.map(f => ({value: f, text: `${f} wide`})), state.film);
  const on = (id, act) => $(id).addEventListener("input", () => { act($(id)); showView(); remember(); });
  on("exposure", e => { state.view.exposure = +e.value; page.exposed = true; });
  on("gain", e => { state.view.gain = +e.value; });
  on("tone", e => { state.view.tone = e.value; });
  on("colours", e => { state.view.colours = e.checked; });
  on("relative", e => { state.view.relative = e.value === "1"; });
  on("a", e => { state.view.a = e.value; });
  on("b", e => { state.view.b = e.value; });
  on("layer", e => { state.view.layer = e.value; moved(); });
  on("film", e => { state.film = +e.value; moved(); });
}
