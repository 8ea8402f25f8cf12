// Frames of the two methods and of the reference: when they are asked for, and where they go.
import {remember} from "./address.js";
import {short} from "./controls.js";
import {givenSettings} from "./panes.js";
import {goodExposure} from "./pictures.js";
import {say, showReports} from "./reports.js";
import {askPicture} from "./server.js";
import {camera, film, page, reference, sides, stage, state, work} from "./state.js";
import {setExposure} from "./view.js";

let moving = false, restTimer = 0, lastInput = 0;

export function setCamera(c) {
  if (page.scene.camera.fixed) return say(`the camera cannot move: ${page.scene.camera.fixed}`);
  state.values["camera.position"] = c.position.map(short);
  state.values["camera.look_at"] = c.look_at.map(short);
  if (c.type !== "perspective") state.values["camera.height"] = short(c.height);
  moved();
}

function lightPosition(i) { return state.values[`light.${i}.position`] || page.scene.lights[i].position; }

function placeHandles() {
  stage.camera = camera();
  stage.handles = page.scene.lights.flatMap((light, i) => light.position ? [{light: i, position: lightPosition(i)}] : []);
}

// ---- frames

// Something changed: coarse frames at once, whole ones when it rests.
export function moved() {
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

// The first picture says which exposure is good. Smoke of a flow comes little by little, and makes pictures brighter.
function expose(picture) {
  const now = state.view.exposure;
  if (now !== null && (!page.flows || page.exposed)) return;
  const good = goodExposure(picture);
  if (now === null || good < now) setExposure(good);
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
      if (picture) expose(picture);
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

export function forgetReference() {
  Object.assign(reference, {known: -1, head: null});
  stage.pictures.reference = null;
  askReference();
}

// Once a second, while the page is seen: it also tells the server that somebody is here.
export async function askReference() {
  if (!page.scene || document.hidden || moving || reference.asking) return;
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
