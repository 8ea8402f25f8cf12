// What mouse, fingers and keys do to the picture.
import {remember} from "./address.js";
import * as cameras from "./camera.js";
import {$, short} from "./controls.js";
import {flow, placeOf, playOrPause, setStirs, stir} from "./flow.js";
import {moved, setCamera} from "./frames.js";
import {showPixel} from "./reports.js";
import {aspect, camera, page, stage, state} from "./state.js";
import {modes} from "./stage.js";
import {setMode, showView} from "./view.js";

const pointers = new Map();
let drag = null;

function beginDrag(event) {
  const at = stage.at(event);
  const handle = stage.handle_at(at);
  if (handle) return {what: "light", handle, at};
  if (stage.on_wipe(at)) return {what: "wipe", at};
  if (flow.stirs && event.button === 0 && !event.shiftKey && !event.ctrlKey) return {what: "stir", at, place: placeOf(at)};
  return {what: event.button === 2 || event.shiftKey ? "pan" : event.ctrlKey ? "look" : "orbit", at, pressed: at, far: false};
}

function dragTo(event) {
  const at = stage.at(event), du = at.u - drag.at.u, dv = at.v - drag.at.v, c = camera();
  drag.far = drag.far || Math.hypot(du, dv) > 0.004;
  if (drag.what === "wipe") {
    state.view.wipe = Math.min(1, Math.max(0, at.u));
    stage.draw();
    remember();
  } else if (drag.what === "stir") {
    const place = placeOf(at);
    stir(drag.place, place);
    drag.place = place;
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

export function buildPointers() {
  const canvas = $("canvas");
  let spread = null;
  canvas.addEventListener("contextmenu", event => event.preventDefault());
  canvas.addEventListener("pointerdown", event => {
    canvas.setPointerCapture(event.pointerId);
    pointers.set(event.pointerId, {x: event.clientX, y: event.clientY});
    if (!page.scene) return;
    drag = pointers.size === 1 ? beginDrag(event) : null;
    spread = pointers.size === 2 ? pinch() : null;
  });
  canvas.addEventListener("pointermove", event => {
    if (!page.scene) return;
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
    if (flow.stirs) {
      stage.flow.ball = {center: placeOf(stage.at(event)), radius: flow.radius};
      stage.draw();
    }
  });
  const end = event => {
    pointers.delete(event.pointerId);
    if (drag && !["light", "wipe", "stir"].includes(drag.what) && !drag.far && state.view.mode === "flip") setMode("flip");
    drag = null;
    spread = null;
  };
  canvas.addEventListener("pointerup", end);
  canvas.addEventListener("pointercancel", end);
  canvas.addEventListener("pointerleave", () => showPixel(null));
  canvas.addEventListener("wheel", event => {
    if (!page.scene || (document.activeElement !== canvas && !event.ctrlKey)) return;  // scrolling past must not zoom
    event.preventDefault();
    setCamera(cameras.zoom(camera(), Math.exp(Math.max(-1, Math.min(1, event.deltaY / 400)))));
  }, {passive: false});
}

const turns = {ArrowLeft: [-0.05, 0], ArrowRight: [0.05, 0], ArrowUp: [0, -0.05], ArrowDown: [0, 0.05]};
const flights = {w: [1, 0, 0], s: [-1, 0, 0], a: [0, -1, 0], d: [0, 1, 0], q: [0, 0, -1], e: [0, 0, 1]};

export function onKey(event) {
  if (!page.scene || event.ctrlKey || event.altKey || event.metaKey) return;
  const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
  const v = state.view;
  if (turns[key]) setCamera(cameras.orbit(camera(), ...turns[key]));
  else if (flights[key]) setCamera(cameras.fly(camera(), ...flights[key].map(x => 0.04 * x)));
  else if (key === " ") setMode("flip");
  else if (key === "+" || key === "=" || key === "-") {
    v.exposure = Math.max(-10, Math.min(10, (v.exposure ?? 0) + (key === "-" ? -0.25 : 0.25)));
    page.exposed = true;
    showView();
  } else if (key === "[" || key === "]") {
    v.wipe = Math.max(0, Math.min(1, v.wipe + (key === "[" ? -0.02 : 0.02)));
    stage.draw();
  } else if (key >= "1" && key <= "4") setMode(modes[key - 1]);
  else if (key === "r") {
    for (const path of Object.keys(state.values)) if (path.startsWith("camera.")) delete state.values[path];
    moved();
  } else if (key === "h") $("keys").click();
  else if (flow.about && key === "p") playOrPause();
  else if (flow.about && key === "t") setStirs(!flow.stirs);
  else return;
  event.preventDefault();
}
