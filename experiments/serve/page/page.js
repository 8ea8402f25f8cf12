// The page of `airlight serve`: its state, its questions to the server, and what people do.
import * as cameras from "./camera.js";
import {$, element, fill, isRead, settingRow, short, slider} from "./controls.js";
import {goodExposure, tones} from "./pictures.js";
import {ask, askPicture, askText, leave} from "./server.js";
import {modes, Stage} from "./stage.js";
import {command, experiment} from "./texts.js";

const sides = ["left", "right"], sources = ["left", "right", "reference"];
const layers = ["mean", "airlight", "surface", "ambient", "transmittance"], films = [160, 320, 480, 640];
const tracedSamples = 16;  // of a path tracer in a pane, whose default would take long

const state = {
  scene: 0, values: {}, film: 320, orders: "all",
  panes: {left: {method: "", settings: {}}, right: {method: "", settings: {}}},
  view: {mode: "wipe", a: "left", b: "right", showA: true, exposure: null, gain: 0, relative: false, tone: "clamp", colours: false,
         layer: "mean", wipe: 0.5},
};
let scene = null;         // the server's description, of the file as it is
let files = [];
let moving = false, restTimer = 0, lastInput = 0;
const work = Object.fromEntries(sides.map(s => [s, {number: 0, busy: false, still: false, again: false, head: null, latency: null}]));
const reference = {known: -1, head: null, asking: false};
const stage = new Stage($("canvas"), state);
const openSettings = new Set();  // sides
let playing = null;  // shows the next frame of a sequence, when the panes have drawn one

// ---- what is shown

const percent = x => `${(100 * x).toPrecision(2)} %`;
const milliseconds = s => s < 0.0995 ? `${(1000 * s).toPrecision(2)} ms` : s < 10 ? `${(1000 * s).toFixed(0)} ms` : `${s.toFixed(1)} s`;

function errorText(error) {
  if (!error) return "no error: there is no reference yet";
  if (error.missing) return `no error: ${error.missing}`;
  if (error.value === null) return "no error: the reference is black";
  if (error.below_floor) return `error below noise, at most ${percent(error.high)}`;
  const [value, low, high] = [error.value, error.low, error.high].map(percent);
  return low === high ? `error ${value}` : `error ${value} (${low} to ${high})`;
}

function table(rows) {
  return element("table", {}, ...rows.map(([name, number, about, className]) => element("tr", {className: className || ""},
    element("td", {textContent: name}), element("td", {className: "number", textContent: number}), element("td", {textContent: about || ""}))));
}

function reportOf(side) {
  const box = element("section", {className: "report"}), {head, latency, failed} = work[side], pane = state.panes[side];
  box.dataset.side = side;
  box.append(element("h2", {textContent: `${side}: ${pane.method}`}));
  if (failed) box.append(element("p", {className: "refused", textContent: failed}));
  if (!head || failed) return box;
  if (head.refused) {
    box.append(element("p", {className: "refused", textContent: `cannot render this: ${head.refused}`}));
    return box;
  }
  box.append(
    element("div", {className: "error", textContent: errorText(reference.head && reference.head.errors[side])}),
    element("div", {textContent: `frame ${milliseconds(head.median.seconds)} (median of ${head.median.frames}), ` +
      `preparation ${head.prepared}, ${head.width}x${head.height} pixels`}));
  if (latency) box.append(element("div", {className: "latency", textContent: `input to picture ${milliseconds(latency.all)}: ` +
    `rendering ${milliseconds(latency.render)}, queue ${milliseconds(latency.queue)}, transport ${milliseconds(latency.transport)}, ` +
    `drawing ${milliseconds(latency.draw)}`}));
  if (head.warning) box.append(element("div", {textContent: `warning: ${head.warning}`}));
  const open = document.querySelector(`.report[data-side="${side}"] details`);
  box.append(element("details", {open: Boolean(open && open.open)}, element("summary", {textContent: "stages"}),
    table(head.times.map(t => [t.name, milliseconds(t.seconds)])),
    table(head.stages.map(s => [s.kept ? "computes" : "leaves out", s.name, s.reason, s.kept ? "" : "left-out"])),
    table(Object.entries(head.counters).map(([name, value]) => [name, short(value)]))));
  return box;
}

