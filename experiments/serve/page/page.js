// The page of `airlight serve`: how it begins, and how it opens a scene.
import {remembered, take} from "./address.js";
import {$, fill} from "./controls.js";
import {buildFlow, flow} from "./flow.js";
import {askReference, moved} from "./frames.js";
import {buildPanes, chooseMethod} from "./panes.js";
import {buildPointers, onKey} from "./pointers.js";
import {say, showPixel} from "./reports.js";
import {ask, leave, watch} from "./server.js";
import {aspect, films, page, reference, sides, stage, state, work} from "./state.js";
import {modes} from "./stage.js";
import {buildTexts} from "./take_away.js";
import {buildValues, playSequence, stopSequence} from "./values.js";
import {buildView, showView} from "./view.js";

async function openScene(number, given) {
  say("");
  stopSequence();
  $("scene").value = number;
  state.scene = number;
  state.values = given.values && typeof given.values === "object" ? given.values : {};
  try {
    page.scene = await ask("scene", {scene: number, values: {}});
  } catch (error) {
    return say(error.message);
  }
  stage.aspect = aspect();
  if (!given.view) {
    state.view.exposure = null;
    page.exposed = false;
  }
  const can = page.scene.methods.filter(m => !m.refused).map(m => m.name);
  const own = can.filter(name => ["fogshop", "shadow_planes", "wavelet_fog", "legendre_fluids", "compensated_ray_marching"].includes(name));
  const usual = {left: own[0] || can[0], right: ["froxel_fog", "ray_marcher"].find(name => can.includes(name)) || can[can.length - 1]};
  for (const side of sides) {
    const wanted = (given.panes && given.panes[side]) || {}, before = state.panes[side].method;
    chooseMethod(side, can.includes(wanted.method) ? wanted.method : can.includes(before) ? before : usual[side]);
    const specs = page.scene.methods.find(m => m.name === state.panes[side].method).settings;
    if (wanted.settings)
      state.panes[side].settings = Object.fromEntries(Object.entries(wanted.settings).filter(([name]) => specs.some(s => s.name === name)));
  }
  buildPanes();
  buildValues();
  showView();
  moved();
}

async function begin() {
  const given = remembered();
  take(state, given, ["film", "orders"]);
  if (!films.includes(state.film)) state.film = 320;
  if (given.view) {
    take(state.view, given.view, ["mode", "a", "b", "showA", "gain", "relative", "tone", "colours", "layer", "wipe"]);
    if (typeof given.view.exposure === "number") {
      state.view.exposure = given.view.exposure;
      page.exposed = true;
    }
  }
  buildView();
  $("scene").addEventListener("input", () => openScene(+$("scene").value, {}));
  buildTexts();
  buildPointers();
  $("canvas").addEventListener("keydown", onKey);
  showPixel(null);
  setInterval(askReference, 1000);
  setInterval(playSequence, 40);
  addEventListener("pagehide", leave);
  addEventListener("hashchange", () => location.reload());
  addEventListener("resize", () => stage.draw());
  let about;
  try {
    about = await ask("scenes", {});
  } catch (error) {
    return say(error.message);
  }
  page.files = about.scenes;
  page.flows = Boolean(about.flow);
  watch(() => { if (page.scene) moved(); });
  fill($("scene"), page.files.map((f, i) => ({value: i, text: f.split("/").pop().replace(/\.toml$/, "")})), 0);
  const file = page.files.indexOf(given.file);
  await openScene(file >= 0 ? file : 0, file >= 0 ? given : {});
  buildFlow(about.flow);
}

// For tests: what the page knows.
window.airlight = {state, stage, work, reference, modes, flow};
begin();
