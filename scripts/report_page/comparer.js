// Compares two float images: wipe, flip, signed difference; zoom, pan, exposure, values under the cursor.
// A picture is {label, width, height, data}: data is base64 of little-endian half floats, RGB, row 0 at the top. Needs pixels.js.
"use strict";

function decode(picture) {
  if (picture.values) return picture.values;
  const bytes = atob(picture.data), values = new Float32Array(bytes.length / 2);
  for (let i = 0; i < values.length; ++i)
    values[i] = halfTable[bytes.charCodeAt(2 * i) | (bytes.charCodeAt(2 * i + 1) << 8)];
  picture.values = values;
  return values;
}

// Signed difference: blue is darker than the reference, red is brighter, white is equal.
function diverging(x, out, at) {
  const t = Math.max(-1, Math.min(1, x)), a = Math.abs(t);
  const end = t < 0 ? [33, 102, 172] : [178, 24, 43];
  for (let c = 0; c < 3; ++c) out[at + c] = Math.round(247 + (end[c] - 247) * a);
}

function makeComparer(host, group) {
  const state = {mode: "wipe", exposure: 0, gain: 0, wipe: 0.5, zoom: 1, cx: 0.5, cy: 0.5, showA: true, hover: null};
  const pictures = group.pictures;
  const select = (chosen, name) => {
    const element = document.createElement("select");
    element.setAttribute("aria-label", name);
    pictures.forEach((p, i) => element.add(new Option(p.label, i, false, i === chosen)));
    element.addEventListener("change", () => { repaint(); draw(); });
    return element;
  };
  const slider = (min, max, step, value, name, onInput) => {
    const element = document.createElement("input");
    Object.assign(element, {type: "range", min, max, step, value});
    element.setAttribute("aria-label", name);
    const shown = document.createElement("span");
    const show = () => { shown.textContent = (value => (value > 0 ? "+" : "") + value)(+element.value); };
    element.addEventListener("input", () => { onInput(+element.value); show(); repaint(); draw(); });
    show();
    const label = document.createElement("label");
    label.append(name, element, shown);
    return label;
  };
  const controls = document.createElement("div");
  controls.className = "controls";
  const [first, second] = group.pair || [Math.min(1, pictures.length - 1), 0];
  const a = select(first, "picture A"), b = select(second, "picture B");
  const modes = document.createElement("span");
  modes.className = "modes";
  for (const mode of ["wipe", "flip", "difference"]) {
    const button = document.createElement("button");
    button.type = "button";
    button.textContent = mode;
    button.addEventListener("click", () => {
      if (state.mode === "flip" && mode === "flip") state.showA = !state.showA;
      state.mode = mode;
      repaint();
      draw();
    });
    modes.append(button);
  }
  const labelled = (text, element) => {
    const label = document.createElement("label");
    label.append(text, element);
    return label;
  };
  controls.append(labelled("A", a), labelled("B", b), modes,
    slider(-10, 10, 0.25, 0, "exposure", v => { state.exposure = v; }),
    slider(-6, 14, 0.25, 0, "difference gain", v => { state.gain = v; }));
  const canvas = document.createElement("canvas");
  const numbers = document.createElement("div");
  numbers.className = "numbers";
  const root = document.createElement("div");
  root.className = "comparer";
  root.append(controls, canvas, numbers);
  host.append(root);

  const width = pictures[0].width, height = pictures[0].height;
  canvas.width = Math.max(960, width);
  canvas.height = Math.round(canvas.width * Math.min(height / width, 0.75));
  const context = canvas.getContext("2d");
  const layers = {a: document.createElement("canvas"), b: document.createElement("canvas"), d: document.createElement("canvas")};
  for (const layer of Object.values(layers)) Object.assign(layer, {width, height});

  function paint(layer, fill) {
    const ctx = layer.getContext("2d"), image = ctx.createImageData(width, height);
    for (let i = 0; i < width * height; ++i) { fill(i, image.data, 4 * i); image.data[4 * i + 3] = 255; }
    ctx.putImageData(image, 0, 0);
  }

  function repaint() {
    const va = decode(pictures[a.value]), vb = decode(pictures[b.value]);
    const scale = 2 ** state.exposure, gain = 2 ** (state.exposure + state.gain);
    const tone = v => (i, out, at) => { for (let c = 0; c < 3; ++c) out[at + c] = toSrgb(v[3 * i + c] * scale); };
    paint(layers.a, tone(va));
    paint(layers.b, tone(vb));
    if (state.mode === "difference")
      paint(layers.d, (i, out, at) => {
        const difference = (va[3 * i] - vb[3 * i] + va[3 * i + 1] - vb[3 * i + 1] + va[3 * i + 2] - vb[3 * i + 2]) / 3;
        diverging(difference * gain, out, at);
      });
    [...modes.children].forEach(button => button.setAttribute("aria-pressed", button.textContent === state.mode));
  }

  const fit = () => Math.min(canvas.width / width, canvas.height / height) * state.zoom;
  const origin = () => ({x: canvas.width / 2 - state.cx * width * fit(), y: canvas.height / 2 - state.cy * height * fit()});

  function draw() {
    const s = fit(), o = origin();
    context.fillStyle = "#2b2f33";
    context.fillRect(0, 0, canvas.width, canvas.height);
    context.imageSmoothingEnabled = false;
    const put = layer => context.drawImage(layer, o.x, o.y, width * s, height * s);
    const tag = (text, x, align) => {
      context.font = "15px system-ui, sans-serif";
      context.textAlign = align;
      context.lineWidth = 4;
      context.strokeStyle = "rgba(0,0,0,.75)";
      context.strokeText(text, x, 22);
      context.fillStyle = "#fff";
      context.fillText(text, x, 22);
    };
    const nameA = pictures[a.value].label, nameB = pictures[b.value].label;
    if (state.mode === "difference") {
      put(layers.d);
      tag(`${nameA} minus ${nameB}: red brighter, blue darker`, 10, "left");
    } else if (state.mode === "flip") {
      put(state.showA ? layers.a : layers.b);
      tag((state.showA ? nameA : nameB) + "  (click or space flips)", 10, "left");
    } else {
      const edge = Math.round(state.wipe * canvas.width);
      put(layers.b);
      context.save();
      context.beginPath();
      context.rect(0, 0, edge, canvas.height);
      context.clip();
      put(layers.a);
      context.restore();
      context.fillStyle = "#ffd54a";
      context.fillRect(edge - 1, 0, 2, canvas.height);
      tag(nameA, edge - 10, "right");
      tag(nameB, edge + 10, "left");
    }
    const h = state.hover;
    if (h) {
      const va = decode(pictures[a.value]), vb = decode(pictures[b.value]), i = 3 * (h.y * width + h.x);
      const text = v => [0, 1, 2].map(c => v(c).toPrecision(4).padStart(11)).join(" ");
      numbers.textContent = `(${h.x}, ${h.y})  A ${text(c => va[i + c])}   B ${text(c => vb[i + c])}   ` +
        `A/B-1 ${text(c => va[i + c] / vb[i + c] - 1)}`;
    } else numbers.textContent =
      "drag: wipe    shift-drag: pan    wheel (after a click): zoom    double-click: whole picture    space: flip";
  }

  const place = event => {
    const box = canvas.getBoundingClientRect();
    return {x: (event.clientX - box.left) * canvas.width / box.width, y: (event.clientY - box.top) * canvas.height / box.height};
  };
  let drag = null;
  canvas.tabIndex = 0;
  canvas.addEventListener("pointerdown", event => {
    const p = place(event);
    drag = {p, cx: state.cx, cy: state.cy, pan: event.shiftKey || state.mode !== "wipe", moved: false};
    canvas.setPointerCapture(event.pointerId);
  });
  canvas.addEventListener("pointermove", event => {
    const p = place(event), s = fit(), o = origin();
    if (drag) {
      drag.moved = drag.moved || Math.hypot(p.x - drag.p.x, p.y - drag.p.y) > 3;
      if (drag.pan) {
        state.cx = drag.cx - (p.x - drag.p.x) / (width * s);
        state.cy = drag.cy - (p.y - drag.p.y) / (height * s);
      } else state.wipe = Math.max(0, Math.min(1, p.x / canvas.width));
    }
    const x = Math.floor((p.x - o.x) / s), y = Math.floor((p.y - o.y) / s);
    state.hover = x >= 0 && y >= 0 && x < width && y < height ? {x, y} : null;
    draw();
  });
  canvas.addEventListener("pointerup", event => {
    if (drag && !drag.moved && state.mode === "flip") state.showA = !state.showA;
    if (drag && !drag.moved && state.mode === "wipe") state.wipe = place(event).x / canvas.width;
    drag = null;
    draw();
  });
  canvas.addEventListener("pointerleave", () => { state.hover = null; draw(); });
  canvas.addEventListener("wheel", event => {
    if (document.activeElement !== canvas && !event.ctrlKey) return;  // scrolling past must not zoom
    event.preventDefault();
    const p = place(event), before = fit(), o = origin();
    const u = (p.x - o.x) / (width * before), v = (p.y - o.y) / (height * before);
    state.zoom = Math.max(1, Math.min(64, state.zoom * (event.deltaY < 0 ? 1.25 : 0.8)));
    state.cx = u - (p.x - canvas.width / 2) / (width * fit());
    state.cy = v - (p.y - canvas.height / 2) / (height * fit());
    if (state.zoom === 1) state.cx = state.cy = 0.5;
    draw();
  }, {passive: false});
  canvas.addEventListener("dblclick", () => { Object.assign(state, {zoom: 1, cx: 0.5, cy: 0.5}); draw(); });
  canvas.addEventListener("keydown", event => {
    if (event.key !== " ") return;
    event.preventDefault();
    state.mode = "flip";
    state.showA = !state.showA;
    repaint();
    draw();
  });

  // Start at an exposure that shows the reference: its 98th percentile at 0.8.
  const sorted = Float32Array.from(decode(pictures[0])).sort();
  const bright = sorted[Math.floor(0.98 * (sorted.length - 1))];
  if (bright > 0) {
    state.exposure = Math.max(-10, Math.min(10, Math.round(4 * Math.log2(0.8 / bright)) / 4));
    const exposure = controls.querySelector('input[aria-label="exposure"]');
    exposure.value = state.exposure;
    exposure.nextSibling.textContent = (state.exposure > 0 ? "+" : "") + state.exposure;
  }
  repaint();
  draw();
}

for (const script of document.querySelectorAll("script.pictures")) {
  const host = script.parentElement;
  const observer = new IntersectionObserver(entries => {
    if (!entries.some(entry => entry.isIntersecting)) return;
    observer.disconnect();  // decoded only when it comes into view
    makeComparer(host, JSON.parse(script.textContent));
  }, {rootMargin: "400px"});
  observer.observe(host);
}

// A sequence shows one of its frames, the one that the slider is at.
for (const sequence of document.querySelectorAll(".sequence")) {
  const slider = sequence.querySelector("input"), frames = [...sequence.querySelectorAll(".frame")];
  const show = () => {
    frames.forEach((frame, i) => { frame.hidden = i !== Number(slider.value); });
    sequence.querySelector("output").textContent = frames[slider.value].dataset.frame;
  };
  slider.max = frames.length - 1;  // pictures that are missing have no frame
  slider.addEventListener("input", show);
  show();
}
