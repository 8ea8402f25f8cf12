// Elements of the page: menus, sliders that fit a range, settings of a method.

export const $ = id => document.getElementById(id);

export function element(tag, properties = {}, ...children) {
  const made = Object.assign(document.createElement(tag), properties);
  made.append(...children);
  return made;
}

// Options are {value, text, refused}; one that is refused cannot be chosen, and says why.
export function fill(select, options, chosen) {
  select.replaceChildren(...options.map(o => {
    const option = element("option", {value: o.value, textContent: o.refused ? `${o.text}: ${o.refused}` : o.text, title: o.refused || ""});
    option.disabled = Boolean(o.refused);
    return option;
  }));
  select.value = chosen;
}

export const short = x => Number(Number(x).toPrecision(6));

// A slider beside a field. The slider covers the usual part of the range, the field all of it. `ends` are [least, greatest] of the slider.
export function slider(name, value, ends, limits, whole, onInput) {
  const [least, greatest] = ends, log = least > 0 && greatest / least > 20;
  const to = x => log ? Math.log(Math.max(least, x) / least) / Math.log(greatest / least) : (x - least) / (greatest - least);
  const from = t => log ? least * (greatest / least) ** t : least + t * (greatest - least);
  const range = element("input", {type: "range", min: 0, max: 1, step: 0.002, value: to(value)});
  const field = element("input", {type: "number", step: whole ? 1 : "any", value});
  if (limits[0] !== null) field.min = limits[0];
  if (limits[1] !== null) field.max = limits[1];
  range.setAttribute("aria-label", `${name}, slider`);
  field.setAttribute("aria-label", name);
  range.addEventListener("input", () => {
    const x = from(+range.value), found = whole ? Math.round(x) : Number(x.toPrecision(3));
    field.value = found;
    onInput(found);
  });
  field.addEventListener("input", () => {
    if (field.value === "" || !field.checkValidity()) return;
    range.value = to(+field.value);
    onInput(+field.value);
  });
  return [range, field];
}

// What a slider of a setting covers: its range, or sixteen times around its default where that has no end.
function usual(spec) {
  const start = Number(spec.default), span = Math.abs(start) || 1;
  let least = spec.least ?? -16 * span, greatest = spec.greatest ?? 16 * span;
  if (greatest - least > 64 * span) greatest = Math.min(greatest, 16 * span);
  if (least < -64 * span) least = Math.max(least, -16 * span);
  return [least, Math.max(greatest, least + 1e-9)];
}

const matches = (text, wanted) => {
  const bound = /^([<>]) (.*)$/.exec(wanted);
  if (bound) return bound[1] === ">" ? Number(text) > Number(bound[2]) : Number(text) < Number(bound[2]);
  return text === wanted || (text !== "" && !isNaN(text) && !isNaN(wanted) && Number(text) === Number(wanted));
};

// Is a setting read beside the others? As Settings of scene/base/settings.h.
export function isRead(spec, specs, given) {
  if (!spec.read_where) return true;
  const text = name => String(given[name] ?? specs.find(s => s.name === name).default);
  return spec.read_where.some(all => Object.entries(all).every(([name, values]) => values.some(v => matches(text(name), v))));
}

// One row of a method's settings. `given` holds what differs from the defaults; onChange is called after it changed.
export function settingRow(spec, given, onChange) {
  const row = element("div", {className: "setting"});
  row.dataset.setting = spec.name;
  const value = given[spec.name] ?? spec.default;
  const set = text => {
    if (String(text) === spec.default || text === Number(spec.default)) delete given[spec.name];
    else given[spec.name] = text;
    row.classList.toggle("changed", spec.name in given);
    onChange();
  };
  let controls;
  if (spec.type === "flag") {
    const box = element("input", {type: "checkbox", checked: String(value) === "true", className: "wide"});
    box.addEventListener("input", () => set(box.checked));
    controls = [box];
  } else if (spec.type === "choice") {
    const menu = element("select", {className: "wide"});
    fill(menu, spec.choices.map(c => ({value: c, text: c})), value);
    menu.addEventListener("input", () => set(menu.value));
    controls = [menu];
  } else {
    controls = slider(spec.name, Number(value), usual(spec), [spec.least, spec.greatest], spec.type === "integer", set);
  }
  if (controls.length === 1) controls[0].setAttribute("aria-label", spec.name);
  const label = element("label", {textContent: spec.name});
  const condition = spec.condition ? ` Read only with ${spec.condition}.` : "";
  row.append(label, ...controls, element("div", {className: "help", textContent: `${spec.help} (default ${spec.default}).${condition}`}));
  row.classList.toggle("changed", spec.name in given);
  return row;
}
