// The view in the address of the page.
import {page, sides, state} from "./state.js";

export function remember() {
  const {panes, ...rest} = state, kept = Object.fromEntries(sides.map(s => [s, {method: panes[s].method, settings: panes[s].settings}]));
  history.replaceState(null, "", `#${encodeURIComponent(JSON.stringify({...rest, file: page.files[state.scene], panes: kept}))}`);
}

export function remembered() {
  try {
    const found = JSON.parse(decodeURIComponent(location.hash.slice(1)));
    return found && typeof found === "object" ? found : {};
  } catch {
    return {};
  }
}

// Takes what has the right type.
export function take(into, from, keys) {
  for (const key of keys) if (from && typeof from[key] === typeof into[key]) into[key] = from[key];
}
