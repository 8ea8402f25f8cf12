// The two methods and their settings.
import {$, element, fill, isRead, settingRow} from "./controls.js";
import {moved} from "./frames.js";
import {page, sides, stage, state, work} from "./state.js";

const tracedSamples = 16;  // of a path tracer in a pane, whose default would take long
const openSettings = new Set();  // sides

function paneBox(side) {
  const pane = state.panes[side], box = element("details", {open: true}, element("summary", {textContent: side}));
  box.dataset.side = side;
  const menu = element("select", {className: "method"});
  menu.setAttribute("aria-label", `method on the ${side}`);
  fill(menu, page.scene.methods.map(m => ({value: m.name, text: m.name, refused: m.refused})), pane.method);
  const method = page.scene.methods.find(m => m.name === pane.method), rows = element("div");
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

export function chooseMethod(side, name) {
  const method = page.scene.methods.find(m => m.name === name);
  state.panes[side] = {method: name, settings: name === "path_tracer" ? {samples: tracedSamples} : {}, monte_carlo: method.monte_carlo};
  stage.pictures[side] = null;
  work[side].head = null;
}

export function buildPanes() { $("panes").replaceChildren(...sides.map(paneBox)); }

export function givenSettings(pane) {
  const specs = page.scene.methods.find(m => m.name === pane.method).settings;
  return Object.fromEntries(Object.entries(pane.settings).filter(([name]) => isRead(specs.find(s => s.name === name), specs, pane.settings)));
}
