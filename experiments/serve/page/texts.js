// What can be taken away from the page: a command, an experiment, a link.

export const quoted = text => /^[\w./=:-]+$/.test(text) ? text : `'${text.replaceAll("'", "'\\''")}'`;

// A value as TOML, as the server writes it for the same value.
export function toml(value) {
  if (Array.isArray(value)) return `[${value.map(toml).join(", ")}]`;
  if (typeof value === "object") return `{ ${Object.entries(value).map(([k, v]) => `${k} = ${toml(v)}`).join(", ")} }`;
  return typeof value === "string" ? JSON.stringify(value) : String(value);
}

export function command(file, pane, values, film, name) {
  const words = ["airlight", "render", quoted(file), "--method", pane.method];
  for (const [key, value] of Object.entries(pane.settings)) words.push("--set", quoted(`${key}=${value}`));
  for (const [path, value] of Object.entries(values)) words.push("--override", quoted(`${path}=${toml(value)}`));
  words.push("--override", `film.width=${film.width}`, "--override", `film.height=${film.height}`, "--out", `${name}.exr`, "--png", `${name}.png`);
  return words.join(" ");
}

const settingValue = value => typeof value === "string" ? JSON.stringify(value) : String(value);

// A whole experiment with the two methods: a file below experiments/, whose folder the names of scenes are relative to.
export function experiment(scene, panes, values, film, orders) {
  const overrides = {...values, "film.width": film.width, "film.height": film.height};
  const at = scene.file.indexOf("experiments/");
  const file = at >= 0 ? scene.file.slice(at + "experiments/".length) : scene.file;
  const reference = orders === "all" ? "stream = 0" : "stream = 0, max_events = 1";
  const lines = [
    `title = ${JSON.stringify(`${panes.left.method} and ${panes.right.method} in ${scene.name}`)}`,
    `about = "Made in airlight serve."`,
    `metrics = ["rel_l2", "bias"]`,
    "", "[reference]", `renderer = "path_tracer"`, `settings = { ${reference} }`,
    "", "[profile.quick]", "reference = { samples = 256 }", "runs = 5", "budget = 0.5",
    "", "[profile.paper]", "reference = { samples = 1024 }", "runs = 31", "budget = 5",
    "", "[[scene]]", `name = ${JSON.stringify(scene.name)}`, `file = ${JSON.stringify(file)}`,
    `overrides = { ${Object.entries(overrides).map(([k, v]) => `${JSON.stringify(k)} = ${toml(v)}`).join(", ")} }`];
  for (const [side, pane] of Object.entries(panes)) {
    // A path tracer takes other random numbers than the reference.
    const given = pane.monte_carlo && pane.settings.stream === undefined ? {...pane.settings, stream: 1} : pane.settings;
    const settings = Object.entries(given).map(([k, v]) => `${k} = ${settingValue(v)}`).join(", ");
    lines.push("", "[[method]]", `name = ${JSON.stringify(`${side}: ${pane.method}`)}`, `renderer = ${JSON.stringify(pane.method)}`);
    if (settings) lines.push(`settings = { ${settings} }`);
    if (pane.monte_carlo) lines.push("count_noise = true");
  }
  return lines.join("\n") + "\n";
}