function reportOfReference() {
  const head = reference.head, box = element("section", {className: "report"}, element("h2", {textContent: "reference"}));
  box.dataset.side = "reference";
  if (!head) return box;
  if (head.missing) box.append(element("p", {textContent: `no reference: ${head.missing}`}));
  if (head.about) box.append(element("div", {textContent: `${head.about}, ${head.samples} samples${head.growing ? " and growing" : ""}`}));
  box.append(element("div", {textContent: "errors: relative L2 over all pixels, with their 95 % intervals"}));
  const orders = element("select");
  fill(orders, [{value: "all", text: "all orders"}, {value: "one", text: "order one"}], state.orders);
  orders.addEventListener("input", () => {
    state.orders = orders.value;
    forgetReference();
    remember();
  });
  box.append(element("label", {}, "orders of scattering ", orders));
  return box;
}

function showReports() {
  $("reports").replaceChildren(...sides.map(reportOf), reportOfReference());
}

function showPixel(at) {
  const inside = at && at.u >= 0 && at.u < 1 && at.v >= 0 && at.v < 1, lines = [];
  for (const source of inside ? sources : []) {
    const picture = stage.pictures[source];
    if (!picture) continue;
    const x = Math.floor(at.u * picture.width), y = Math.floor(at.v * picture.height), i = 3 * (y * picture.width + x);
    lines.push(`${source.padEnd(9)} (${x}, ${y})  ${[0, 1, 2].map(c => picture.values[i + c].toPrecision(4).padStart(10)).join(" ")}`);
  }
  $("pixel").textContent = lines.join("\n") || "values under the pointer: red, green, blue, linear";
}

function say(text) { $("message").textContent = text; }

// ---- the film and the camera

const aspect = () => scene ? scene.film.width / scene.film.height : 4 / 3;
function film(part = 1) {
  const width = Math.max(16, Math.round(state.film * part));
  return {width, height: Math.max(12, Math.round(width / aspect()))};
}

function camera() {
  const c = {...scene.camera};
  for (const key of ["position", "look_at", "up", "vertical_fov", "height"])
    if (state.values[`camera.${key}`] !== undefined) c[key] = state.values[`camera.${key}`];
  return c;
}

function setCamera(c) {
  if (scene.camera.fixed) return say(`the camera cannot move: ${scene.camera.fixed}`);
  state.values["camera.position"] = c.position.map(short);
  state.values["camera.look_at"] = c.look_at.map(short);
  if (c.type !== "perspective") state.values["camera.height"] = short(c.height);
  moved();
}

function lightPosition(i) { return state.values[`light.${i}.position`] || scene.lights[i].position; }

function placeHandles() {
  stage.camera = camera();
  stage.handles = scene.lights.flatMap((light, i) => light.position ? [{light: i, position: lightPosition(i)}] : []);
}

// ---- frames

// Something changed: coarse frames at once, whole ones when it rests.
function moved() {
  lastInput = performance.now();
  moving = true;
  clearTimeout(restTimer);
  restTimer = setTimeout(() => {
    moving = false;
    sides.forEach(askFrame);
    forgetReference();
    remember();
  }, 200);
  placeHandles();
  sides.forEach(askFrame);
  stage.draw();
}

function givenSettings(pane) {
  const specs = scene.methods.find(m => m.name === pane.method).settings;
  return Object.fromEntries(Object.entries(pane.settings).filter(([name]) => isRead(specs.find(s => s.name === name), specs, pane.settings)));
}

