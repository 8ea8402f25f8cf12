// Buttons that show a text to take away.
import {remember} from "./address.js";
import {$} from "./controls.js";
import {givenSettings} from "./panes.js";
import {say} from "./reports.js";
import {askText} from "./server.js";
import {film, page, sides, state} from "./state.js";
import {command, experiment} from "./texts.js";

export function showText(about, text) {
  $("text-about").textContent = about;
  $("text-shown").value = text;
  if (!$("text").open) $("text").showModal();
  $("text-shown").select();
  if (navigator.clipboard) navigator.clipboard.writeText(text).catch(() => {});
}

export function buildTexts() {
  const on = (id, act) => $(id).addEventListener("click", () => Promise.resolve(act()).catch(error => say(error.message)));
  for (const side of sides)
    on(`copy-${side}`, () => showText("This command renders the picture; run it in the folder in which the server was started.",
      command(page.scene.file, {...state.panes[side], settings: givenSettings(state.panes[side])}, state.values, film(), side)));
  on("copy-scene", async () => showText(`A scene file with the changed values; keep it in the folder of ${page.scene.file}.`,
    await askText("text", {scene: state.scene, values: state.values})));
  on("copy-experiment", () => {
    const panes = Object.fromEntries(sides.map(s => [s, {...state.panes[s], settings: givenSettings(state.panes[s])}]));
    showText("An experiment with the two methods: a file GROUP/NAME.toml below experiments/.", experiment(page.scene, panes, state.values, film(), state.orders));
  });
  on("copy-link", () => {
    remember();
    showText("This address shows the same.", location.href);
  });
  on("keys", () => showText("Keys, while the picture has the focus", [
    "drag            orbit around the target", "right drag      pan (or with Shift)", "Ctrl drag       look around", "wheel, pinch    zoom",
    "circle          drag a light; with Shift along the view", "arrows          orbit", "W A S D Q E     fly", "+ -             exposure",
    "1 2 3 4         wipe, side by side, flip, difference", "[ ]             move the wipe", "space           flip", "R               the scene's camera",
    "P               play or pause the simulation", "T               stir it", "H               these keys"].join("\n")));
}
