// The running simulation: its controls, what the server says of it, and strokes that stir it.
import * as cameras from "./camera.js";
import {$, element, fill, short, slider} from "./controls.js";
import {moved} from "./frames.js";
import {milliseconds, say} from "./reports.js";
import {ask, askText} from "./server.js";
import {camera, aspect, stage, state} from "./state.js";
import {showText} from "./take_away.js";

// `about` is what the server says when the page begins, null without a flow; `now` its last answer.
export const flow = {about: null, now: null, stirs: false, radius: 0, speed: 0};

const paces = [["0.25", "a quarter"], ["1", "real time"], ["4", "4 times"], ["20", "20 times"], ["100", "100 times"], ["0", "as fast as it goes"]];

function button(text, about, act) {
  const made = element("button", {type: "button", textContent: text, title: about});
  made.addEventListener("click", () => Promise.resolve(act()).catch(error => say(error.message)));
  return made;
}

async function tell(what) { show(await ask("flow", {known: -1, ...what})); }

export const playOrPause = () => tell({order: flow.now && flow.now.playing ? "pause" : "play"});

export function setStirs(yes) {
  flow.stirs = yes;
  $("flow-stir").setAttribute("aria-pressed", yes);
  $("canvas").classList.toggle("stirs", yes);
  stage.flow = yes ? {lo: flow.about.lo, hi: flow.about.hi, ball: null} : null;
  stage.draw();
}

function show(now) {
  flow.now = now;
  $("flow-play").textContent = now.playing ? "pause" : "play";
  $("flow-pace").value = String(now.pace);
  $("flow-now").textContent = `${now.time.toFixed(3)} s simulated, ${now.steps} steps` +
    (now.step_seconds > 0 ? ` of ${milliseconds(now.step_seconds)} (median)` : "") + `, ${now.strokes} strokes`;
  $("flow-message").textContent = now.message || "";
}

export function buildFlow(about) {
  if (!about) return;
  flow.about = about;
  const longest = Math.max(...about.hi.map((x, i) => x - about.lo[i]));
  flow.radius = short((longest / 10).toPrecision(2));
  flow.speed = short((5 * longest / about.duration).toPrecision(2));
  const pace = element("select", {id: "flow-pace", title: "how many seconds are simulated in a second, at most"});
  fill(pace, paces.map(([value, text]) => ({value, text})), "1");
  pace.addEventListener("input", () => tell({pace: +pace.value}).catch(error => say(error.message)));
  const play = button("play", "play or pause (key P)", playOrPause), stir = button("stir", "drag to push the air (key T)", () => setStirs(!flow.stirs));
  play.id = "flow-play";
  stir.id = "flow-stir";
  stir.setAttribute("aria-pressed", "false");
  const sized = (name, value, set) => element("label", {className: "sized"}, `${name} `,
    ...slider(name, value, [value / 5, value * 5], [0, null], false, set));
  $("flow").append(element("strong", {textContent: `${about.name}, ${about.method}`}), play,
    button("step", "one step, then pause", () => tell({order: "step"})),
    button("reset", "from the start, without strokes", () => tell({order: "reset"})),
    button("replay", "from the start, with the strokes at their times", () => tell({order: "replay"})),
    element("label", {}, "pace ", pace), stir,
    sized("stroke radius [m]", flow.radius, x => { flow.radius = x; }), sized("stroke speed [m/s]", flow.speed, x => { flow.speed = x; }),
    button("copy as script", "a flow file with the strokes as forces", async () => showText(
      "A flow file with the strokes as forces. Its first lines say how `airlight simulate` runs it.", await askText("script", {scene: state.scene, values: {}}))),
    element("output", {id: "flow-now"}), element("span", {id: "flow-message", className: "refused"}));
  $("flow").hidden = false;
  // Commands and experiments read the scene file, which does not have this smoke.
  for (const id of ["copy-left", "copy-right", "copy-experiment"]) $(id).hidden = true;
  follow();
}

// Hears of every step, for as long as the page is seen.
async function follow() {
  let seen = -1;
  for (;;) {
    try {
      if (document.hidden) {
        await new Promise(done => document.addEventListener("visibilitychange", done, {once: true}));
        continue;
      }
      const now = await ask("flow", {known: seen});
      show(now);
      if (now.number !== seen && stage.camera) moved();
      seen = now.number;
    } catch {
      await new Promise(done => setTimeout(done, 1000));
    }
  }
}

// Where a pointer is in the world: on the plane through the middle of the flow's box that faces the camera.
export function placeOf(at) {
  const c = camera(), middle = cameras.times(cameras.add(flow.about.lo, flow.about.hi), 0.5);
  const depth = cameras.dot(cameras.minus(middle, c.position), cameras.frame(c).forward);
  return cameras.at_depth(c, aspect(), at.u, at.v, depth);
}

// One stroke is on its way at a time; what is drawn meanwhile is the next one.
let waiting = null, sending = false;
export async function stir(from, to) {
  waiting = {from: waiting ? waiting.from : from, to};
  if (sending) return;
  sending = true;
  try {
    while (waiting) {
      const stroke = waiting;
      waiting = null;
      await ask("stir", {...stroke, radius: flow.radius, speed: flow.speed});
    }
  } catch (error) {
    say(error.message);
  } finally {
    sending = false;
  }
}
