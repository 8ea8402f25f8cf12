// Texts below the pictures: errors, times, stages; values under the pointer; messages.
import {$, element, fill, short} from "./controls.js";
import {remember} from "./address.js";
import {forgetReference} from "./frames.js";
import {reference, sides, sources, stage, state, work} from "./state.js";

const percent = x => `${(100 * x).toPrecision(2)} %`;
export const milliseconds = s => s < 0.0995 ? `${(1000 * s).toPrecision(2)} ms` : s < 10 ? `${(1000 * s).toFixed(0)} ms` : `${s.toFixed(1)} s`;

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
  if (head.smoke_time !== undefined) box.append(element("div", {textContent: `smoke at ${head.smoke_time.toFixed(3)} s`}));
  if (head.warning) box.append(element("div", {textContent: `warning: ${head.warning}`}));
  const open = document.querySelector(`.report[data-side="${side}"] details`);
  box.append(element("details", {open: Boolean(open && open.open)}, element("summary", {textContent: "stages"}),
    table(head.times.map(t => [t.name, milliseconds(t.seconds)])),
    table(head.stages.map(s => [s.kept ? s.name : `${s.name} (left out)`, "", s.reason, s.kept ? "" : "left-out"])),
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

export function showReports() {
  $("reports").replaceChildren(...sides.map(reportOf), reportOfReference());
}

export function showPixel(at) {
  const inside = at && at.u >= 0 && at.u < 1 && at.v >= 0 && at.v < 1, lines = [];
  for (const source of inside ? sources : []) {
    const picture = stage.pictures[source];
    if (!picture) continue;
    const x = Math.floor(at.u * picture.width), y = Math.floor(at.v * picture.height), i = 3 * (y * picture.width + x);
    lines.push(`${source.padEnd(9)} (${x}, ${y})  ${[0, 1, 2].map(c => picture.values[i + c].toPrecision(4).padStart(10)).join(" ")}`);
  }
  $("pixel").textContent = lines.join("\n") || "values under the pointer: red, green, blue, linear";
}

export function say(text) { $("message").textContent = text; }
