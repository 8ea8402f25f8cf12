// The canvas: where pictures lie on it, and what is drawn over them.
import {paint, paintDifference, falseColour, falseRange} from "./pictures.js";
import {add, frame, project, times} from "./camera.js";

export const modes = ["wipe", "side by side", "flip", "difference"];

export class Stage {
  constructor(canvas, state) {
    this.canvas = canvas;
    this.state = state;
    this.context = canvas.getContext("2d");
    this.pictures = {left: null, right: null, reference: null};
    this.notes = {left: "", right: "", reference: ""};
    this.layers = {};
    this.handles = [];  // {light, position, name}
    this.flow = null;  // {lo, hi, ball: {center, radius}}: the box of a flow that is stirred, and what a stroke reaches
    this.camera = null;
    this.aspect = 4 / 3;
    new ResizeObserver(() => this.draw()).observe(canvas);
  }

  names() {
    return {left: `left: ${this.state.panes.left.method}`, right: `right: ${this.state.panes.right.method}`, reference: "reference"};
  }

  // The panels: rectangles of the canvas with the sources that they show, `clip` the part of the width.
  panels() {
    const v = this.state.view, w = this.canvas.width, h = this.canvas.height;
    const fit = (x, width) => {
      const s = Math.min(width / this.aspect, h);
      return {x: x + (width - s * this.aspect) / 2, y: (h - s) / 2, width: s * this.aspect, height: s};
    };
    if (v.mode !== "side by side") return [{rect: fit(0, w), source: v.mode === "flip" && !v.showA ? v.b : v.a}];
    return [{rect: fit(0, w / 2 - 1), source: v.a}, {rect: fit(w / 2 + 1, w / 2 - 1), source: v.b}];
  }

  // A layer as a canvas of the picture's size, painted again where something changed.
  layer(name, key, picture, fill) {
    const layer = this.layers[name] ||= {canvas: document.createElement("canvas")};
    if (layer.picture === picture && layer.key === key) return layer.canvas;
    Object.assign(layer, {picture, key});
    if (layer.canvas.width !== picture.width || layer.canvas.height !== picture.height)
      Object.assign(layer.canvas, {width: picture.width, height: picture.height});
    const context = layer.canvas.getContext("2d"), image = context.createImageData(picture.width, picture.height);
    fill(image.data);
    context.putImageData(image, 0, 0);
    return layer.canvas;
  }

  painted(source) {
    const picture = this.pictures[source], v = this.state.view;
    return picture && this.layer(source, `${v.exposure} ${v.tone} ${v.colours}`, picture, out => paint(picture, v, out));
  }

  painted_difference() {
    const v = this.state.view, a = this.pictures[v.a], b = this.pictures[v.b];
    if (!a || !b) return null;
    if (this.compared !== b) this.layers.difference = undefined;
    this.compared = b;
    return this.layer("difference", `${v.exposure} ${v.gain} ${v.relative}`, a, out => paintDifference(a, b, v, out));
  }

  put(layer, rect) {
    if (!layer) return;
    this.context.imageSmoothingEnabled = layer.width < rect.width / 1.6;  // the coarse picture of something that moves
    this.context.drawImage(layer, rect.x, rect.y, rect.width, rect.height);
  }

  tag(text, x, y, align = "left") {
    const c = this.context, size = Math.round(13 * this.ratio);
    c.font = `${size}px system-ui, sans-serif`;
    c.textAlign = align;
    c.lineWidth = 4 * this.ratio;
    c.strokeStyle = "rgba(0,0,0,.75)";
    c.strokeText(text, x, y);
    c.fillStyle = "#fff";
    c.fillText(text, x, y);
  }