// One question of a pane is on its way at a time; a coarse one stops a whole one.
async function askFrame(side) {
  const job = work[side], pane = state.panes[side];
  if (!pane.method) return;
  if (job.busy && !(job.still && moving)) {
    job.again = true;
    return;
  }
  const number = ++job.number, still = !moving, input = lastInput, sent = performance.now();
  Object.assign(job, {busy: true, still, again: false});
  const late = setTimeout(() => { stage.notes[side] = "rendering"; stage.draw(); }, 700);
  try {
    const size = film(still ? 1 : 0.5);
    const {head, picture} = await askPicture("frame", {scene: state.scene, values: state.values, pane: side, method: pane.method,
      settings: givenSettings(pane), layer: state.view.layer, ...size});
    if (number !== job.number) return;
    const received = performance.now();
    if (!head.dropped) {
      Object.assign(job, {head, failed: ""});
      stage.pictures[side] = picture;
      stage.notes[side] = head.refused ? `cannot render this: ${head.refused}` : "";
      if (picture && state.view.exposure === null) setExposure(goodExposure(picture));
      stage.draw();
      const all = (received - sent) / 1000 - head.seconds - head.waited;
      job.latency = picture && {all: (performance.now() - input) / 1000, render: head.seconds, queue: head.waited, transport: all,
                                draw: (performance.now() - received) / 1000, still};
      showReports();
    }
  } catch (error) {
    if (number !== job.number) return;
    job.failed = error.message;
    stage.notes[side] = error.message;
    stage.draw();
    showReports();
  } finally {
    clearTimeout(late);
    if (number === job.number) {
      job.busy = false;
      if (job.again) askFrame(side);
    }
  }
}

function forgetReference() {
  Object.assign(reference, {known: -1, head: null});
  stage.pictures.reference = null;
  askReference();
}

// Once a second, while the page is seen: it also tells the server that somebody is here.
async function askReference() {
  if (!scene || document.hidden || moving || reference.asking) return;
  reference.asking = true;
  const asked = JSON.stringify([state.scene, state.values, state.film, state.orders]);
  try {
    const {head, picture} = await askPicture("reference", {scene: state.scene, values: state.values, orders: state.orders,
      known: reference.known, ...film()});
    if (asked !== JSON.stringify([state.scene, state.values, state.film, state.orders])) return;
    reference.head = head;
    if (picture) {
      stage.pictures.reference = picture;
      reference.known = head.number;
    }
    for (const side of sides)
      if (work[side].busy && stage.notes[side].startsWith("rendering") && head.progress >= 0)
        stage.notes[side] = `rendering, ${Math.round(100 * head.progress)} %`;
    stage.notes.reference = head.missing ? head.missing : "";
    stage.draw();
    showReports();
    say("");
  } catch (error) {
    say(error.message);
  } finally {
    reference.asking = false;
  }
}

// ---- controls

// null until the first picture says which one is good.
function showExposure() {
  const value = state.view.exposure ?? 0;
  $("exposure").value = value;
  $("exposure-shown").textContent = (value > 0 ? "+" : "") + value;
}

function setExposure(value) {
  state.view.exposure = value;
  showExposure();
}

