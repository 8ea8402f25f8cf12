// All methods on the same scenes: a table whose metric, budget, order and kind of movement can be switched, and a plot for each scene.
// Its state stands in the address, so that a view can be sent to somebody.
(() => {
  const section = document.getElementById("common");
  if (!section) return;
  const data = JSON.parse(section.querySelector(".common-rows").textContent);
  const state = { set: data.sets[0].name, metric: "rel_l2", budget: "0.1", moves: "camera_seconds" };
  const element = (tag, props = {}, ...children) => {
    const e = Object.assign(document.createElement(tag), props);
    e.append(...children);
    return e;
  };
  const svg = (tag, attributes, text) => {
    const e = document.createElementNS("http://www.w3.org/2000/svg", tag);
    for (const [name, value] of Object.entries(attributes)) e.setAttribute(name, value);
    if (text) e.textContent = text;
    return e;
  };

  const digits = x => {
    const size = Math.abs(x);
    return size >= 10 ? x.toFixed(0) : size === 0 ? "0" : size < 1e-3 ? x.toExponential(0) : String(Number(x.toPrecision(2)));
  };
  const percent = x => `${digits(100 * x)} %`;
  const time = s => s >= 1 ? `${digits(s)} s` : `${digits(1000 * s)} ms`;
  // The noise of the reference hides a figure whose 95 % interval reaches 0.
  const hidden = v => v[1] <= 0 && v[2] >= 0 && v[1] < v[2];
  const most = v => Math.max(Math.abs(v[1]), Math.abs(v[2]));
  const shown = (v, metric) => {
    const x = hidden(v) ? most(v) : v[0];
    return (hidden(v) ? "< " : "") + (metric === "rmse" ? String(Number(x.toPrecision(2))) : percent(x));
  };
  const error = row => row.v.rel_l2;

  // Faster and closer; what the reference's noise hides is as close as anything.
  const least = row => hidden(error(row)) ? 0 : error(row)[0];
  const beats = (a, b) => a.t[state.moves] < b.t[state.moves] && (least(a) < least(b) || least(a) === 0);
  const frontOf = rows => {
    const timed = rows.filter(r => error(r) && r.t[state.moves] !== undefined && error(r)[0] < data.useless);
    return timed.filter(r => !timed.some(o => beats(o, r)));
  };

  const describe = (row, method) => `${method}${row.c ? " (medium converted)" : ""}\n${row.set ? row.set + "\n" : ""}` +
    `${data.metrics[state.metric]} ${shown(row.v[state.metric], state.metric)}` +
    ` [${digits(row.v[state.metric][1])}, ${digits(row.v[state.metric][2])}]\n` +
    `${time(row.t[state.moves])}${row.anew.includes(state.moves) ? ", all prepared again" : ""}\n` +
    `${row.lacks ? `leaves out ${row.lacks}\n` : ""}${row.all}`;

  const cell = (rows, method, fronts) => {
    const drawn = rows.filter(error);
    if (!rows.length) return element("td", { className: "no" }, "not tried");
    if (!drawn.length) return element("td", { className: "no", title: rows[0].note }, "refuses");
    const timed = drawn.filter(r => r.t[state.moves] !== undefined);
    if (!timed.length) return element("td", { className: "no" }, "not timed");
    const within = timed.filter(r => r.t[state.moves] <= Number(state.budget));
    if (!within.length) return element("td", { className: "no" }, `(${time(Math.min(...timed.map(r => r.t[state.moves])))})`);
    const best = within.reduce((a, b) => Math.abs(error(b)[0]) < Math.abs(error(a)[0]) ? b : a);
    if (!best.v[state.metric]) return element("td", {}, "");
    return element("td", { className: fronts.includes(best) ? "number front" : "number", title: describe(best, method) },
      shown(best.v[state.metric], state.metric) + (best.c ? "\u00b0" : ""));
  };

  const table = set => {
    const fronts = set.scenes.map((_, s) => frontOf(set.rows.filter(r => r.s === s)));
    const head = element("tr", {}, ...["method", ...set.scenes, "on the front in"].map(t => element("th", {}, t)));
    const body = set.methods.map((method, m) => {
      const wins = fronts.filter(front => front.some(r => r.m === m)).length;
      return element("tr", {}, element("th", { scope: "row" }, method),
        ...set.scenes.map((_, s) => cell(set.rows.filter(r => r.s === s && r.m === m), method, fronts[s])),
        element("td", { className: "number" }, wins ? `${wins} of ${set.scenes.length}` : ""));
    });
    const rows = [head, ...body].map(row => [...row.children].map(cell => cell.textContent));
    return element("div", { className: "scroll" }, saveTable(`${set.words}, ${data.metrics[state.metric]}`, rows),
      element("table", {}, element("thead", {}, head), element("tbody", {}, ...body)));
  };

  // The papers' methods in colours, as published hollow; what engines do and the references in greys.
  const colours = { "shadow planes": "#b8860b", "Fogshop": "#1a7f37", "wavelet fog": "#0b5cad", "Legendre fluids": "#8e44ad",
    "compensated ray marching": "#b3261e" };
  const look = method => {
    const paper = Object.keys(colours).find(name => method.startsWith(name));
    if (paper) return { fill: method.includes("as published") ? "#fff" : colours[paper], stroke: colours[paper], square: false };
    const shades = { "froxels": "#9aa4ae", "half-resolution": "#6a7580", "ray marcher": "#3b444d", "path tracer": "#c7ced6" };
    const kind = Object.keys(shades).find(name => method.startsWith(name));
    return { fill: shades[kind] || "#ddd", stroke: "#3b444d", square: true };
  };

  const ticks = (low, high) => {
    const all = [];
    for (let e = Math.floor(Math.log10(low)); e <= Math.ceil(Math.log10(high)); ++e)
      for (const k of [1, 2, 5]) if (k * 10 ** e >= low && k * 10 ** e <= high) all.push(k * 10 ** e);
    return all.length > 7 ? all.filter(t => /^1/.test(t.toExponential())) : all;
  };

  const plot = (set, s) => {
    const rows = set.rows.filter(r => r.s === s && error(r) && r.t[state.moves] > 0);
    const [w, h, left, right, top, bottom] = [540, 340, 58, 12, 28, 44];
    const ys = rows.map(r => Math.max(error(r)[0], hidden(error(r)) ? most(error(r)) : 0, 1e-6)), xs = rows.map(r => r.t[state.moves]);
    const [x0, x1, y0, y1] = [Math.min(...xs) / 1.3, Math.max(...xs) * 1.3, Math.min(...ys) / 1.5, Math.max(...ys) * 1.3];
    const X = t => left + (w - left - right) * Math.log(t / x0) / Math.log(x1 / x0);
    const Y = v => top + (h - top - bottom) * Math.log(y1 / Math.max(v, y0)) / Math.log(y1 / y0);
    const picture = svg("svg", { viewBox: `0 0 ${w} ${h}`, role: "img", "aria-label": `error against time, ${set.scenes[s]}` });
    picture.append(svg("text", { x: left, y: 18, class: "title" }, set.scenes[s]));
    const floor = Math.max(0, ...rows.filter(r => hidden(error(r))).map(r => most(error(r))));
    if (floor > y0) {
      picture.append(svg("rect", { x: left, y: Y(floor), width: w - left - right, height: h - bottom - Y(floor), class: "noise" }));
      picture.append(svg("text", { x: w - right - 4, y: h - bottom - 5, "text-anchor": "end" }, "hidden by the reference's noise"));
    }
    for (const t of ticks(x0, x1)) {
      picture.append(svg("line", { x1: X(t), x2: X(t), y1: top, y2: h - bottom, class: "grid" }));
      picture.append(svg("text", { x: X(t), y: h - bottom + 16, "text-anchor": "middle" }, time(t)));
    }
    for (const v of ticks(y0, y1)) {
      picture.append(svg("line", { x1: left, x2: w - right, y1: Y(v), y2: Y(v), class: "grid" }));
      picture.append(svg("text", { x: left - 6, y: Y(v) + 4, "text-anchor": "end" }, percent(v)));
    }
    const axis = `time of a frame when ${data.moves[state.moves]}`;
    picture.append(svg("text", { x: (left + w - right) / 2, y: h - 8, "text-anchor": "middle" }, axis));
    const middle = (top + h - bottom) / 2;
    picture.append(svg("text", { x: 12, y: middle, "text-anchor": "middle", transform: `rotate(-90 12 ${middle})` }, "relative L2 error"));
    const front = frontOf(rows).sort((a, b) => a.t[state.moves] - b.t[state.moves]);
    let line = "", last;
    for (const r of front) {
      const y = Y(Math.max(error(r)[0], y0));
      line += last === undefined ? `M${X(r.t[state.moves])},${y}` : `H${X(r.t[state.moves])}V${y}`;
      last = y;
    }
    picture.append(svg("path", { d: line, class: "front-line" }));
    for (const r of rows) {
      const { fill, stroke, square } = look(set.methods[r.m]), x = X(r.t[state.moves]), y = Y(error(r)[0]);
      const mark = square ? svg("rect", { x: x - 4, y: y - 4, width: 8, height: 8 }) : svg("circle", { cx: x, cy: y, r: 5 });
      mark.setAttribute("fill", fill);
      mark.setAttribute("stroke", stroke);
      mark.append(svg("title", {}, describe(r, set.methods[r.m])));
      picture.append(mark);
    }
    const numbers = set.methods.map((method, m) => rows.filter(r => r.m === m)).filter(of => of.length).map(of =>
      [false, true].map(bound => of.filter(r => hidden(error(r)) === bound).map(r => {
        const t = r.t[state.moves], values = bound ? Array(3).fill(most(error(r))) : error(r);
        return csvText([[set.methods[r.m], t, t, t, ...values, floor].map(String)]);
      }).join("") || csvText([[set.methods[of[0].m], ...Array(7).fill("")]])).map(block => block + "\n\n").join("")).join("");
    return element("figure", {}, picture,
      savePlot(`relative L2 error against ${axis}: ${set.scenes[s]}`, "# curve,x,x_low,x_high,y,y_low,y_high,floor\n" + numbers));
  };

  const legend = set => {
    const entries = set.methods.map(method => {
      const { fill, stroke, square } = look(method), box = svg("svg", { viewBox: "0 0 12 12", width: 12, height: 12 });
      box.append(square ? svg("rect", { x: 2, y: 2, width: 8, height: 8, fill, stroke })
        : svg("circle", { cx: 6, cy: 6, r: 5, fill, stroke }));
      return element("span", {}, box, " " + method);
    });
    return element("p", { className: "legend" }, ...entries);
  };

  // The pictures of a scene in the experiment's own section: the reference first, then the closest row of each method.
  const picturesOf = (set, scene) => {
    let at = document.getElementById(`common-${set.name}`);
    while (at && (at = at.nextElementSibling) && at.tagName !== "H2") {
      const script = at.querySelector("script.pictures");
      if (script && at.previousElementSibling.textContent === scene) return JSON.parse(script.textContent).pictures;
    }
    return [];
  };

  const side = 20, scale = 5;  // of a tile [pixels], and how much larger it is shown
  // The tile with the greatest squared error: its place and its relative L2 error.
  const worstTile = (picture, reference) => {
    const a = decode(picture), r = decode(reference), width = reference.width;
    let worst = { sum: -1 };
    for (let y = 0; y + side <= reference.height; y += side / 2)
      for (let x = 0; x + side <= width; x += side / 2) {
        let sum = 0, light = 0;
        for (let j = y; j < y + side; ++j)
          for (let i = 3 * (j * width + x); i < 3 * (j * width + x + side); ++i) {
            sum += (a[i] - r[i]) ** 2;
            light += r[i] ** 2;
          }
        if (sum > worst.sum) worst = { sum, error: Math.sqrt(sum / light), x, y };
      }
    return worst;
  };

  const crop = (picture, tile, exposure) => {
    const canvas = element("canvas", { width: side, height: side }), context = canvas.getContext("2d");
    const image = context.createImageData(side, side), values = decode(picture);
    for (let j = 0; j < side; ++j)
      for (let i = 0; i < side; ++i)
        for (let c = 0; c < 4; ++c)
          image.data[4 * (j * side + i) + c] =
            c === 3 ? 255 : toSrgb(exposure * values[3 * ((tile.y + j) * picture.width + tile.x + i) + c]);
    context.putImageData(image, 0, 0);
    canvas.style.width = canvas.style.height = `${side * scale}px`;
    return canvas;
  };

  const crops = (set, scene) => {
    const [reference, ...pictures] = picturesOf(set, scene);
    if (!pictures.length) return element("p", { className: "about" }, "The pictures are not here: run the experiment.");
    const bright = [...decode(reference)].sort((a, b) => a - b)[Math.floor(0.99 * decode(reference).length)];
    return element("div", { className: "crops" }, ...pictures.map(picture => {
      const tile = worstTile(picture, reference);
      const exposure = 0.8 / Math.max(bright, 1e-9);
      return element("figure", {}, crop(reference, tile, exposure), crop(picture, tile, exposure),
        element("figcaption", {}, `${picture.label}: ${percent(tile.error)}`));
    }));
  };

  const near = 1.25;  // by which times, or errors, may differ that count as equal
  // For each method of the papers the row of what engines do, or of the marcher, that takes as long, and one that errs as much.
  const pairsOf = (set, s, pictures) => {
    const shownRows = set.rows.filter(r => r.s === s && error(r) && r.t[state.moves] > 0 && pictures.some(p => p.label === r.label));
    const isPaper = r => Object.keys(colours).some(name => set.methods[r.m].startsWith(name));
    const baselines = shownRows.filter(r => !isPaper(r)), all = [];
    const kinds = [["equal time", r => r.t[state.moves]], ["equal error", r => Math.max(error(r)[0], 1e-9)]];
    for (const row of shownRows.filter(isPaper))
      for (const [words, value] of kinds) {
        const apart = other => Math.abs(Math.log(value(other) / value(row)));
        const other = baselines.filter(b => apart(b) <= Math.log(near)).sort((a, b) => apart(a) - apart(b))[0];
        if (other) all.push({ words, row, other });
      }
    return all;
  };

  const sideBySide = (set, s) => {
    const pictures = picturesOf(set, set.scenes[s]), host = element("div");
    const all = pairsOf(set, s, pictures);
    if (!all.length)
      return element("p", { className: "about" }, pictures.length ? "No two rows take as long or err as much." :
        "The pictures are not here: run the experiment.");
    const named = r => `${r.label} (${time(r.t[state.moves])}, ${percent(error(r)[0])})`;
    const select = element("select", {
      onchange: () => {
        const { row, other } = all[select.value];
        const [a, b] = [row, other].map(r => pictures.find(p => p.label === r.label));
        host.replaceChildren();
        makeComparer(host, { pictures: [pictures[0], a, b], pair: [1, 2] });
      }
    }, ...all.map((pair, i) => element("option", { value: i }, `${pair.words}: ${named(pair.row)} | ${named(pair.other)}`)));
    select.onchange();
    return element("div", {}, element("label", {}, "pair ", select), host);
  };

  const pairs = set => element("div", {}, element("h3", {}, "Side by side at equal time, at equal error"),
    element("p", { className: "about" }, "A method of a paper beside what engines do or the ray marcher, where times or errors differ by " +
      `less than ${Math.round(100 * (near - 1))} %. The first picture of each list is the reference.`),
    ...set.scenes.map((scene, s) => {
      const details = element("details", {}, element("summary", {}, scene));
      details.addEventListener("toggle", () => details.append(sideBySide(set, s)), { once: true });
      return details;
    }));

  const worst = set => element("div", {}, element("h3", {}, "Where each method is worst"),
    element("p", { className: "about" }, `The tile of ${side} x ${side} pixels with the greatest error in each picture below: ` +
      "the reference, the method, and the relative L2 error of the tile."),
    ...set.scenes.map(scene => {
      const details = element("details", {}, element("summary", {}, scene));
      details.addEventListener("toggle", () => details.append(crops(set, scene)), { once: true });
      return details;
    }));

  const choice = (key, words, options) => {
    const select = element("select", { name: key, onchange: () => { state[key] = select.value; draw(); keep(); } },
      ...options.map(([value, text]) => element("option", { value, selected: String(value) === state[key] }, text)));
    return element("label", {}, words + " ", select);
  };
  const keep = () => history.replaceState(null, "", "#common?" + new URLSearchParams(state));
  const view = element("div");
  const draw = () => {
    const set = data.sets.find(one => one.name === state.set);
    view.replaceChildren(
      element("p", { className: "about" }, `Films of ${set.film} pixels; ${set.machine}; ${set.commit}. Bold: on the front, no row of ` +
        "the scene is faster and closer by relative L2. (time): its fastest row takes longer. \u00b0: the medium was converted first. <: " +
        "the reference's noise hides the error. Hold the pointer over a cell or a mark for settings and reasons."),
      table(set), legend(set), element("div", { className: "plots" }, ...set.scenes.map((_, s) => plot(set, s))), pairs(set), worst(set));
  };

  const asked = location.hash.match(/^#common\?(.*)$/);
  if (asked) for (const [key, value] of new URLSearchParams(asked[1])) if (key in state) state[key] = value;
  if (!data.sets.some(one => one.name === state.set)) state.set = data.sets[0].name;
  if (!(state.metric in data.metrics)) state.metric = "rel_l2";
  if (!(state.moves in data.moves)) state.moves = "camera_seconds";
  if (!(Number(state.budget) > 0)) state.budget = "0.1";
  section.append(element("h2", {}, "All methods on the same scenes"),
    element("div", { className: "common-controls" },
      choice("set", "light", data.sets.map(one => [one.name, one.words])),
      choice("moves", "when", Object.entries(data.moves)),
      choice("budget", "within", [...data.budgets.map(([s, text]) => [String(s), text]), ["1000", "any time"]]),
      choice("metric", "metric", Object.entries(data.metrics))),
    view);
  draw();
})();