  draw() {
    const c = this.context, canvas = this.canvas, v = this.state.view;
    this.ratio = window.devicePixelRatio || 1;
    const width = Math.round(canvas.clientWidth * this.ratio);
    const wide = v.mode === "side by side" ? width / 2 : width;
    const height = Math.round(Math.min(wide / this.aspect, 0.68 * window.innerHeight * this.ratio));
    if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, {width, height});
    c.fillStyle = "#2b2f33";
    c.fillRect(0, 0, width, height);
    const panels = this.panels(), names = this.names(), low = 18 * this.ratio;
    const {rect} = panels[0];
    if (v.mode === "difference") {
      this.put(this.painted_difference(), rect);
      this.tag(`${names[v.a]} minus ${names[v.b]}: red is brighter, blue darker`, rect.x + 6, rect.y + low);
    } else if (v.mode === "wipe") {
      const edge = rect.x + v.wipe * rect.width;
      this.put(this.painted(v.b), rect);
      c.save();
      c.beginPath();
      c.rect(0, 0, edge, height);
      c.clip();
      c.fillRect(rect.x, rect.y, rect.width, rect.height);
      this.put(this.painted(v.a), rect);
      c.restore();
      c.fillStyle = "#ffd54a";
      c.fillRect(edge - this.ratio, rect.y, 2 * this.ratio, rect.height);
      this.tag(names[v.a], Math.max(edge - 8, rect.x + 90 * this.ratio), rect.y + low, "right");
      this.tag(names[v.b], Math.min(edge + 8, rect.x + rect.width - 90 * this.ratio), rect.y + rect.height - 8 * this.ratio);
    } else {
      for (const panel of panels) {
        this.put(this.painted(panel.source), panel.rect);
        this.tag(names[panel.source], panel.rect.x + 6, panel.rect.y + low);
      }
    }
    this.draw_notes(panels, low);
    for (const panel of panels) {
      this.draw_handles(panel.rect);
      if (this.flow && this.camera) this.draw_flow(panel.rect);
    }
    if (v.colours && v.mode !== "difference") this.draw_legend(rect);
  }

  // Why there is no picture, or that it is being made.
  draw_notes(panels, low) {
    const v = this.state.view, shown = v.mode === "wipe" || v.mode === "difference" ? [v.a, v.b] : panels.map(p => p.source);
    shown.forEach((source, i) => {
      const {rect} = panels[Math.min(i, panels.length - 1)];
      if (this.notes[source]) this.tag(`${source}: ${this.notes[source]}`, rect.x + 6, rect.y + low * (2.4 + (panels.length === 1 ? i : 0) * 1.4));
    });
  }

  draw_handles(rect) {
    const c = this.context;
    for (const handle of this.handles) {
      const at = this.camera && project(this.camera, this.aspect, handle.position);
      if (!at || at.u < 0 || at.u > 1 || at.v < 0 || at.v > 1) continue;
      c.beginPath();
      c.arc(rect.x + at.u * rect.width, rect.y + at.v * rect.height, 7 * this.ratio, 0, 7);
      c.lineWidth = 4 * this.ratio;
      c.strokeStyle = "rgba(0,0,0,.7)";
      c.stroke();
      c.lineWidth = 2 * this.ratio;
      c.strokeStyle = "#ffd54a";
      c.stroke();
    }
  }

  draw_flow(rect) {
    const c = this.context, {lo, hi, ball} = this.flow, corner = bits => lo.map((x, i) => bits >> i & 1 ? hi[i] : x);
    const at = point => project(this.camera, this.aspect, point);
    const x = p => rect.x + p.u * rect.width, y = p => rect.y + p.v * rect.height;
    c.save();
    c.beginPath();
    c.rect(rect.x, rect.y, rect.width, rect.height);
    c.clip();
    c.beginPath();
    for (let from = 0; from < 8; ++from)
      for (const bit of [1, 2, 4]) {
        const a = at(corner(from)), b = at(corner(from | bit));
        if (from & bit || !a || !b) continue;
        c.moveTo(x(a), y(a));
        c.lineTo(x(b), y(b));
      }
    const middle = ball && at(ball.center), edge = ball && at(add(ball.center, times(frame(this.camera).up, ball.radius)));
    c.lineWidth = this.ratio;
    c.strokeStyle = "rgba(255,213,74,.5)";
    c.stroke();
    if (middle && edge) {
      c.beginPath();
      c.arc(x(middle), y(middle), Math.abs(y(edge) - y(middle)), 0, 7);
      c.lineWidth = 2 * this.ratio;
      c.stroke();
    }
    c.restore();
  }

  draw_legend(rect) {
    const c = this.context, w = 180 * this.ratio, h = 8 * this.ratio, x = rect.x + 8, y = rect.y + rect.height - 40 * this.ratio;
    const out = [0, 0, 0];
    for (let i = 0; i < w; ++i) {
      falseColour(i / w, out, 0);
      c.fillStyle = `rgb(${out.map(Math.round).join(",")})`;
      c.fillRect(x + i, y, 1, h);
    }
    const ends = falseRange.map(e => (2 ** (e - this.state.view.exposure)).toPrecision(2));
    this.tag(`luminance ${ends[0]} to ${ends[1]}, logarithmic`, x, y - 4);
  }

  // The film position under a pointer, and the panel; u and v may lie outside [0, 1].
  at(event) {
    const box = this.canvas.getBoundingClientRect();
    const x = (event.clientX - box.left) * this.canvas.width / box.width, y = (event.clientY - box.top) * this.canvas.height / box.height;
    const panels = this.panels(), panel = panels.find(p => x <= p.rect.x + p.rect.width) || panels[panels.length - 1];
    return {u: (x - panel.rect.x) / panel.rect.width, v: (y - panel.rect.y) / panel.rect.height, panel};
  }

  // The light whose handle is there, or nothing.
  handle_at(at) {
    const reach = 16 * this.ratio;
    return this.handles.find(handle => {
      const p = project(this.camera, this.aspect, handle.position);
      return p && Math.hypot((p.u - at.u) * at.panel.rect.width, (p.v - at.v) * at.panel.rect.height) < reach;
    });
  }

  on_wipe(at) {
    return this.state.view.mode === "wipe" && Math.abs(at.u - this.state.view.wipe) * at.panel.rect.width < 10 * this.ratio;
  }
}