function showView() {
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

function setMode(mode) {
  if (mode === "flip" && state.view.mode === "flip") state.view.showA = !state.view.showA;
  state.view.mode = mode;
  showView();
  remember();
}

function buildView() {
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
  on("exposure", e => { state.view.exposure = +e.value; });
  on("gain", e => { state.view.gain = +e.value; });
  on("tone", e => { state.view.tone = e.value; });
  on("colours", e => { state.view.colours = e.checked; });
  on("relative", e => { state.view.relative = e.value === "1"; });
  on("a", e => { state.view.a = e.value; });
  on("b", e => { state.view.b = e.value; });
  on("layer", e => { state.view.layer = e.value; moved(); });
  on("film", e => { state.film = +e.value; moved(); });
  $("scene").addEventListener("input", () => openScene(+$("scene").value, {}));
}

function paneBox(side) {
  const pane = state.panes[side], box = element("details", {open: true}, element("summary", {textContent: side}));
  box.dataset.side = side;
  const menu = element("select", {className: "method"});
  menu.setAttribute("aria-label", `method on the ${side}`);
  fill(menu, scene.methods.map(m => ({value: m.name, text: m.name, refused: m.refused})), pane.method);
  const method = scene.methods.find(m => m.name === pane.method), rows = element("div");
  const settings = element("details", {className: "settings", open: openSettings.has(side)}, element("summary", {textContent: "settings"}), rows);
  settings.addEventListener("toggle", () => { openSettings[settings.open ? "add" : "delete"](side); });
  menu.addEventListener("input", () => {
    chooseMethod(side, menu.value);
    buildPanes();
    moved();
  });
  box.append(menu, element("p", {className: "help", textContent: method ? method.about : ""}), settings);
  if (!method) return box;
  const mark = () => {
    for (const row of rows.children) {
      const spec = method.settings.find(s => s.name === row.dataset.setting), read = isRead(spec, method.settings, pane.settings);
      row.toggleAttribute("data-unread", !read);
      row.querySelectorAll("input, select").forEach(control => { control.disabled = !read; });
    }
  };
  const change = () => { mark(); moved(); };
  rows.append(...method.settings.map(spec => settingRow(spec, pane.settings, change)));
  mark();
  return box;
}

function chooseMethod(side, name) {
  const method = scene.methods.find(m => m.name === name);
  state.panes[side] = {method: name, settings: name === "path_tracer" ? {samples: tracedSamples} : {}, monte_carlo: method.monte_carlo};
  stage.pictures[side] = null;
  work[side].head = null;
}

function buildPanes() { $("panes").replaceChildren(...sides.map(paneBox)); }

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

function buildValues() {
  const reset = element("button", {type: "button", textContent: "scene as in its file"});
  reset.addEventListener("click", () => {
    state.values = {};
    buildValues();
    moved();
  });
  $("values").querySelector("div").replaceChildren(...scene.media.flatMap(mediumRows), ...scene.lights.flatMap(lightRows), reset);
}

// ---- texts to take away

function showText(about, text) {
  $("text-about").textContent = about;
  $("text-shown").value = text;
  if (!$("text").open) $("text").showModal();
  $("text-shown").select();
  if (navigator.clipboard) navigator.clipboard.writeText(text).catch(() => {});
}

function buildTexts() {
  const on = (id, act) => $(id).addEventListener("click", () => Promise.resolve(act()).catch(error => say(error.message)));
  for (const side of sides)
    on(`copy-${side}`, () => showText("This command renders the picture; run it in the folder in which the server was started.",
      command(scene.file, {...state.panes[side], settings: givenSettings(state.panes[side])}, state.values, film(), side)));
  on("copy-scene", async () => showText(`A scene file with the changed values; keep it in the folder of ${scene.file}.`,
    await askText("text", {scene: state.scene, values: state.values})));
  on("copy-experiment", () => {
    const panes = Object.fromEntries(sides.map(s => [s, {...state.panes[s], settings: givenSettings(state.panes[s])}]));
    showText("An experiment with the two methods: a file GROUP/NAME.toml below experiments/.", experiment(scene, panes, state.values, film(), state.orders));
  });
  on("copy-link", () => {
    remember();
    showText("This address shows the same.", location.href);
  });
  on("keys", () => showText("Keys, while the picture has the focus", [
    "drag            orbit around the target", "right drag      pan (or with Shift)", "Ctrl drag       look around", "wheel, pinch    zoom",
    "circle          drag a light; with Shift along the view", "arrows          orbit", "W A S D Q E     fly", "+ -             exposure",
    "1 2 3 4         wipe, side by side, flip, difference", "[ ]             move the wipe", "space           flip", "R               the scene's camera",
    "H               these keys"].join("\n")));
}

// ---- address

function remember() {
  const {panes, ...rest} = state, kept = Object.fromEntries(sides.map(s => [s, {method: panes[s].method, settings: panes[s].settings}]));
  history.replaceState(null, "", `#${encodeURIComponent(JSON.stringify({...rest, file: files[state.scene], panes: kept}))}`);
}

function remembered() {
  try {
    const found = JSON.parse(decodeURIComponent(location.hash.slice(1)));
    return found && typeof found === "object" ? found : {};
  } catch {
    return {};
  }
}

// Takes what has the right type.
function take(into, from, keys) {
  for (const key of keys) if (from && typeof from[key] === typeof into[key]) into[key] = from[key];
}

// ---- scenes

async function openScene(number, given) {
  say("");
  playing = null;
  $("scene").value = number;
  state.scene = number;
  state.values = given.values && typeof given.values === "object" ? given.values : {};
  try {
    scene = await ask("scene", {scene: number, values: {}});
  } catch (error) {
    return say(error.message);
  }
  stage.aspect = aspect();
  if (!given.view) state.view.exposure = null;
  const can = scene.methods.filter(m => !m.refused).map(m => m.name);
  const own = can.filter(name => ["fogshop", "shadow_planes", "wavelet_fog", "legendre_fluids", "compensated_ray_marching"].includes(name));
  const usual = {left: own[0] || can[0], right: ["froxel_fog", "ray_marcher"].find(name => can.includes(name)) || can[can.length - 1]};
  for (const side of sides) {
    const wanted = (given.panes && given.panes[side]) || {}, before = state.panes[side].method;
    chooseMethod(side, can.includes(wanted.method) ? wanted.method : can.includes(before) ? before : usual[side]);
    const specs = scene.methods.find(m => m.name === state.panes[side].method).settings;
    if (wanted.settings)
      state.panes[side].settings = Object.fromEntries(Object.entries(wanted.settings).filter(([name]) => specs.some(s => s.name === name)));
  }
  buildPanes();
  buildValues();
  showView();
  moved();
}

// ---- pointers and keys

const pointers = new Map();
let drag = null;

function beginDrag(event) {
  const at = stage.at(event);
  const handle = stage.handle_at(at);
  if (handle) return {what: "light", handle, at};
  if (stage.on_wipe(at)) return {what: "wipe", at};
  return {what: event.button === 2 || event.shiftKey ? "pan" : event.ctrlKey ? "look" : "orbit", at, pressed: at, far: false};
}

function dragTo(event) {
  const at = stage.at(event), du = at.u - drag.at.u, dv = at.v - drag.at.v, c = camera();
  drag.far = drag.far || Math.hypot(du, dv) > 0.004;
  if (drag.what === "wipe") {
    state.view.wipe = Math.min(1, Math.max(0, at.u));
    stage.draw();
    remember();
  } else if (drag.what === "light") {
    const depth = cameras.project(c, aspect(), drag.handle.position)?.depth;
    if (!depth) return;
    const by = event.shiftKey ? cameras.times(cameras.frame(c).forward, -2 * dv * depth) : cameras.step(c, aspect(), depth, du, dv);
    drag.handle.position = cameras.add(drag.handle.position, by);
    state.values[`light.${drag.handle.light}.position`] = drag.handle.position.map(short);
    moved();
  } else if (drag.what === "pan") {
    setCamera(cameras.pan(c, aspect(), du, dv));
  } else {
    setCamera(cameras[drag.what](c, -3 * du * (drag.what === "look" ? -0.5 : 1), 3 * dv * (drag.what === "look" ? 0.5 : -1)));
  }
  drag.at = at;
}

function pinch() {
  const [a, b] = [...pointers.values()];
  return {distance: Math.hypot(a.x - b.x, a.y - b.y), x: (a.x + b.x) / 2, y: (a.y + b.y) / 2};
}

function buildPointers() {
  const canvas = $("canvas");
  let spread = null;
  canvas.addEventListener("contextmenu", event => event.preventDefault());
  canvas.addEventListener("pointerdown", event => {
    canvas.setPointerCapture(event.pointerId);
    pointers.set(event.pointerId, {x: event.clientX, y: event.clientY});
    if (!scene) return;
    drag = pointers.size === 1 ? beginDrag(event) : null;
    spread = pointers.size === 2 ? pinch() : null;
  });
  canvas.addEventListener("pointermove", event => {
    if (!scene) return;
    if (pointers.has(event.pointerId)) pointers.set(event.pointerId, {x: event.clientX, y: event.clientY});
    if (spread && pointers.size === 2) {
      const now = pinch(), box = canvas.getBoundingClientRect();
      setCamera(cameras.pan(cameras.zoom(camera(), spread.distance / Math.max(1, now.distance)), aspect(),
        (now.x - spread.x) / box.width, (now.y - spread.y) / box.height));
      spread = now;
    } else if (drag) {
      dragTo(event);
    }
    showPixel(stage.at(event));
  });
  const end = event => {
    pointers.delete(event.pointerId);
    if (drag && drag.what !== "light" && drag.what !== "wipe" && !drag.far && state.view.mode === "flip") setMode("flip");
    drag = null;
    spread = null;
  };
  canvas.addEventListener("pointerup", end);
  canvas.addEventListener("pointercancel", end);
  canvas.addEventListener("pointerleave", () => showPixel(null));
  canvas.addEventListener("wheel", event => {
    if (!scene || (document.activeElement !== canvas && !event.ctrlKey)) return;  // scrolling past must not zoom
    event.preventDefault();
    setCamera(cameras.zoom(camera(), Math.exp(Math.max(-1, Math.min(1, event.deltaY / 400)))));
  }, {passive: false});
}

const turns = {ArrowLeft: [-0.05, 0], ArrowRight: [0.05, 0], ArrowUp: [0, -0.05], ArrowDown: [0, 0.05]};
const flights = {w: [1, 0, 0], s: [-1, 0, 0], a: [0, -1, 0], d: [0, 1, 0], q: [0, 0, -1], e: [0, 0, 1]};

function onKey(event) {
  if (!scene || event.ctrlKey || event.altKey || event.metaKey) return;
  const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
  const v = state.view;
  if (turns[key]) setCamera(cameras.orbit(camera(), ...turns[key]));
  else if (flights[key]) setCamera(cameras.fly(camera(), ...flights[key].map(x => 0.04 * x)));
  else if (key === " ") setMode("flip");
  else if (key === "+" || key === "=" || key === "-") {
    v.exposure = Math.max(-10, Math.min(10, (v.exposure ?? 0) + (key === "-" ? -0.25 : 0.25)));
    showView();
  } else if (key === "[" || key === "]") {
    v.wipe = Math.max(0, Math.min(1, v.wipe + (key === "[" ? -0.02 : 0.02)));
    stage.draw();
  } else if (key >= "1" && key <= "4") setMode(modes[key - 1]);
  else if (key === "r") {
    for (const path of Object.keys(state.values)) if (path.startsWith("camera.")) delete state.values[path];
    moved();
  } else if (key === "h") $("keys").click();
  else return;
  event.preventDefault();
}

// ---- begin

async function begin() {
  const given = remembered();
  take(state, given, ["film", "orders"]);
  if (!films.includes(state.film)) state.film = 320;
  if (given.view) {
    take(state.view, given.view, ["mode", "a", "b", "showA", "gain", "relative", "tone", "colours", "layer", "wipe"]);
    if (typeof given.view.exposure === "number") state.view.exposure = given.view.exposure;
  }
  buildView();
  buildTexts();
  buildPointers();
  $("canvas").addEventListener("keydown", onKey);
  showPixel(null);
  setInterval(askReference, 1000);
  setInterval(() => { if (playing && !document.hidden && sides.every(s => !work[s].busy)) playing(); }, 40);
  addEventListener("pagehide", leave);
  addEventListener("hashchange", () => location.reload());
  addEventListener("resize", () => stage.draw());
  try {
    files = (await ask("scenes", {})).scenes;
  } catch (error) {
    return say(error.message);
  }
  fill($("scene"), files.map((f, i) => ({value: i, text: f.split("/").pop().replace(/\.toml$/, "")})), 0);
  const file = files.indexOf(given.file);
  await openScene(file >= 0 ? file : 0, file >= 0 ? given : {});
}

// For tests: what the page knows.
window.airlight = {state, stage, work, reference, modes};
begin();
