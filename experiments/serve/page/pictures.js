// Pictures of linear light, and how they become colours. halfTable, toSrgb and diverging are those of pixels.js.

// An answer of the server: a length, JSON, half floats. The picture has `width`, `height` and `values`; none where there are no pixels.
export function decode(buffer) {
  const length = new DataView(buffer).getUint32(0, true);
  const head = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 4, length)));
  const halves = new Uint16Array(buffer, 4 + length);
  if (halves.length === 0) return {head, picture: null};
  const values = new Float32Array(halves.length);
  for (let i = 0; i < halves.length; ++i) values[i] = halfTable[halves[i]] * head.scale;
  return {head, picture: {width: head.width, height: head.height, values}};
}

const aces = x => Math.min(1, x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14));

// AgX as in scene/film/tone_curve.cpp, as a table over stops.
const agxStops = {below: 10, above: 6.5, grey: 0.18, slope: 2.4, power: 2.4};
const agxTable = (() => {
  const {below, above, grey, slope, power} = agxStops;
  const xp = below / (below + above), yp = grey ** (1 / power);
  const branch = (x, reachX, reachY, p) => {
    const scale = ((slope * reachX) ** -p * ((slope * reachX / reachY) ** p - 1)) ** (-1 / p);
    const t = slope * Math.abs(x - xp) / scale, rise = scale * t / (1 + t ** p) ** (1 / p);
    return x < xp ? yp - rise : yp + rise;
  };
  return Float32Array.from({length: 4097}, (_, i) => {
    const x = i / 4096, y = x < xp ? branch(x, xp, yp, 3) : branch(x, 1 - xp, 1 - yp, 3.25);
    return Math.min(1, Math.max(y, 0) ** power);
  });
})();
function agx(linear) {
  const {below, above, grey} = agxStops;
  const x = (Math.log2(Math.max(linear, 1e-10) / grey) + below) / (below + above);
  return agxTable[Math.round(4096 * Math.min(1, Math.max(0, x)))];
}
const agxMix = [[0.842479062253094, 0.0784335999999992, 0.0792237451477643],
                [0.0423282422610123, 0.878468636469772, 0.0791661274605434],
                [0.0423756549057051, 0.0784336, 0.879142973793104]];

export const tones = ["clamp", "aces", "agx"];

// Luminance in powers of two, from 2^-8 to 2^2, as colours from blue over green to red.
export const falseRange = [-8, 2];
export function falseColour(t, out, at) {
  const x = Math.min(1, Math.max(0, t)), ramp = c => Math.min(1, Math.max(0, 1.5 - Math.abs(4 * x - c)));
  out[at] = 255 * ramp(3);
  out[at + 1] = 255 * ramp(2);
  out[at + 2] = 255 * ramp(1);
}

export const luminance = (v, i) => 0.2126 * v[i] + 0.7152 * v[i + 1] + 0.0722 * v[i + 2];

// Writes bytes of RGBA. NaN is magenta, as in `airlight render --png`.
export function paint(picture, view, out) {
  const v = picture.values, scale = 2 ** view.exposure;
  for (let i = 0, at = 0; i < v.length; i += 3, at += 4) {
    const r = Math.max(0, v[i] * scale), g = Math.max(0, v[i + 1] * scale), b = Math.max(0, v[i + 2] * scale);
    out[at + 3] = 255;
    if (v[i] !== v[i] || v[i + 1] !== v[i + 1] || v[i + 2] !== v[i + 2]) {
      out[at] = out[at + 2] = 255;
      out[at + 1] = 0;
    } else if (view.colours) {
      falseColour((Math.log2(Math.max(1e-30, luminance(v, i) * scale)) - falseRange[0]) / (falseRange[1] - falseRange[0]), out, at);
    } else if (view.tone === "agx") {
      for (let c = 0; c < 3; ++c) out[at + c] = toSrgb(agx(agxMix[c][0] * r + agxMix[c][1] * g + agxMix[c][2] * b));
    } else {
      const tone = view.tone === "aces" ? aces : x => x;
      out[at] = toSrgb(tone(r));
      out[at + 1] = toSrgb(tone(g));
      out[at + 2] = toSrgb(tone(b));
    }
  }
}

// Difference of two pictures, on the first one's pixels: signed (red: a is brighter), or relative to b. Equal pixels are black.
export function paintDifference(a, b, view, out) {
  const gain = 2 ** (view.relative ? view.gain : view.exposure + view.gain);
  let floor = 0;
  if (view.relative) for (let i = 0; i < b.values.length; i += 3) floor = Math.max(floor, 0.01 * luminance(b.values, i));
  for (let y = 0, at = 0; y < a.height; ++y)
    for (let x = 0; x < a.width; ++x, at += 4) {
      const i = 3 * (y * a.width + x);
      const j = 3 * (Math.floor(y * b.height / a.height) * b.width + Math.floor(x * b.width / a.width));
      const d = (a.values[i] - b.values[j] + a.values[i + 1] - b.values[j + 1] + a.values[i + 2] - b.values[j + 2]) / 3;
      const t = Math.max(-1, Math.min(1, gain * (view.relative ? d / (Math.abs(luminance(b.values, j)) + floor || 1) : d)));
      out[at] = t > 0 ? toSrgb(t) : toSrgb(-0.15 * t);
      out[at + 1] = toSrgb(0.25 * Math.abs(t));
      out[at + 2] = t < 0 ? toSrgb(-t) : toSrgb(0.1 * t);
      out[at + 3] = 255;
    }
}

// The exposure at which the 98th percentile of a picture is 0.8.
export function goodExposure(picture) {
  const sorted = Float32Array.from(picture.values).sort(), bright = sorted[Math.floor(0.98 * (sorted.length - 1))];
  return bright > 0 ? Math.max(-10, Math.min(10, Math.round(4 * Math.log2(0.8 / bright)) / 4)) : 0;
}
